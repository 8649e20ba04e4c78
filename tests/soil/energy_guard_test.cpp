#include "soil/energy_guard.hpp"

#include <gtest/gtest.h>

#include "soil/wave_engine.hpp"
#include "tests/soil/small_ground.hpp"

namespace easydyn::soil {
namespace {

TEST(EnergyGuard, AcceptsWhatTheLoadsHaveBroughtIn) {
  EnergyGuard guard;
  EXPECT_TRUE(guard.is_explained(0));  // no load, no motion
  EXPECT_FALSE(guard.is_explained(1e-30));
  guard.add_work(3);
  guard.add_work(-2);  // the highest work counts: what was stored may come back later
  EXPECT_EQ(guard.most_work(), 3);
  EXPECT_TRUE(guard.is_explained(3));
  EXPECT_TRUE(guard.is_explained(29));
  EXPECT_FALSE(guard.is_explained(31));
}

TEST(EnergyGuard, KnowsWhatIsNotFinite) {
  EnergyGuard guard;
  EXPECT_FALSE(guard.is_finite(std::nan("")));
  EXPECT_FALSE(guard.is_explained(std::nan("")));
  EXPECT_FALSE(guard.is_finite(HUGE_VAL));
  EXPECT_TRUE(guard.is_finite(1e300));
  guard.add_work(std::nan(""));
  EXPECT_FALSE(guard.is_finite(1));
}

/// Largest kinetic energy / work of the loads, and that ratio where the guard objects first (0: never).
struct Course {
  double largest_ratio = 0, energy_at_objection = 0;
};

Course run_engine(double step_over_limit, double beta, std::vector<double> memory_weights,
                  const std::vector<double>& rates, int steps) {
  const Site site = test::small_site();
  const Lattice lattice = make_lattice(site, test::small_loads().footprints, {.degree = 3});
  std::vector<EngineMaterial> materials;
  for (const Layer& layer : site.layers)
    materials.push_back({layer.lame_lambda(), layer.shear_modulus(), layer.density, beta, memory_weights});
  WaveEngine<float> engine(lattice, materials, rates, {.sponge_speed = 200}, 1);
  const double dt = step_over_limit * engine.compute_stable_step();
  engine.set_time_step(dt);
  const int X = engine.nodes_x() / 2, top = engine.nodes_z() - 1;
  EnergyGuard guard;
  Course course;
  for (int step = 0; step < steps; ++step) {
    const double t = step * dt, force = t < 0.05 ? 1e4 * std::pow(std::sin(M_PI * t / 0.05), 2) : 0;
    const double before = engine.velocity(2, X, 0, top);
    engine.advance({{X, 0, force}}, true);
    guard.add_work(dt / 2 * force * (before + engine.velocity(2, X, 0, top)));
    if (guard.most_work() > 0)
      course.largest_ratio = std::max(course.largest_ratio, engine.kinetic_energy() / guard.most_work());
    if (!guard.is_finite(engine.energy()) || !guard.is_explained(engine.kinetic_energy())) {
      course.energy_at_objection = engine.kinetic_energy() / guard.most_work();
      break;
    }
  }
  return course;
}

TEST(EnergyGuard, IsFarFromItsLimitInAStableRun) {
  // All of the first work is kinetic energy; half a step between the two makes a little more of it.
  for (const double step : {0.3, 0.95}) {
    EXPECT_LT(run_engine(step, 0, {}, {}, 300).largest_ratio, 1.1) << step;
    EXPECT_LT(run_engine(step, 5e-4, {}, {}, 300).largest_ratio, 1.1) << step;
    EXPECT_LT(run_engine(step, 0, {0.05, 0.08}, {30, 300}, 300).largest_ratio, 1.1) << step;
  }
}

TEST(EnergyGuard, ObjectsLongBeforeANumberOverflows) {
  const Course course = run_engine(1.02, 0, {}, {}, 3000);
  EXPECT_GT(course.energy_at_objection, 10);
  EXPECT_LT(course.energy_at_objection, 1e3);  // single precision overflows beyond 1e38
}

}  // namespace
}  // namespace easydyn::soil
