#include "track/passage.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "easydyn/easydyn.hpp"
#include "tests/reference/winkler_beam.hpp"
#include "track/foundation.hpp"
#include "track/wheel_rail_contact.hpp"

namespace {

using namespace easydyn;
using namespace easydyn::track;
using easydyn::reference::WinklerBeam;

constexpr double g = 9.81;

// A sprung mass on one wheel pair, rolling over a track.
class RollingWheel : public System {
 public:
  RollingWheel(const TrackModel& model, double x0, double speed, std::shared_ptr<const Profile> profile)
      : track(*this, model),
        contact("wheel", HertzContact(1e11, 2), 0.4, 9000 * g, std::move(profile)),
        x0_(x0),
        speed_(speed) {}

  Coordinate wheel_z = coordinate("wheel"), body_z = coordinate("body");
  Body& wheel = body("wheel", 1000.0);
  Body& mass = body("body", 8000.0);
  VerticalSpringDamper suspension{"suspension", 1e6, 3e4, 0, 8000 * g};
  FlexibleTrack track;
  WheelRailContact contact;

  void positions() override {
    wheel = translate(x0_ + speed_ * time(), 0, wheel_z);
    mass = translate(x0_ + speed_ * time(), 0, body_z);
  }
  void forces() override {
    gravity(g);
    suspension.apply(wheel, {0, 0, 0}, mass, {0, 0, 0});
    contact.apply(wheel, track);
  }

 private:
  double x0_, speed_;
};

TrackData light_track() {
  TrackData data = t2000_like_track();
  data.elements_per_bay = 2;
  data.ends.bays = 10;
  return data;
}

const std::vector<Foundation> all_foundations = {RigidGround{}, Winkler{5e7, 4e5}, WinklerMass{600, 5e7, 4e5},
                                                 Clm{600, 5e7, 4e5, 2.4e7, -9e4}};

TEST(Passage, StartsWithTheContactForceEqualToTheWeightOnEveryFoundation) {
  for (const Foundation& foundation : all_foundations) {
    TrackData data = light_track();
    data.foundation = foundation;
    RollingWheel system(TrackModel(data, 60, -21.6), 0.1, 10, std::make_shared<FlatProfile>());
    const State s = solve_static_equilibrium(system);
    system.evaluate(s);
    const double W = 9000 * g;
    EXPECT_NEAR(system.contact.force() / W, 1, 1e-10) << kind_of(foundation);
    const Eigen::VectorXd q = system.track.coordinates(s.q), qd = system.track.coordinates(s.qd);
    EXPECT_NEAR(system.track.model().ballast_reactions(q, qd).sum() / W, 1, 1e-10) << kind_of(foundation);
  }
}

Passage roll(const Foundation& foundation, double step, std::shared_ptr<const Profile> profile,
             double speed = 10, double duration = 0.5) {
  TrackData data = light_track();
  data.foundation = foundation;
  RollingWheel system(TrackModel(data, 60, -21.6), -speed * duration / 2, speed, std::move(profile));
  return compute_passage(
      system, system.track, {&system.contact},
      {.duration = duration, .step = step, .output_step = 1e-3, .first_sleeper_x = -5, .last_sleeper_x = 5});
}

TEST(Passage, BeginsWithoutATransient) {
  // On a perfect rail the force varies with the sleepers only. The quasi-static start leaves out the dynamic part
  // of that variation, so the first bays may vary by a little more than later ones: 0.2 % of the load (measured
  // 0.17 %).
  for (const Foundation& foundation : all_foundations) {
    const Passage p = roll(foundation, 2e-4, std::make_shared<FlatProfile>());
    const auto range = [&](Eigen::Index begin) {
      const auto part = p.contact_force.col(0).segment(begin, 72);  // one bay of 0.72 m at 10 m/s
      return part.maxCoeff() - part.minCoeff();
    };
    EXPECT_LT(range(0) - range(400), 2e-3 * 9000 * g) << kind_of(foundation);
  }
}

TEST(Passage, KeepsTheSumOfReactionsNearTheWeight) {
  // Global equilibrium: reactions = weight + inertia of masses that hardly accelerate on a perfect rail: about
  // 1.5 t of rail and sleepers at v^2 w'' = 0.2 m/s^2 make 0.4 %; measured 0.6 %.
  TrackData data = light_track();
  RollingWheel system(TrackModel(data, 60, -21.6), -2.5, 10, std::make_shared<FlatProfile>());
  const Passage p = compute_passage(
      system, system.track, {&system.contact},
      {.duration = 0.5, .step = 2e-4, .output_step = 1e-3, .first_sleeper_x = -22, .last_sleeper_x = 22});
  for (Eigen::Index i = 0; i < p.time.size(); i += 20)
    EXPECT_NEAR(p.ballast_reaction.row(i).sum() / (9000 * g), 1, 1e-2);
}

TEST(Passage, OverABumpBalancesItsEnergyAtSecondOrderWithTheDriveAtWork) {
  // A smooth bump in place of the step, so that the order of the quadrature can be seen.
  class Bump : public Profile {
   public:
    ProfilePoint at(double x, double) const override {
      const double L = 1.5, a = 1e-3, k = std::acos(-1.0) / L;
      if (std::abs(x) > L) return {};
      return {a / 4 * std::pow(1 + std::cos(k * x), 2), -a / 2 * k * (1 + std::cos(k * x)) * std::sin(k * x),
              -a / 2 * k * k * (std::cos(k * x) + std::cos(2 * k * x))};
    }
  };
  const auto imbalance = [](double step) {
    const Passage p = roll(t2000_like_track().foundation, step, std::make_shared<Bump>());
    const Eigen::VectorXd total =
        p.kinetic_energy + p.potential_energy + p.dissipated_energy - p.supplied_energy;
    const double turnover = p.dissipated_energy[p.dissipated_energy.size() - 1];
    EXPECT_GT(turnover, 1);  // [J]
    return (total.array() - total[0]).abs().maxCoeff() / turnover;
  };
  const double coarse = imbalance(5e-4), fine = imbalance(2.5e-4);
  EXPECT_LT(fine, 2e-3);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.3);
}

