#pragma once

/// Factors that turn a data sheet into SI: `k = 1.2 * MN / m`, `mass = 4.2 * t`, `speed = 30 * km / h`.
/// Use with `using namespace easydyn::units;` inside a function or a source file, never in a header.
namespace easydyn::units {

inline constexpr double m = 1.0, mm = 1e-3, cm = 1e-2, km = 1e3;                   // length [m]
inline constexpr double s = 1.0, ms = 1e-3, minute = 60.0, h = 3600.0;             // time [s]
inline constexpr double kg = 1.0, t = 1e3;                                         // mass [kg]
inline constexpr double N = 1.0, kN = 1e3, MN = 1e6;                               // force [N]
inline constexpr double Pa = 1.0, kPa = 1e3, MPa = 1e6, GPa = 1e9;                 // stress [Pa]
inline constexpr double Hz = 1.0, kHz = 1e3;                                       // frequency [1/s]
inline constexpr double rad = 1.0, pi = 3.14159265358979323846, deg = pi / 180.0;  // angle [rad]

}  // namespace easydyn::units
