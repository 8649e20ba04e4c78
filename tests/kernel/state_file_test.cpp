#include "easydyn/sim/state_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "easydyn/easydyn.hpp"
#include "tests/temporary_folder.hpp"

using namespace easydyn;
using easydyn::testing::TemporaryFolder;

namespace {

// Everything that a state can hold: coordinates, a structure, a chart that has moved, a first-order state, a constraint.
class Everything : public System {
 public:
  FreeMotion motion = free_motion("top");
  Coordinate angle = coordinate("angle \"a\"", 0.3, 1.0);
  FirstOrderState current = first_order_state("current", 0.2);
  VelocityConstraint& link = velocity_constraint("link");
  Body& top = body("top", Inertia(1, 0.1, 0.2, 0.3));
  Body& wheel = body("wheel", Inertia(1, 0.1));

  Everything() : System("everything") {
    SparseMatrix one(2, 2);
    one.setIdentity();
    structure("track", one, 0.1 * one, 40 * one);
  }

 protected:
  void positions() override {
    top = motion.frame();
    wheel = rotate_z(angle);
    link = {{1, Expr(motion.x)}, {-0.5, Expr(angle)}};
  }
  void forces() override {
    current.set_rate(angle.rate() - current.value());
    wheel.add_moment({0, 0, -current.value()});
    PortShape shape;
    shape.add(1, 1.0);
    Port port = touch(*structures()[0], shape);
    port.add_force(2 - 3 * port.displacement());
  }
};

State moved_state(Everything& system) {
  State s = system.initial_state();
  s.qd.segment(3, 3) << 0.5, 4, 0.3;
  set_consistent_accelerations(system, s);
  Newmark integrator(system, s, {.step = 1e-3});
  integrator.advance(1.0);
  return integrator.state();
}

bool same_bits(const State& a, const State& b) {
  return a.t == b.t && a.q == b.q && a.qd == b.qd && a.qdd == b.qdd && a.x == b.x && a.xd == b.xd &&
         a.lambda == b.lambda && a.charts == b.charts && a.loops == b.loops;
}

TEST(StateFile, GivesEveryBitBack) {
  Everything system;
  const State s = moved_state(system);
  ASSERT_NE(s.charts[0], Eigen::Matrix3d::Identity());  // the chart has moved
  TemporaryFolder folder;
  write_state(folder.path() / "a.state", system, s);
  EXPECT_TRUE(same_bits(read_state(folder.path() / "a.state", system), s));
}

TEST(StateFile, LetsMethodsWithAMemoryGoOn) {
  const auto unbroken_and_restarted = [](auto make) {
    TemporaryFolder folder;
    Everything system;
    auto integrator = make(system, system.initial_state());
    integrator.advance(0.5);
    write_state(folder.path() / "a.state", system, integrator.state());
    integrator.advance(1.0);
    Everything fresh;
    auto restarted = make(fresh, read_state(folder.path() / "a.state", fresh));
    restarted.advance(1.0);
    return (integrator.state().q - restarted.state().q).norm();
  };
  // Newton stops at 1e-10 of the accelerations per step
  EXPECT_LT(unbroken_and_restarted([](System& s, const State& from) { return Hht(s, from, {.step = 1e-2}); }),
            1e-8);
  EXPECT_LT(unbroken_and_restarted(
                [](System& s, const State& from) { return GeneralizedAlpha(s, from, {.step = 1e-2}); }),
            1e-8);
}

TEST(StateFile, BringsInputsAndLoopsBack) {
  class Linkage : public System {
   public:
    Coordinate crank = coordinate("crank", 0.5, 5.0);
    Input torque = input("torque", 3);
    Loop<2> closing = loop<2>("four-bar", {0.5, 1.0});
    Body& rocker = body("rocker", Inertia(1, 0.1));
    double angle = 0;

   protected:
    void positions() override {
      const auto p = closing.solve([&](const auto& u) {
        return std::array{cos(crank) + 0.9 * cos(u[0]) - 1.1 * cos(u[1]) - 0.3,
                          sin(crank) + 0.9 * sin(u[0]) - 1.1 * sin(u[1])};
      });
      rocker = rotate_z(p[1]);
      angle = p[1].value();
    }
  } system;
  RungeKutta integrator(system, {.max_step = 0.02});
  integrator.advance(2);
  system.evaluate(integrator.state());
  const double angle = system.angle;
  system.torque.set(7);
  TemporaryFolder folder;
  write_state(folder.path() / "a.state", system, integrator.state());
  Linkage fresh;
  const State s = read_state(folder.path() / "a.state", fresh);
  fresh.evaluate(s);
  EXPECT_NEAR(fresh.angle, angle, 1e-12);
  EXPECT_EQ(fresh.torque.value(), 7);
}

TEST(StateFile, LetsARunGoOnAsFromMemory) {
  Everything system;
  const State s = moved_state(system);
  TemporaryFolder folder;
  write_state(folder.path() / "a.state", system, s);
  const auto go_on = [](const State& from) {
    Everything fresh;
    Newmark integrator(fresh, from, {.step = 1e-3});
    integrator.advance(1.5);
    return integrator.state();
  };
  Everything another;
  EXPECT_TRUE(same_bits(go_on(read_state(folder.path() / "a.state", another)), go_on(s)));
  // and as an unbroken run but for the stop of Newton's iteration, 1e-10 relative per step
  Everything unbroken;
  State start = unbroken.initial_state();
  start.qd.segment(3, 3) << 0.5, 4, 0.3;
  set_consistent_accelerations(unbroken, start);
  Newmark integrator(unbroken, start, {.step = 1e-3});
  integrator.advance(1.5);
  EXPECT_LT((integrator.state().q - go_on(s).q).norm(), 1e-8);
}

void expect_refusal(const std::filesystem::path& path, System& system, const std::string& words) {
  try {
    read_state(path, system);
    ADD_FAILURE() << "accepted: " << words;
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
  }
}

TEST(StateFile, IsRefusedWithFileAndLineWhereItDoesNotFit) {
  Everything system;
  TemporaryFolder folder;
  const auto path = folder.path() / "a.state";
  write_state(path, system, system.initial_state());
  std::ifstream in(path);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    std::ofstream(path) << changed;
  };
  expect_refusal(folder.path() / "none.state", system, "cannot be read");
  with("easydyn-state 1", "something else");
  expect_refusal(path, system, "a.state:1: \"easydyn-state 1\" expected");
  with("system everything", "system another");
  expect_refusal(path, system, ":2: \"another\" where the system has \"everything\"");
  with("top.y", "top.Y");
  expect_refusal(path, system, ":6: \"top.Y\" where the system has \"top.y\"");
  with("0x0p+0", "0.5");
  expect_refusal(path, system, ":3: \"0.5\" is not a number");
  with("coordinates 9", "coordinates 8");
  expect_refusal(path, system, ":4: 8 where the system has 9");
  with("end\n", "");
  expect_refusal(path, system, "the file ends before \"end\"");
}

TEST(StateFile, IsNotWrittenForAStateOfAnotherSystem) {
  Everything system;
  TemporaryFolder folder;
  EXPECT_THROW(write_state(folder.path() / "a.state", system, State()), ModelError);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "a.state"));
}

}  // namespace
