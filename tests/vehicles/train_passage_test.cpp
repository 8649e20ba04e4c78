// The passage of a whole high-speed train: 10 cars, 26 wheel pairs, 300 km/h, four rail elements per bay.

#include <gtest/gtest.h>

#include <cmath>

#include "examples/passage_program/train_on_track.hpp"
#include "tests/track/passage_comparison.hpp"
#include "track/defects.hpp"
#include "track/irregularity.hpp"
#include "vehicles/thalys_like.hpp"

namespace {

using namespace easydyn;
using track::largest_relative_difference;
using track::Passage;
using track::PassageOptions;
using track::Profile;
using ProfilePointer = std::shared_ptr<const Profile>;

constexpr double speed = 300 / 3.6, half_train = 97.52;  // middle of the train to its first axle

/// A track of so many bays about x = 0; a train whose middle starts at x0.
Passage run(const vehicles::RailVehicle& train, int bays, double x0, double v, const ProfilePointer& profile,
            const PassageOptions& options) {
  const track::TrackData data = track::thalys_like_track();
  examples::TrainOnTrack system(train, track::TrackModel(data, bays, -0.3 * bays), x0, v, profile);
  return compute_passage(system, system.track, system.contacts(), options);
}

/// Good track by its spectrum, waves of 2 to 20 m, flat outside and smooth at its ends.
ProfilePointer rough_rail(double begin, double end) {
  return std::make_shared<track::Irregularity>(
      track::sncf_good(),
      track::IrregularityOptions{
          .begin = begin, .end = end, .begin_taper = 8, .end_taper = 8, .longest_wavelength = 20});
}

/// The same between the bogies of a train whose middle starts at x0, and 12 m ahead of it: it starts on smooth rail.
ProfilePointer rough_between_bogies(const vehicles::RailVehicle& train, double x0) {
  std::vector<ProfilePointer> parts;
  const auto add = [&](double begin, double end) {
    parts.push_back(std::make_shared<track::Irregularity>(
        track::sncf_good(), track::IrregularityOptions{.begin = begin,
                                                       .end = end,
                                                       .begin_taper = 4,
                                                       .end_taper = 4,
                                                       .longest_wavelength = 20,
                                                       .seed = parts.size() + 1}));
  };
  const double clearance = 1.5 + 0.5;  // half of a wheelbase and a little
  add(x0 + train.gears[0].x + clearance, x0 + train.gears[0].x + clearance + 12);
  for (std::size_t i = 0; i + 1 < train.gears.size(); ++i) {
    const double begin = x0 + train.gears[i + 1].x + clearance, end = x0 + train.gears[i].x - clearance;
    if (end - begin > 8) add(begin, end);
  }
  return std::make_shared<track::ProfileSum>(parts);
}

// ---- the same model as the kernel's, and the window ----

TEST(TrainPassage, IsNewmarksMethodOfTheKernel) {
  // The same equations in another order: rounding, measured 6e-12 and less.
  // The rail is rough under all wheels from the start, and a bump lifts some off.
  const auto rail = std::make_shared<track::ProfileSum>(std::vector<ProfilePointer>{
      rough_rail(-150, 150), track::pulse(half_train + 2, {.height = 1.5e-3, .length = 0.8})});
  PassageOptions options{
      .duration = 0.1, .step = 2e-4, .output_step = 2e-4, .first_sleeper_x = -120, .last_sleeper_x = 120};
  const Passage fast = run(vehicles::thalys_like(), 560, 0, speed, rail, options);
  options.use_kernel = true;
  const Passage kernel = run(vehicles::thalys_like(), 560, 0, speed, rail, options);
  EXPECT_EQ(kernel.smallest_contact_force.minCoeff(), 0) << "no wheel lifts off";
  EXPECT_LT(largest_relative_difference(fast.contact_force, kernel.contact_force), 1e-8);
  EXPECT_LT(largest_relative_difference(fast.ballast_reaction, kernel.ballast_reaction), 1e-8);
  EXPECT_LT(largest_relative_difference(fast.coordinates, kernel.coordinates), 1e-8);
}

TEST(TrainPassage, GivesTheSameBallastReactionsBelow200HzInAWindowOf260m) {
  // From the first wheel 32 m to the end of the window; 300 m recorded, more than travels with the train.
  const vehicles::RailVehicle train = vehicles::thalys_like();
  const double x0 = -0.5 * speed;
  const ProfilePointer rail = rough_between_bogies(train, x0);
  constexpr double dt = 4e-4;
  PassageOptions options{
      .duration = 1, .step = 2e-4, .output_step = dt, .first_sleeper_x = -150, .last_sleeper_x = 150};
  const auto low = [&](double window) {
    options.window = window;
    const Passage p = run(train, 800, x0, speed, rail, options);
    EXPECT_EQ(p.contact_losses.sum(), 0);  // lost contact mixes what is above 200 Hz into what is below
    return track::below_200_hz(p.ballast_reaction, dt);
  };
  EXPECT_LT(largest_relative_difference(low(260), low(0)), 1e-6);  // measured 7e-10
}

// ---- energy ----

struct Balance {
  double work;   ///< dissipated, and supplied by its magnitude [J]
  double error;  ///< largest change of kinetic + potential + dissipated - supplied energy, part of the work
};
Balance balance(const Passage& p) {
  const Eigen::VectorXd total =
      p.kinetic_energy + p.potential_energy + p.dissipated_energy - p.supplied_energy;
  const Eigen::Index n = total.size() - 1;
  const double work =
      p.dissipated_energy[n] + (p.supplied_energy.tail(n) - p.supplied_energy.head(n)).cwiseAbs().sum();
  return {work, (total.array() - total[0]).abs().maxCoeff() / work};
}

constexpr double rough_length = 24;
// The power of a contact has a kink wherever it passes a node of the rail. Steps at this speed fall anywhere between the
// nodes; at 300 km/h 9 steps of 2e-4 s are one element, all kinks lie alike within their steps, and the error of a step
// depends on where.
constexpr double uneven_speed = 299 / 3.6;

TEST(TrainPassage, BalancesItsEnergyAtSecondOrderWithTheTractionPower) {
  // The whole train over the rough rail, from before it to behind it.
  const double way = 2 * half_train + rough_length + 6;
  const auto balance_at = [&](double step) {
    return balance(run(vehicles::thalys_like(), 800, -way / 2, uneven_speed, rough_rail(-12, 12),
                       {.duration = way / uneven_speed, .step = step, .output_step = 8e-4}));
  };
  const Balance coarse = balance_at(4e-4), fine = balance_at(2e-4);
  EXPECT_GT(fine.work, 4e5);  // [J], most of it the damping of the track under the moving loads
  EXPECT_LT(fine.error, 1e-4);
  EXPECT_NEAR(std::log2(coarse.error / fine.error), 2, 0.05);
}

/// The first car of the train: four wheel pairs on two bogies.
vehicles::RailVehicle traction_car() {
  vehicles::RailVehicle car = vehicles::thalys_like();
  car.name = "traction car";
  car.bodies.resize(1);
  car.gears.resize(2);
  car.length = car.bodies[0].length;
  const double middle = car.bodies[0].x;
  car.bodies[0].x.value -= middle;
  for (vehicles::RunningGear& gear : car.gears) {
    gear.x.value -= middle;
    gear.pivot_x.value -= middle;
    for (vehicles::SecondarySuspension& s : gear.secondaries) s.x.value -= middle;
    for (vehicles::WheelPair& pair : gear.wheel_pairs) pair.x.value -= middle;
  }
  return car;
}

TEST(TrainPassage, OfATractionCarBalancesItsEnergyTo1e6) {
  // The error falls by 4 from step to step; 2e-5 s, at which the whole train would take minutes, for one car.
  const double way = 17 + rough_length + 6;
  const auto balance_at = [&](double step) {
    return balance(run(traction_car(), 220, -way / 2, uneven_speed, rough_rail(-12, 12),
                       {.duration = way / uneven_speed, .step = step, .output_step = 4e-4}));
  };
  const Balance coarse = balance_at(4e-5), fine = balance_at(2e-5);
  EXPECT_LT(fine.error, 1e-6);
  EXPECT_NEAR(std::log2(coarse.error / fine.error), 2, 0.05);
}

TEST(TrainPassage, OverAStepBalancesItsEnergyMoreSlowly) {
  // Four impacts on a step of 0.3 mm: what a step of time does not resolve. Measured 1.7 % at 1e-4 s, 0.2 % at 2e-5 s.
  const auto error_at = [](double step) {
    return balance(run(traction_car(), 220, -14, speed, std::make_shared<track::StepProfile>(0, 0.3e-3),
                       {.duration = 0.32, .step = step, .output_step = 4e-4}))
        .error;
  };
  const double coarse = error_at(1e-4), fine = error_at(2e-5);
  EXPECT_LT(coarse, 2.5e-2);
  EXPECT_LT(fine, 3e-3);
  const double order = std::log(coarse / fine) / std::log(5);
  EXPECT_GT(order, 1);
  EXPECT_LT(order, 1.7);
}

// ---- symmetry ----

/// x -> -x: what was in front is behind.
vehicles::RailVehicle mirrored(vehicles::RailVehicle v) {
  const auto flip = [](Sourced& x) { x.value = -x.value; };
  for (vehicles::CarBody& body : v.bodies) {
    flip(body.x);
    flip(body.middle_offset);
  }
  for (vehicles::Hinge& hinge : v.hinges) flip(hinge.x);
  for (vehicles::RunningGear& gear : v.gears) {
    flip(gear.x);
    flip(gear.pivot_x);
    for (vehicles::SecondarySuspension& s : gear.secondaries) flip(s.x);
    for (vehicles::WheelPair& pair : gear.wheel_pairs) flip(pair.x);
  }
  return v;
}

class MirroredProfile : public Profile {
 public:
  explicit MirroredProfile(ProfilePointer rail) : rail_(std::move(rail)) {}
  track::ProfilePoint at(double x, double wheel_radius) const override {
    track::ProfilePoint p = rail_->at(-x, wheel_radius);
    p.dr = -p.dr;
    return p;
  }

