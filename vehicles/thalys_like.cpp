#include "vehicles/thalys_like.hpp"

#include <fmt/format.h>

#include "easydyn/math/units.hpp"

namespace easydyn::vehicles {
namespace {

using namespace easydyn::units;

const std::string composition = "M-h: Degrande & Schillemans 2001";
const std::string eurostar = "F: Eurostar set, TTB-2D (Cantero) after Domenech Monforte 2014";
const std::string along_train = "C: sum of the lengths, " + composition;
const std::string balance = "C: matches the axle loads of Degrande & Schillemans 2001 (M-h)";

constexpr double traction_length = 22.15 * m, end_length = 21.84 * m, central_length = 18.70 * m;
constexpr double traction_bogie_spacing = 14.00 * m, end_overhang = end_length - central_length;
constexpr double axle_spacing = 3.00 * m;
constexpr double unsprung = 2027 * kg;  // per axle
constexpr double bogie_mass = 2200 * kg, jacobs_mass = 2900 * kg;

// Bodies: what the axles carry less bogies and axles; an end carriage bears half of the first Jacobs bogie.
constexpr double traction_body = 4 * 17000 * kg - 2 * bogie_mass - 4 * unsprung;
constexpr double central_body = 2 * 17000 * kg - jacobs_mass - 2 * unsprung;
constexpr double end_body = 3 * 14500 * kg - bogie_mass - 0.5 * jacobs_mass - 3 * unsprung;
// Its own bogie weighs 2 x 14.5 t, which leaves the rest to the Jacobs bogie, and gives its centre of mass.
constexpr double end_body_on_own_bogie = 2 * 14500 * kg - bogie_mass - 2 * unsprung;
constexpr double own_bogie_to_centre_of_mass = central_length * (1 - end_body_on_own_bogie / end_body);

constexpr double train_length = 2 * traction_length + 2 * end_length + 6 * central_length;

struct BogieKind {
  double mass, pitch_inertia;
  double primary_stiffness, primary_damping;      // per axle
  double secondary_stiffness, secondary_damping;  // per bogie
  std::string secondary_remark;
};
const BogieKind traction_bogie{
    bogie_mass, 1900 * kg* m* m, 2.60 * MN / m, 12 * kN* s / m, 3.26 * MN / m, 90 * kN* s / m, ""};
const BogieKind end_bogie{bogie_mass,   1900 * kg* m* m, 2.60 * MN / m,     12 * kN* s / m,
                          0.6 * MN / m, 20 * kN* s / m,  ", doubtful there"};
const BogieKind jacobs_bogie{
    jacobs_mass,    2508 * kg* m* m,           2.00 * MN / m, 12 * kN* s / m, 0.58 * MN / m,
    20 * kN* s / m, ", damping doubtful there"};

std::string car(int number) {
  return fmt::format("car {} body", number);
}

/// Number 1 is at the front; `carried` are the cars on it, which share its secondary suspension.
RunningGear bogie(int number, const BogieKind& kind, double x, const std::vector<int>& carried) {
  RunningGear gear{.name = fmt::format("bogie {}", number),
                   .frame_mass = {kind.mass, eurostar},
                   .frame_pitch_inertia = {kind.pitch_inertia, eurostar},
                   .x = {x, along_train},
                   .pivot_x = {x, along_train},
                   .secondaries = {},
                   .wheel_pairs = {}};
  const double share = 1.0 / static_cast<double>(carried.size());
  const std::string source =
      eurostar + kind.secondary_remark + (carried.size() > 1 ? "; half of the bogie's" : "");
  for (const int c : carried)
    gear.secondaries.push_back({.body = car(c),
                                .x = {x, along_train},
                                .stiffness = {share * kind.secondary_stiffness, source},
                                .damping = {share * kind.secondary_damping, source}});
  for (const int side : {1, -1})
    gear.wheel_pairs.push_back({.name = fmt::format("axle {}", 2 * number - (side > 0 ? 1 : 0)),
                                .x = {x + side * axle_spacing / 2, along_train},
                                .mass = {unsprung, composition},
                                .radius = {0.46 * m, "M-h: 920 mm diameter, new wheels"},
                                .primary_stiffness = {kind.primary_stiffness, eurostar},
                                .primary_damping = {kind.primary_damping, eurostar},
                                .resilient = {}});
  return gear;
}

}  // namespace

RailVehicle thalys_like() {
  RailVehicle train;
  train.name = "thalys-like";
  train.length = {train_length, along_train};
  const double front = train_length / 2;
  const double traction_x = front - traction_length / 2;
  const double own_bogie_x = front - traction_length - end_overhang;
  const double end_x = own_bogie_x - own_bogie_to_centre_of_mass;
  const double end_middle = front - traction_length - end_length / 2;

  // bodies, car 1 to car 10
  const auto traction_car = [&](int number, double x) {
    train.bodies.push_back({.name = car(number),
                            .mass = {traction_body, balance},
                            .pitch_inertia = {1.050e6 * kg * m * m, eurostar},
                            .x = {x, along_train},
                            .length = {traction_length, composition}});
  };
  const auto end_carriage = [&](int number, int side) {
    train.bodies.push_back({.name = car(number),
                            .mass = {end_body, balance},
                            .pitch_inertia = {1.658e6 * kg * m * m, eurostar},
                            .x = {side * end_x, balance},
                            .length = {end_length, composition},
                            .middle_offset = {side * (end_middle - end_x), balance}});
  };
  traction_car(1, traction_x);
  end_carriage(2, 1);
  for (int i = 0; i < 6; ++i)
    train.bodies.push_back({.name = car(3 + i),
                            .mass = {central_body, balance},
                            .pitch_inertia = {8.10e5 * kg * m * m, eurostar},
                            .x = {(2.5 - i) * central_length, along_train},
                            .length = {central_length, composition}});
  end_carriage(9, -1);
  traction_car(10, -traction_x);

  // bogies, 1 to 13
  const double half = traction_bogie_spacing / 2;
  train.gears = {bogie(1, traction_bogie, traction_x + half, {1}),
                 bogie(2, traction_bogie, traction_x - half, {1}), bogie(3, end_bogie, own_bogie_x, {2})};
  for (int i = 0; i < 7; ++i)
    train.gears.push_back(bogie(4 + i, jacobs_bogie, (3 - i) * central_length, {2 + i, 3 + i}));
  train.gears.push_back(bogie(11, end_bogie, -own_bogie_x, {9}));
  train.gears.push_back(bogie(12, traction_bogie, -traction_x + half, {10}));
  train.gears.push_back(bogie(13, traction_bogie, -traction_x - half, {10}));
  return train;
}

}  // namespace easydyn::vehicles
