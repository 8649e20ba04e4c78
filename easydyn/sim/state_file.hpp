#pragma once

#include <filesystem>

#include "easydyn/mbs/system.hpp"

namespace easydyn {

/// Saves a state so that it comes back bit by bit: a text with one named number per line, in hexadecimal floating point.
///
///     write_state("settled.state", system, integrator.state());
///     ...
///     Newmark integrator(system, read_state("settled.state", system));
///
/// Newmark, HHT and generalised-alpha go on from it as they would have, up to the tolerance of Newton's iteration (whose
/// matrix is new) and with the step of their options; Runge-Kutta chooses its step again, multistep methods start at order
/// one. The inputs of the system are saved, too, and set by reading.
/// The file appears when it is complete. @throws InputError if it cannot be written
void write_state(const std::filesystem::path& path, System& system, const State& state);

/// The state of a system with the same coordinates, first-order states, constraints and structures.
/// @throws InputError with file and line: not such a file, or of another system (names and numbers must agree)
State read_state(const std::filesystem::path& path, System& system);

}  // namespace easydyn
