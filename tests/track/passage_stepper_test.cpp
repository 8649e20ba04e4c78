// The fast way of a passage against the general-purpose integrator, and the travelling window against the whole track.

#include "track/passage_stepper.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "easydyn/easydyn.hpp"
#include "tests/track/passage_comparison.hpp"
#include "track/hanging_sleepers.hpp"
#include "track/moving_load.hpp"
#include "track/passage.hpp"
#include "track/wheel_rail_contact.hpp"

namespace easydyn::track {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double g = 9.81;

/// Bogies of two wheel pairs, each frame with a mass on top: bounce and pitch, nearly linear.
class Train : public System {
 public:
  struct Bogie {
    Bogie(System& s, const std::string& name, double x_)
        : x(x_),
          frame_z(s.coordinate(name + " frame")),
          frame_pitch(s.coordinate(name + " pitch")),
          load_z(s.coordinate(name + " load")),
          front_z(s.coordinate(name + " front")),
          rear_z(s.coordinate(name + " rear")),
          frame(s.body(name + " frame", Inertia(2500, 1800))),
          load(s.body(name + " load", 15000.0)),
          front(s.body(name + " front", 1800.0)),
          rear(s.body(name + " rear", 1800.0)) {}
    double x;
    Coordinate frame_z, frame_pitch, load_z, front_z, rear_z;
    Body &frame, &load, &front, &rear;
    VerticalSpringDamper secondary{"secondary", 7e5, 4e4, 0, 15000 * g},
        primary_front{"front", 2.4e6, 2e4, 0, 8750 * g}, primary_rear{"rear", 2.4e6, 2e4, 0, 8750 * g};
  };

  Train(const TrackModel& model, const std::vector<double>& places, double x0, double speed,
        const std::shared_ptr<const Profile>& profile)
      : track(*this, model), x0_(x0), speed_(speed) {
    for (std::size_t b = 0; b < places.size(); ++b) {
      const std::string name = "bogie " + std::to_string(b);
      bogies.emplace_back(*this, name, places[b]);
      for (const char* wheel : {" front", " rear"})
        contacts.emplace_back(name + wheel, HertzContact(1e11, 2), 0.46, (8750 + 1800) * g, profile);
    }
  }
  std::deque<Bogie> bogies;
  FlexibleTrack track;
  std::deque<WheelRailContact> contacts;

  std::vector<const TrackContact*> contact_list() const {
    std::vector<const TrackContact*> list;
    for (const WheelRailContact& c : contacts) list.push_back(&c);
    return list;
  }

 protected:
  void positions() override {
    const Expr x = x0_ + speed_ * time();
    for (Bogie& b : bogies) {
      b.frame = translate(x + b.x, 0, b.frame_z) * rotate_y(b.frame_pitch);
      b.load = translate(x + b.x, 0, b.load_z);
      b.front = translate(x + (b.x + 1.25), 0, b.front_z);
      b.rear = translate(x + (b.x - 1.25), 0, b.rear_z);
    }
  }
  void forces() override {
    gravity(g);
    std::size_t c = 0;
    for (Bogie& b : bogies) {
      b.secondary.apply(b.frame, {0, 0, 0}, b.load, {0, 0, 0});
      b.primary_front.apply(b.front, {0, 0, 0}, b.frame, {1.25, 0, 0});
      b.primary_rear.apply(b.rear, {0, 0, 0}, b.frame, {-1.25, 0, 0});
      contacts[c++].apply(b.front, track);
      contacts[c++].apply(b.rear, track);
    }
  }

 private:
  double x0_, speed_;
};

/// A bump of 2 mm that the wheels leave and land on, smooth enough for the impact to be resolved.
class Bump : public Profile {
 public:
  explicit Bump(double height = 2e-3, double half_length = 0.5) : a_(height), L_(half_length) {}
  ProfilePoint at(double x, double) const override {
    const double k = std::acos(-1.0) / L_;
    if (std::abs(x) > L_) return {};
    return {a_ / 4 * std::pow(1 + std::cos(k * x), 2), -a_ / 2 * k * (1 + std::cos(k * x)) * std::sin(k * x),
            -a_ / 2 * k * k * (std::cos(k * x) + std::cos(2 * k * x))};
  }

