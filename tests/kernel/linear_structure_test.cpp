#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "easydyn/easydyn.hpp"
#include "easydyn/sim/banded_cholesky.hpp"

using namespace easydyn;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr int n = 12;
constexpr double chain_mass = 3, chain_k = 4e4, ground_k = 8e3, chain_d = 60;  // [kg, N/m, N s/m]

struct ChainMatrices {
  SparseMatrix M{n, n}, C{n, n}, K{n, n};
  ChainMatrices() {
    for (int i = 0; i < n; ++i) {
      M.insert(i, i) = chain_mass;
      const double neighbours = (i > 0) + (i < n - 1);
      K.insert(i, i) = ground_k + neighbours * chain_k;
      C.insert(i, i) = neighbours * chain_d;
      for (int j : {i - 1, i + 1})
        if (j >= 0 && j < n) {
          K.insert(i, j) = -chain_k;
          C.insert(i, j) = -chain_d;
        }
    }
  }
};

double contact_force(double indentation) {
  return indentation > 0 ? 2e6 * std::pow(indentation, 1.5) : 0;
}

// Two weights that travel along the chain on nonlinear contacts; positions between masses by linear shapes.
double place_of(int weight, double t) {
  return 3.2 + 2.5 * weight + 6 * t;
}

// The chain as a linear structure with ports.
class WithStructure : public System {
 public:
  Coordinate z0 = coordinate("z0", 0.004), z1 = coordinate("z1", 0.004);
  Body& w0 = body("weight 0", 20.0);
  Body& w1 = body("weight 1", 30.0);
  LinearStructure& chain;
  WithStructure() : chain(make_chain()) {}
  void positions() override {
    w0 = translate(0, 0, -z0);
    w1 = translate(0, 0, -z1);
  }
  void forces() override {
    gravity();
    press(0, w0, z0.value());
    press(1, w1, z1.value());
  }

 private:
  LinearStructure& make_chain() {
    ChainMatrices c;
    return structure("chain", c.M, c.C, c.K);
  }
  void press(int weight, Body& b, double z) {
    const double x = place_of(weight, time().value());
    const int i = static_cast<int>(x);
    PortShape shape;
    shape.add(i, 1 - (x - i), -1);
    shape.add(i + 1, x - i, 1);
    Port port = touch(chain, shape);
    const double F = contact_force(z - port.displacement());
    port.add_force(F);
    b.add_force({0, 0, F}, b.position());
  }
};

// The same system, every mass a body with a coordinate of its own.
class WithBodies : public System {
 public:
  Coordinate z0 = coordinate("z0", 0.004), z1 = coordinate("z1", 0.004);
  std::vector<Coordinate> u;
  Body& w0 = body("weight 0", 20.0);
  Body& w1 = body("weight 1", 30.0);
  std::vector<Body*> masses;
  WithBodies() {
    for (int i = 0; i < n; ++i) {
      u.push_back(coordinate(fmt::format("u{}", i)));
      masses.push_back(&body(fmt::format("mass {}", i), chain_mass));
    }
  }
  void positions() override {
    w0 = translate(0, 0, -z0);
    w1 = translate(0, 0, -z1);
    for (int i = 0; i < n; ++i) *masses[i] = translate(0, 0, -u[i]);
  }
  void forces() override {
    for (Body* b : {&w0, &w1}) b->add_force({0, 0, -9.81 * b->mass()}, b->position());
    for (int i = 0; i < n; ++i) {
      push(i, -ground_k * u[i].value());
      if (i + 1 < n) {
        const double F =
            chain_k * (u[i + 1].value() - u[i].value()) + chain_d * (u[i + 1].rate() - u[i].rate());
        push(i, F);
        push(i + 1, -F);
      }
    }
    press(0, w0, z0.value());
    press(1, w1, z1.value());
  }

 private:
  void push(int i, double F) { masses[i]->add_force({0, 0, -F}, masses[i]->position()); }  // u is downward
  void press(int weight, Body& b, double z) {
    const double x = place_of(weight, time().value());
    const int i = static_cast<int>(x);
    const double s = x - i;
    const double F = contact_force(z - (1 - s) * u[i].value() - s * u[i + 1].value());
    push(i, (1 - s) * F);
    push(i + 1, s * F);
    b.add_force({0, 0, F}, b.position());
  }
};