TEST(Passage, OverAStepKeepsTheReactionsWhenTheTimeStepIsHalved) {
  const Foundation clm = t2000_like_track().foundation;
  const auto step = std::make_shared<StepProfile>(0, 1e-3);
  const Passage coarse = roll(clm, 1e-4, step), fine = roll(clm, 5e-5, step);
  EXPECT_GT(coarse.contact_force.maxCoeff(), 1.5 * 9000 * g);
  // The soil sees the reactions; the impact itself is sampled at output times and converges more slowly.
  EXPECT_LT((coarse.ballast_reaction - fine.ballast_reaction).norm(), 0.01 * fine.ballast_reaction.norm());
  EXPECT_NEAR(coarse.largest_contact_force[0] / fine.largest_contact_force[0], 1, 0.1);
}

TEST(Passage, WarnsWhereTheBallastPullsMoreThanTheTrackWeighs) {
  const Passage flat = roll(t2000_like_track().foundation, 2e-4, std::make_shared<FlatProfile>());
  EXPECT_TRUE(flat.warnings.empty());
  EXPECT_NEAR(flat.track_weight, 9.81 * (180 + 0.72 * 2 * 49.97), 1e-6);
  const Passage step = roll(t2000_like_track().foundation, 2e-4, std::make_shared<StepProfile>(0, 4e-3));
  ASSERT_EQ(step.warnings.size(), 1u);
  EXPECT_NE(step.warnings[0].find("uplift"), std::string::npos);
}

