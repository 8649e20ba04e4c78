// No memory is asked for during an evaluation after the first one: every call of the allocator is counted, those of
// operator new and of Eigen among them, by standing in for the functions of the C library (glibc).

#include <gtest/gtest.h>

#include <cerrno>
#include <cstdlib>

#include "easydyn/easydyn.hpp"

namespace {
bool is_counting = false;
long allocations = 0;
void count() {
  if (is_counting) ++allocations;
}
}  // namespace

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) {
  count();
  return __libc_malloc(size);
}
void* calloc(std::size_t n, std::size_t size) {
  count();
  return __libc_calloc(n, size);
}
void* realloc(void* block, std::size_t size) {
  count();
  return __libc_realloc(block, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  count();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  count();
  *block = __libc_memalign(alignment, size);
  return *block ? 0 : ENOMEM;
}
}

using namespace easydyn;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

template <class Work>
long allocations_of(const Work& work) {
  allocations = 0;
  is_counting = true;
  work();
  is_counting = false;
  return allocations;
}

TEST(Allocations, AreCounted) {
  // One by operator new, one by Eigen, so that the zeros below say something.
  std::unique_ptr<int> number;
  VectorXd v;
  EXPECT_EQ(allocations_of([&] { number = std::make_unique<int>(1); }), 1);
  EXPECT_EQ(allocations_of([&] { v.resize(100); }), 1);
}

// Twelve links on hinges about alternating axes.
class Chain : public System {
 public:
  Chain() : System("chain") {
    for (int i = 0; i < 12; ++i) {
      q_.push_back(coordinate("q" + std::to_string(i), 0.3 + 0.1 * i, 0.2));
      links_.push_back(&body("link " + std::to_string(i), Inertia::box(1, 0.1, 0.1, 0.5)));
    }
  }
  void positions() override {
    Frame frame;
    for (std::size_t i = 0; i < links_.size(); ++i) {
      frame = frame * (i % 2 ? rotate_x(q_[i]) : rotate_y(q_[i]));
      *links_[i] = frame * translate(0, 0, -0.25);
      frame = frame * translate(0, 0, -0.5);
    }
  }
  void forces() override { gravity(); }

 private:
  std::vector<Coordinate> q_;
  std::vector<Body*> links_;
};

// A closed loop, a rack geared to six coordinates, a coordinate that is held, a velocity constraint, a spring and a
// first-order state.
class Everything : public System {
 public:
  Everything() : System("everything") {
    for (int i = 0; i < 6; ++i) {
      sliders_.push_back(coordinate("slider " + std::to_string(i), 0.1 * i, 0.3));
      masses_.push_back(&body("mass " + std::to_string(i), 1.0 + i));
    }
    lift_.prescribe([](double t) {
      return ImposedMotion{0.1 * std::sin(t), 0.1 * std::cos(t), -0.1 * std::sin(t)};
    });
  }
  void positions() override {
    const double a = 0.3, b = 1, c = 0.8, d = 1.1;
    const auto [coupler, rocker] = four_bar_.solve([&](const auto& p) {
      return std::array{a * cos(crank_) + b * cos(p[0]) - c * cos(p[1]) - d,
                        a * sin(crank_) + b * sin(p[0]) - c * sin(p[1])};
    });
    coupler_ = rotate_y(-crank_) * translate(a, 0, 0) * rotate_y(crank_ - coupler) * translate(b / 2, 0, 0);
    rocker_ = translate(d, 0, 0) * rotate_y(-rocker) * translate(c / 2, 0, 0);

    Expr way = 0;
    for (std::size_t i = 0; i < sliders_.size(); ++i) {
      *masses_[i] = translate(sliders_[i], static_cast<double>(i), 0);
      way += (0.1 + 0.1 * static_cast<double>(i)) * sliders_[i];
    }
    gear_ = translate(way, 0, 1) * rotate_y(2 * way) * rotate_x(way * sin(crank_));
    table_ = translate(0, 3, lift_) * rotate_x(sliders_[0]);
    rolling_ = {{1, sliders_[0]}, {-0.3 * cos(sliders_[1]), sliders_[2]}};
  }
  void forces() override {
    gravity();
    spring_.apply(gear_, {0.1, 0, 0}, *masses_[3], {0, 0.2, 0});
    current_.set_rate(gear_.velocity().x() - 2 * current_.value());
    gear_.add_force({current_.value(), 0, 0}, gear_.position());
  }