TEST(LinearStructure, MovesAsTheSameMassesWrittenAsBodies) {
  WithStructure condensed;
  WithBodies full;
  const StepperOptions options{.step = 5e-4};
  Newmark a(condensed, solve_static_equilibrium(condensed), options);
  Newmark b(full, solve_static_equilibrium(full), options);
  EXPECT_LT((a.state().q - b.state().q).norm(), 1e-12);
  double largest = 0;
  for (int i = 0; i < 600; ++i) {
    a.step();
    b.step();
    largest = std::max(largest, (a.state().q - b.state().q).lpNorm<Eigen::Infinity>());
    EXPECT_LT((a.state().qdd - b.state().qdd).lpNorm<Eigen::Infinity>(), 1e-6);
  }
  EXPECT_LT(largest, 1e-11);  // of displacements of some millimetres
  EXPECT_GT(a.state().q.maxCoeff(), 1e-3);
  EXPECT_EQ(a.statistics().factorisations, 1);
}

TEST(LinearStructure, SatisfiesTheFullEquationsAfterACondensedStep) {
  WithStructure system;
  Newmark integrator(system, solve_static_equilibrium(system), {.step = 5e-4});
  for (int i = 0; i < 50; ++i) integrator.step();
  EXPECT_LT(system.compute_residual(integrator.state()).lpNorm<Eigen::Infinity>(), 1e-7);  // of 500 N
}

TEST(LinearStructure, StartsInQuasiStaticMotionWithTheRatesOfItsDeflectionInBalance) {
  WithStructure system;
  const State guess = solve_static_equilibrium(system);
  const State start = solve_quasi_static_motion(system, guess, 1e-3);
  EXPECT_LT(system.compute_residual(start).lpNorm<Eigen::Infinity>(), 1e-7);
  // The rates are those at which the static deflection changes as the weights move on.
  const double d = 1e-4;
  State before = guess, after = guess;
  before.t = -d;
  after.t = d;
  const VectorXd rates =
      (solve_static_equilibrium(system, after).q - solve_static_equilibrium(system, before).q) / (2 * d);
  EXPECT_LT((start.qd - rates).tail(n).norm(), 1e-6 * rates.tail(n).norm());
  EXPECT_EQ(start.qd.head(2).norm(), 0);
}

// A weight free to move along the chain, held by a spring: where it touches depends on a coordinate.
class FreeToMove : public System {
 public:
  Coordinate x = coordinate("x", 3.4), z = coordinate("z", 0.02);
  Body& weight = body("weight", 20.0);
  LinearStructure& chain;
  FreeToMove() : chain(make_chain()) {}
  void positions() override { weight = translate(x, 0, -z); }
  void forces() override {
    gravity();
    weight.add_force({-900 * (x.value() - 4.1) - 30 * x.rate(), 0, 0}, weight.position());
    const int i = static_cast<int>(x.value());
    const double s = x.value() - i;
    PortShape shape;
    shape.add(i, 1 - s, -1);
    shape.add(i + 1, s, 1);
    Port port = touch(chain, shape);
    const double F = contact_force(z.value() - port.displacement());
    port.add_force(F);
    // The contact is normal to the chain, which slopes.
    weight.add_force({F * port.slope(), 0, F}, weight.position());
  }

 private:
  LinearStructure& make_chain() {
    ChainMatrices c;
    return structure("chain", c.M, c.C, c.K);
  }
};

TEST(LinearStructure, IsInEquilibriumWhereTheLoadHasMovedTo) {
  FreeToMove system;
  const State s = solve_static_equilibrium(system);
  EXPECT_GT(std::abs(s.q[0] - 3.4), 0.3);  // it moved to the next mass
  EXPECT_LT(system.compute_residual(s).lpNorm<Eigen::Infinity>(), 1e-8 * 20 * 9.81);
}

TEST(LinearStructure, SatisfiesTheFullEquationsUnderALoadThatMovesFreely) {
  FreeToMove system;
  State start = solve_static_equilibrium(system);
  start.qd[0] = 2;
  Newmark integrator(system, start, {.step = 5e-4});
  for (int i = 0; i < 200; ++i) {
    integrator.step();
    EXPECT_LT(system.compute_residual(integrator.state()).lpNorm<Eigen::Infinity>(), 1e-6);  // of 196 N
  }
}