 private:
  ProfilePointer rail_;
};

TEST(TrainPassage, OfTheReversedTrainIsTheMirrorImage) {
  // The train is symmetric: let every car and bogie differ from its neighbours.
  vehicles::RailVehicle train = vehicles::thalys_like();
  for (std::size_t i = 0; i < train.bodies.size(); ++i)
    train.bodies[i].mass.value *= 1 + 0.03 * static_cast<double>(i);
  for (std::size_t i = 0; i < train.gears.size(); ++i)
    for (auto& s : train.gears[i].secondaries) s.stiffness.value *= 1 + 0.05 * static_cast<double>(i);
  const ProfilePointer rail = rough_between_bogies(train, -8);
  const PassageOptions options{
      .duration = 0.2, .step = 2e-4, .output_step = 4e-4, .first_sleeper_x = -120, .last_sleeper_x = 120};
  const Passage forth = run(train, 560, -8, speed, rail, options),
                back = run(mirrored(train), 560, 8, -speed, std::make_shared<MirroredProfile>(rail), options);
  const double forces = largest_relative_difference(back.contact_force, forth.contact_force),
               reactions = largest_relative_difference(back.ballast_reaction.rowwise().reverse(),
                                                       forth.ballast_reaction);
  // Rounding, measured 6e-13 and 2e-13; the train that is not mirrored differs by 0.4.
  EXPECT_LT(forces, 1e-8);
  EXPECT_LT(reactions, 1e-8);
}

// ---- start ----

TEST(TrainPassage, StartsWithTheAxleLoadsAndForgetsItsStartIn60ms) {
  const Passage p = run(vehicles::thalys_like(), 560, 0, speed, std::make_shared<track::FlatProfile>(),
                        {.duration = 0.3, .step = 2e-4, .output_step = 4e-4});
  std::vector<double> loads;
  for (const auto& gear : vehicles::compute_axle_loads(vehicles::thalys_like()).wheel_pairs)
    for (const auto& pair : gear) loads.push_back(pair.axle_load);
  const Eigen::Map<const Eigen::RowVectorXd> Q(loads.data(), 26);
  // Bodies at rest at the start: each wheel pair bears its load, to rounding.
  EXPECT_LT(largest_relative_difference(p.contact_force.row(0), Q), 1e-10);
  EXPECT_NEAR(p.static_ballast_reaction / Q.sum(), 1, 1e-10);
  // The sleepers, 139 a second, then move each force by 2.5 % of the load. The wheels do not have that motion yet, and
  // while they find it a force varies by up to 9.6 % in the first 30 ms, whatever the start's difference step.
  const auto range = [&](Eigen::Index begin, Eigen::Index rows) {
    const auto part = p.contact_force.middleRows(begin, rows);
    return ((part.colwise().maxCoeff() - part.colwise().minCoeff()).array() / Q.array()).maxCoeff();
  };
  EXPECT_LT(range(0, 75), 0.1);
  EXPECT_LT(range(150, 150), 1.1 * range(500, 250));
}

// ---- cost ----

TEST(TrainPassage, CostsAsManyEvaluationsPerStepWhateverTheDistanceAndLittleMemory) {
  const double x0 = -0.5 * speed;
  const auto rough = rough_between_bogies(vehicles::thalys_like(), x0);
  const auto pass = [&](const ProfilePointer& rail, double duration) {
    return run(vehicles::thalys_like(), 800, x0, speed, rail,
               {.duration = duration,
                .step = 2e-4,
                .window = 260,
                .output_step = 1e-3,
                .first_sleeper_x = -180,
                .last_sleeper_x = 180});
  };
  struct Cost {
    double begin, rest;  // evaluations per step, in 0.2 s with the only Jacobian of 74, and from there to 1 s
  };
  const auto cost = [](const Passage& part, const Passage& whole) {
    const auto &a = part.statistics, &b = whole.statistics;
    EXPECT_EQ(b.jacobians, 1);
    return Cost{static_cast<double>(a.evaluations) / static_cast<double>(a.steps),
                static_cast<double>(b.evaluations - a.evaluations) / static_cast<double>(b.steps - a.steps)};
  };
  const auto flat = std::make_shared<track::FlatProfile>();
  const Passage second = pass(rough, 1);
  const Cost on_flat = cost(pass(flat, 0.2), pass(flat, 1)), on_rough = cost(pass(rough, 0.2), second);
  EXPECT_LT(on_flat.begin, 2.1);
  EXPECT_LT(on_flat.rest, 2.01);
  // On a rough rail many steps need a third one: cars that pitch are not quite linear. Measured 2.7, then 2.5.
  EXPECT_LT(on_rough.begin, 3);
  EXPECT_LT(on_rough.rest, on_rough.begin);
  EXPECT_LT(second.memory, 100e6);  // measured 24 MB with the histories of 600 sleepers
}

}  // namespace