 private:
  double a_, L_;
};

TEST(PassageStepper, IsNewmarksMethodOfTheKernelOnEveryFoundation) {
  for (const Foundation& foundation :
       {Foundation(RigidGround{}), Foundation(Winkler{5e7, 4e5}), Foundation(WinklerMass{600, 5e7, 4e5}),
        thalys_like_track().foundation}) {
    TrackData data = thalys_like_track();
    data.foundation = foundation;
    PassageOptions options{
        .duration = 0.12, .step = 2e-4, .output_step = 2e-4, .first_sleeper_x = -12, .last_sleeper_x = 12};
    const TrackModel model(data, 100, -30);
    const auto bump = std::make_shared<Bump>();
    Train one(model, {-4, 3}, -3, 60, bump), other(model, {-4, 3}, -3, 60, bump);
    const Passage fast = compute_passage(one, one.track, one.contact_list(), options);
    options.use_kernel = true;
    const Passage kernel = compute_passage(other, other.track, other.contact_list(), options);
    EXPECT_LT(fast.smallest_contact_force.minCoeff(), 1e-3) << "no wheel lifts off";
    EXPECT_LT(largest_relative_difference(fast.contact_force, kernel.contact_force), 1e-8);
    EXPECT_LT(largest_relative_difference(fast.ballast_reaction, kernel.ballast_reaction), 1e-8);
    EXPECT_LT(largest_relative_difference(fast.coordinates, kernel.coordinates), 1e-8);
    EXPECT_LT(largest_relative_difference(fast.body_acceleration, kernel.body_acceleration), 1e-8);
    EXPECT_LT(largest_relative_difference(fast.rail_deflection, kernel.rail_deflection), 1e-8);
    EXPECT_LT(largest_relative_difference(fast.kinetic_energy, kernel.kinetic_energy), 1e-8);
    EXPECT_LT(fast.statistics.evaluations, 3 * fast.statistics.steps);
  }
}

/// Ballast reactions below 200 Hz of the middle 10 m of a track of so many bays; a train of 18.5 m goes over them at 80 m/s.
Eigen::MatrixXd low_reactions(const Profile& profile, double window, int bays, double x0,
                              double duration = 1) {
  constexpr double dt = 4e-4;
  const TrackModel model(thalys_like_track(), bays, -0.3 * bays);
  Train train(model, {-8, 8}, x0, 80, std::shared_ptr<const Profile>(&profile, [](const Profile*) {}));
  const Passage p = compute_passage(train, train.track, train.contact_list(),
                                    {.duration = duration,
                                     .step = 2e-4,
                                     .window = window,
                                     .output_step = dt,
                                     .first_sleeper_x = -5,
                                     .last_sleeper_x = 5});
  EXPECT_EQ(p.statistics.moves > 100, window > 0);
  return below_200_hz(p.ballast_reaction, dt);
}

TEST(PassageStepper, GivesTheSameInATravellingWindow) {
  // 31 m of track before and behind the wheels: what the rail carries farther lies above 200 Hz.
  const Bump smooth(0.5e-3, 0.6);
  const Eigen::MatrixXd whole = low_reactions(smooth, 0, 400, -30);
  EXPECT_LT(largest_relative_difference(low_reactions(smooth, 80, 400, -30), whole), 1e-6);
  // The same on a longer track, and on one so short that its ends are as near as the window's.
  EXPECT_LT(largest_relative_difference(low_reactions(smooth, 80, 500, -30), whole), 1e-6);
  EXPECT_LT(largest_relative_difference(low_reactions(smooth, 0, 320, -30), whole), 1e-6);
}

TEST(PassageStepper, GivesTheSameInALongerWindowWhereWheelsLiftOff) {
  // When contact is lost the wheels mix what comes back above 200 Hz into what lies below: 46 m are enough for 1e-6.
  const Bump rough(1e-3, 0.4);
  const Eigen::MatrixXd whole = low_reactions(rough, 0, 400, -30);
  EXPECT_LT(largest_relative_difference(low_reactions(rough, 110, 400, -30), whole), 1e-6);
}

TEST(PassageStepper, DoesNotDependOnWhereItStarts) {
  // The quasi-static start leaves out what the ripple of the sleepers does to the vehicle: 2e-5 of the reactions at first,
  // which dies with the bounce of the loads, exp(-1.33 t). After 3.4 s, 280 m, the start is forgotten; the window does not
  // mind how far it travels. A start half a bay later is 4 ms later, rows are shifted.
  const Bump smooth(0.5e-3, 0.6);
  const Eigen::MatrixXd early = low_reactions(smooth, 80, 1200, -292.4, 4.2),
                        late = low_reactions(smooth, 80, 1200, -292.08, 4.2);
  const Eigen::Index shift = 10;  // 0.32 m at 80 m/s in steps of 0.4 ms
  const Eigen::Index first = 8000, rows = late.rows() - shift - first;
  EXPECT_LT(largest_relative_difference(early.middleRows(shift + first, rows), late.middleRows(first, rows)),
            1e-6);
}

TEST(PassageStepper, IsNewmarksMethodOfTheKernelWhereSleepersHangAndSupportsVary) {
  TrackData data = thalys_like_track();
  data.ends.bays = 10;
  data.variation = [](int sleeper, double x) {
    SupportVariation here;
    here.foundation = x < 0 ? 1 : 3;
    here.ballast = 1 + 0.2 * std::cos(sleeper);
    if (sleeper == 50 || sleeper == 51) here.gap = 0.3e-3;
    return here;
  };
  class HangingTrain : public Train {
   public:
    using Train::Train;
    void forces() override {
      Train::forces();
      apply_hanging_sleepers(track, energy());
    }
  };
  const TrackModel model(data, 180, -30);
  const auto flat = std::make_shared<FlatProfile>();
  PassageOptions options{
      .duration = 0.15, .step = 1e-4, .output_step = 1e-3, .first_sleeper_x = -5, .last_sleeper_x = 5};
  const auto run = [&](double window, bool use_kernel) {
    HangingTrain train(model, {-4, 3}, -3, 60, flat);
    options.window = window;
    options.use_kernel = use_kernel;
    return compute_passage(train, train.track, train.contact_list(), options);
  };
  const Passage kernel = run(0, true), whole = run(0, false), part = run(50, false);
  const Eigen::Index hanging = 8;  // sleeper 50 is the ninth recorded, at x = 0
  ASSERT_NEAR(kernel.sleeper_x[hanging], 0, 1e-9);
  EXPECT_EQ(kernel.ballast_reaction.col(hanging).minCoeff(), 0);    // never pulled
  EXPECT_GT(kernel.ballast_reaction.col(hanging).maxCoeff(), 1e3);  // but the gap closes
  EXPECT_LT(largest_relative_difference(whole.ballast_reaction, kernel.ballast_reaction), 1e-8);
  EXPECT_LT(largest_relative_difference(whole.contact_force, kernel.contact_force), 1e-8);
  EXPECT_GT(part.statistics.moves, 10);  // each with a factorisation of its own
  EXPECT_LT(largest_relative_difference(part.ballast_reaction, kernel.ballast_reaction),
            1e-4);  // 16 m before the ends
}

/// One window run against the whole track, of a train of 18.5 m that goes 32 m at 80 m/s.
double window_error(const TrackData& data, double speed, double window) {
  const TrackModel model(data, 400, -200 * data.sleeper_spacing);
  const auto bump = std::make_shared<Bump>(0.3e-3, 0.6);
  const auto run = [&](double length) {
    Train train(model, {-8, 8}, speed > 0 ? -16 : 16, speed, bump);
    return compute_passage(train, train.track, train.contact_list(),
                           {.duration = 0.4,
                            .step = 2e-4,
                            .window = length,
                            .output_step = 2e-3,
                            .first_sleeper_x = -5,
                            .last_sleeper_x = 5});
  };
  const Passage whole = run(0), part = run(window);
  EXPECT_GT(part.statistics.moves, 40);
  return largest_relative_difference(part.ballast_reaction, whole.ballast_reaction);
}

TEST(PassageStepper, TravelsOverEveryKindOfTrackInBothDirections) {
  // What comes back from the ends 31 m away, unfiltered: some 1e-6 on ballast. A wrong unknown anywhere would be of order 1.
  constexpr double window = 80, allowed = 2e-5;
  EXPECT_LT(window_error(thalys_like_track(), -80, window), allowed) << "backward";
  TrackData data = thalys_like_track();
  data.foundation = RigidGround{};
  EXPECT_LT(window_error(data, 80, window), allowed) << "rigid ground";
  data = thalys_like_track();
  data.elements_per_bay = 1;
  EXPECT_LT(window_error(data, 80, window), 1e-3)
      << "one element per bay: its waves are too stiff for the ends";
  data = thalys_like_track();
  data.elements_per_bay = 3;
  data.theory = RailTheory::timoshenko;
  EXPECT_LT(window_error(data, 80, window), allowed) << "Timoshenko";
  data = zhai_2004_track();
  data.under_sleeper_pads = UnderSleeperPads{4e8, 4e4};
  EXPECT_LT(window_error(data, 80, window), 1e-3) << "ballast mass and pads: bedding with little damping";
  data = thalys_like_track();
  data.slab = Slab{3e8, 3000};
  data.sleeper_mass = 0;
  data.ends = {.bays = 40, .alpha = 1500, .beta = 2e-4};
  EXPECT_LT(window_error(data, 80, 120), 1e-2) << "slab: long waves";
}

TEST(PassageStepper, LeavesHangingSleepersBehind) {
  TrackData data = thalys_like_track();
  data.ends.bays = 10;
  data.variation = [](int sleeper, double) {
    SupportVariation here;
    if (sleeper == 85 || sleeper == 230) here.gap = 0.3e-3;  // left behind at 6 m, and far ahead
    return here;
  };
  class HangingTrain : public Train {
   public:
    using Train::Train;
    void forces() override {
      Train::forces();
      apply_hanging_sleepers(track, energy());
    }
  };
  const TrackModel model(data, 300, -45);
  const auto flat = std::make_shared<FlatProfile>();
  const auto run = [&](double window) {
    HangingTrain train(model, {-4, 3}, -3, 80, flat);
    return compute_passage(train, train.track, train.contact_list(),
                           {.duration = 0.75,
                            .step = 2e-4,
                            .window = window,
                            .output_step = 1e-3,
                            .first_sleeper_x = 0,
                            .last_sleeper_x = 60});
  };
  const Passage whole = run(0), part = run(60);
  EXPECT_TRUE(part.dissipated_energy.allFinite());
  EXPECT_LT(largest_relative_difference(part.ballast_reaction, whole.ballast_reaction), 1e-4);
}

TEST(PassageStepper, CarriesMovingLoads) {
  class Loads : public System {
   public:
    Loads(const TrackModel& model) : track(*this, model) {}
    FlexibleTrack track;
    MovingLoad front{"front", 80e3}, rear{"rear", 90e3};
    void positions() override {}
    void forces() override {
      const double x = -6 + 50 * time().value();
      front.apply(x + 3, 50, track, energy());
      rear.apply(x, 50, track, energy());
    }
  };
  const TrackModel model(thalys_like_track(), 120, -36);
  PassageOptions options{
      .duration = 0.12, .step = 2e-4, .output_step = 1e-3, .first_sleeper_x = -9, .last_sleeper_x = 9};
  Loads one(model), other(model);
  const Passage fast = compute_passage(one, one.track, {&one.front, &one.rear}, options);
  options.use_kernel = true;
  const Passage kernel = compute_passage(other, other.track, {&other.front, &other.rear}, options);
  EXPECT_LT(largest_relative_difference(fast.ballast_reaction, kernel.ballast_reaction), 1e-10);
  EXPECT_NEAR(fast.static_ballast_reaction / 170e3, 1, 1e-10);
  EXPECT_LT(largest_relative_difference(fast.supplied_energy, kernel.supplied_energy), 1e-8);
}

TEST(PassageStepper, TakesAMovingLoadThatPullsAsNoLossOfContactAndReportsTheRunInToo) {
  class Load : public System {
   public:
    FlexibleTrack track{*this, TrackModel(thalys_like_track(), 120, -36)};
    MovingLoad load{"load", -50e3};
    void positions() override {}
    void forces() override { load.apply(-10 + 50 * time().value(), 50, track, energy()); }
  } system;
  std::vector<double> fractions;
  const Passage p = compute_passage(system, system.track, {&system.load},
                                    {.duration = 0.1,
                                     .step = 2e-4,
                                     .run_in = 0.1,
                                     .output_step = 1e-3,
                                     .first_sleeper_x = -9,
                                     .last_sleeper_x = 9},
                                    [&](double fraction) { fractions.push_back(fraction); });
  EXPECT_EQ(p.contact_losses.sum(), 0);
  EXPECT_EQ(p.contact_force.maxCoeff(), -50e3);
  ASSERT_EQ(fractions.size(), 200u);  // one per output step, half of them in the run-in
  EXPECT_DOUBLE_EQ(fractions.front(), 0.005);
  EXPECT_DOUBLE_EQ(fractions.back(), 1);
}

TEST(PassageStepper, SaysWhatItCannotDo) {
  const TrackModel model(thalys_like_track(), 200, -60);
  const auto flat = std::make_shared<FlatProfile>();
  Train train(model, {0}, 0, 50, flat);
  const State start = train.initial_state();
  std::vector<const TrackContact*> contacts = {&train.contacts[0]};
  EXPECT_THAT([&] { PassageStepper(train, train.track, contacts, start, {}); },
              ThrowsMessage<ModelError>(
                  AllOf(HasSubstr("touches the track in 2 places"), HasSubstr("1 contacts are given"))));
  contacts.push_back(&train.contacts[1]);
  EXPECT_THAT([&] { PassageStepper(train, train.track, contacts, start, {.window = 20}); },
              ThrowsMessage<ModelError>(AllOf(HasSubstr("window"), HasSubstr("two absorbing ends"))));
  EXPECT_THROW(PassageStepper(train, train.track, contacts, start, {.step = 0}), ModelError);
  EXPECT_THROW(PassageStepper(train, train.track, contacts, start, {.window = -1}), ModelError);
}

}  // namespace
}  // namespace easydyn::track