TEST(Passage, OnAMovingConstantForceDeflectsTheRailAsTheClosedForm) {
  // One UIC60 rail on 50 MN/m2 under 85 kN at a fifth and two fifths of the critical speed.
  const double EI = 6.38e6, m = 60.21, k = 50e6, P = 85e3, spacing = 0.15;
  const WinklerBeam beam{EI, m, k};
  TrackData data;
  data.name = "fine";
  data.rail = rail_section("60E1");
  data.rail.inertia = EI / data.rail.youngs_modulus;
  data.rails = 1;
  data.sleeper_spacing = spacing;
  data.pad_stiffness = k * spacing;
  data.pad_damping =
      2e-3 * 2 * std::sqrt(k * m) * spacing;  // 0.2 %: lets the start fade, changes little else
  data.sleeper_mass = 1e-6;
  data.ballast_stiffness = 1e6 * k * spacing;
  data.footprint_length = data.footprint_width = 1;
  data.elements_per_bay = 1;
  data.ends.bays = 20;

  class MovingForce : public System {
   public:
    MovingForce(const TrackModel& model, double v, double F) : track(*this, model), v_(v), force_(F) {}
    FlexibleTrack track;
    void positions() override {}
    void forces() override { track.touch_rail(-40 + v_ * time().value()).add_force(force_); }
    double v_, force_;
  };

  for (const double ratio : {0.2, 0.4}) {
    const double v = ratio * beam.critical_speed();
    MovingForce system(TrackModel(data, 700, -52.5), v, P);
    Newmark integrator(system, solve_quasi_static_motion(system, system.initial_state(), 0.05 / v),
                       {.step = 0.02 / v});
    integrator.advance(70 / v);
    const double x = -40 + v * integrator.state().t;
    const Eigen::VectorXd q = system.track.coordinates(integrator.state().q);
    const double largest = beam.moving_deflection(P, v, 0);
    for (const double s : {0.0, 0.5, -0.5, 1.0, -1.0, 2.0, -2.0})
      EXPECT_NEAR(system.track.model().rail_point(x + s).deflection(q), beam.moving_deflection(P, v, s),
                  0.005 * largest)
          << "v / v_cr = " << ratio << ", s = " << s;
  }
}

TEST(Passage, SolvesTheSameEquationsAsTheFullSystem) {
  TrackData data = light_track();
  RollingWheel system(TrackModel(data, 60, -21.6), -1, 20, std::make_shared<StepProfile>(0, 1e-3));
  Newmark integrator(system, solve_quasi_static_motion(system, system.initial_state(), 1e-3), {.step = 1e-4});
  for (int i = 0; i < 800; ++i) {
    integrator.step();
    if (i % 50 != 0) continue;
    EXPECT_LT(system.compute_residual(integrator.state()).lpNorm<Eigen::Infinity>(), 1e-8 * 9000 * g);
  }
}

TEST(Passage, RefusesImpossibleOptions) {
  RollingWheel system(TrackModel(light_track(), 60, -21.6), 0, 10, std::make_shared<FlatProfile>());
  const auto run = [&](PassageOptions options) {
    return compute_passage(system, system.track, {&system.contact}, options);
  };
  EXPECT_THROW(run({.duration = -1}), ModelError);
  EXPECT_THROW(run({.duration = 1, .step = std::nan("")}), ModelError);
  EXPECT_THROW(run({.duration = 1, .step = 1e-4, .output_step = 2.5e-4}), ModelError);
  EXPECT_THROW(run({.duration = 1, .first_sleeper_x = 0.1, .last_sleeper_x = 0.2}),
               ModelError);  // no sleeper there
}

TEST(WheelRailContact, SaysWhenTheWheelLeavesTheTrack) {
  RollingWheel system(TrackModel(light_track(), 60, -21.6), 30, 10, std::make_shared<FlatProfile>());
  EXPECT_THROW(system.evaluate(system.initial_state()), ModelError);
}

TEST(WheelRailContact, RefusesImpossibleDataByName) {
  const auto flat = std::make_shared<FlatProfile>();
  EXPECT_THROW(WheelRailContact("w", HertzContact(), -0.3, 1e4, flat), ModelError);
  EXPECT_THROW(WheelRailContact("w", HertzContact(), 0.3, std::nan(""), flat), ModelError);
  EXPECT_THROW(WheelRailContact("w", HertzContact(), 0.3, 1e4, nullptr), ModelError);
}

}  // namespace