TEST(LinearStructure, CanBeTouchedInsideForcesOnlyAndWhereItIs) {
  WithStructure system;
  PortShape shape;
  shape.add(0, 1);
  EXPECT_THROW(system.touch(system.chain, shape), ModelError);
  class Outside : public WithStructure {
   public:
    void forces() override {
      PortShape beyond;
      beyond.add(n, 1);
      touch(chain, beyond);
    }
  } outside;
  EXPECT_THROW(outside.evaluate(outside.initial_state()), ModelError);
}

TEST(LinearStructure, AddsItsEnergyToTheBalance) {
  WithStructure a;
  WithBodies b;
  State s = a.initial_state();
  s.q.setRandom();
  s.q *= 1e-2;
  s.qd.setRandom();
  const EnergyBalance ea = a.compute_energy(s), eb = b.compute_energy(s);
  EXPECT_NEAR(ea.kinetic, eb.kinetic, 1e-12 * eb.kinetic);
  EXPECT_NEAR(ea.dissipated, s.qd.tail(n).dot(MatrixXd(ChainMatrices().C) * s.qd.tail(n)), 1e-9);
}

TEST(LinearStructure, RefusesMatricesThatCannotBe) {
  class Open : public System {
   public:
    using System::structure;
    void positions() override {}
  } system;
  ChainMatrices c;
  SparseMatrix skew = c.K;
  skew.coeffRef(0, 1) = 7;
  EXPECT_THROW(system.structure("track", c.M, c.C, skew), ModelError);
  SparseMatrix poisoned = c.K;
  poisoned.coeffRef(2, 2) = std::nan("");
  EXPECT_THROW(system.structure("track", c.M, c.C, poisoned), ModelError);
  EXPECT_THROW(system.structure("track", c.M, SparseMatrix(3, 3), c.K), ModelError);
}

TEST(BandedCholesky, SolvesSeveralRightHandSidesAtOnce) {
  ChainMatrices c;
  const BandedCholesky factor(c.K, 1, "chain");
  for (int columns : {1, 3, 4, 7, 8, 13}) {
    const RightHandSides B = RightHandSides::Random(n, columns);
    RightHandSides X = B;
    factor.solve_in_place(X);
    EXPECT_LT((MatrixXd(c.K) * X - B).norm(), 1e-12 * B.norm());
  }
}

TEST(BandedCholesky, SolvesForEveryBandwidthAndGivesPartsOfTheInverse) {
  constexpr int size = 53;
  for (int b = 0; b <= 17; ++b) {
    MatrixXd A = MatrixXd::Zero(size, size);
    for (int i = 0; i < size; ++i)
      for (int k = 0; k <= b && i + k < size; ++k)
        A(i, i + k) = A(i + k, i) = k == 0 ? 4 : std::cos(3.0 * i + k) / k;
    A.diagonal().array() += 2 * std::log(1.0 + b);  // dominant
    const BandedCholesky factor(SparseMatrix(A.sparseView()), b, "band");
    const Eigen::VectorXd rhs = Eigen::VectorXd::Random(size);
    Eigen::VectorXd x = rhs;
    factor.solve_in_place(x.data());
    EXPECT_LT((A * x - rhs).norm(), 1e-13 * rhs.norm()) << "b = " << b;
    const MatrixXd inverse = A.inverse();
    for (int j : {0, 7, 30, 52}) {
      std::vector<double> part(static_cast<std::size_t>(size));
      const int first = std::max(0, j - 9);
      factor.solve_unit_in_part(j, first, size - 1, part.data());  // nothing is left out beyond the last row
      for (int i = first; i < size; ++i)
        EXPECT_NEAR(part[static_cast<std::size_t>(i - first)], inverse(i, j), 1e-13) << "b = " << b;
    }
  }
}

TEST(BandedCholesky, NamesTheStructureThatIsFreeToMove) {
  SparseMatrix K(2, 2);
  K.insert(0, 0) = 5;
  K.insert(0, 1) = -5;
  K.insert(1, 0) = -5;
  K.insert(1, 1) = 5;
  try {
    BandedCholesky(K, 1, "floating");
    FAIL();
  } catch (const SolverError& e) {
    EXPECT_NE(std::string(e.what()).find("\"floating\""), std::string::npos);
  }
}

}  // namespace