 private:
  Coordinate crank_ = coordinate("crank", 0.6, 1.0), lift_ = coordinate("lift");
  Loop<2> four_bar_ = loop<2>("four-bar", {0.68, 1.66});
  FirstOrderState current_ = first_order_state("current", 0.2);
  VelocityConstraint& rolling_ = velocity_constraint("rolling");
  Body& coupler_ = body("coupler", Inertia::box(1, 1, 0.1, 0.1));
  Body& rocker_ = body("rocker", Inertia::box(1, 0.8, 0.1, 0.1));
  Body& gear_ = body("gear", {2, 0.1});
  Body& table_ = body("table", {3, 0.2});
  SpringDamper spring_{"spring", 100, 2, 0.5};
  std::vector<Coordinate> sliders_;
  std::vector<Body*> masses_;
};

// A mass on a spring that stands on a row of eight masses, and moves along it.
class OnStructure : public System {
 public:
  OnStructure() : System("on a structure") {}
  void positions() override { load_ = translate(0, 0, height_); }
  void forces() override {
    gravity();
    PortShape shape;
    const double share = 0.5 + 0.4 * std::sin(height_.value());
    shape.add(3, 1 - share, -1);
    shape.add(4, share, 1);
    Port port = touch(beam_, shape);
    const double force =
        1e4 * (height_.value() + port.displacement()) + 20 * (height_.rate() + port.velocity());
    load_.add_force({0, 0, -force}, load_.position());
    port.add_force(-force);
  }

 private:
  static SparseMatrix tridiagonal(double diagonal, double beside) {
    SparseMatrix A(8, 8);
    for (int i = 0; i < 8; ++i) {
      A.insert(i, i) = diagonal;
      if (i > 0) A.insert(i, i - 1) = A.insert(i - 1, i) = beside;
    }
    A.makeCompressed();
    return A;
  }
  Coordinate height_ = coordinate("height", 0.01, 0.1);
  Body& load_ = body("load", 10);
  LinearStructure& beam_ = structure("beam", tridiagonal(2, 0), tridiagonal(5, -2), tridiagonal(2e4, -9e3));
};

// Nothing may be allocated by evaluations at other states than the first.
void expect_no_allocation(System& system) {
  State s = system.initial_state();
  const int n = system.body_size();
  VectorXd r(system.size()), equations(system.equation_count()), bias(n);
  MatrixXd M(n, n);
  AccelerationSolver solver(system);
  const System::PortMotionFunction still = [](int, const PortShape&) { return PortMotion{}; };
  const auto move_on = [&s] {
    s.t += 0.01;
    s.q += 0.01 * s.qd;
  };

  const auto expect_none = [&](const char* what, const auto& evaluate) {
    evaluate();
    EXPECT_EQ(allocations_of([&] {
                for (int i = 0; i < 5; ++i) {
                  move_on();
                  evaluate();
                }
              }),
              0)
        << system.name() << ": " << what;
  };
  expect_none("residual", [&] { system.compute_residual(s, r); });
  expect_none("residual of the bodies",
              [&] { system.compute_body_residual(System::body_state(s), still, equations.data()); });
  expect_none("mass and bias", [&] { system.compute_mass_and_bias(s, M, bias); });
  expect_none("accelerations", [&] { solver.solve(s); });
  expect_none("projection of velocities", [&] { solver.project_velocities(s); });
}

TEST(Allocations, AreNoneInEvaluationsOfAChain) {
  Chain chain;
  expect_no_allocation(chain);
  const State s = chain.initial_state();
  EXPECT_EQ(allocations_of([&] { chain.compute_mass_matrix(s); }), 1);  // the result
}

TEST(Allocations, AreNoneInEvaluationsWithLoopsGearsConstraintsAndHeldCoordinates) {
  Everything system;
  expect_no_allocation(system);
}

TEST(Allocations, AreNoneInEvaluationsWithAStructure) {
  OnStructure system;
  expect_no_allocation(system);
}

template <class SystemType>
long allocations_of_newmark_steps() {
  SystemType system;
  Newmark newmark(system, {.step = 1e-3});
  newmark.step();
  return allocations_of([&] {
    for (int i = 0; i < 20; ++i) newmark.step();
  });
}

TEST(Allocations, AreNoneInTheStepsOfNewmarkAfterTheFirst) {
  EXPECT_EQ(allocations_of_newmark_steps<Chain>(), 0);
  EXPECT_EQ(allocations_of_newmark_steps<Everything>(), 0);
  EXPECT_EQ(allocations_of_newmark_steps<OnStructure>(), 0);
}

}  // namespace
