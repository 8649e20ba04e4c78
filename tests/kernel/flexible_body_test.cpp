#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "easydyn/easydyn.hpp"

using namespace easydyn;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

// Steel, 2 m long, 20 x 40 mm.
constexpr double E = 2.1e11, G = 8.1e10, density = 7850, b = 0.02, h = 0.04, L = 2;
constexpr double A = b * h, EIy = E * b * h * h * h / 12, EIz = E * h * b * b * b / 12, m_l = density * A;

BeamData steel(int elements) {
  return BeamData::rectangle(L, elements, E, G, density, b, h);
}

class Cantilever : public System {
 public:
  FlexibleBody& beam;
  double field = 0;
  explicit Cantilever(int elements, int modes = -1, double damping = 0)
      : beam(flexible_body("beam", beam_model(steel(elements)), {.clamped_nodes = {0}, .modes = modes},
                           damping)) {}

 protected:
  void positions() override { beam = Frame(); }
  void forces() override { gravity(field); }
};

std::vector<double> frequencies(System& system) {
  std::vector<double> f;
  for (const Mode& m : compute_modes(linearize(system, system.initial_state()))) f.push_back(m.frequency);
  return f;
}

// Nearest of the frequencies, relative difference.
double miss(const std::vector<double>& f, double expected) {
  double best = 1e9;
  for (double x : f) best = std::min(best, std::abs(x / expected - 1));
  return best;
}

TEST(FlexibleBody, OfABeamHasTheFrequenciesOfEulerAndBernoulli) {
  Cantilever system(8);
  const std::vector<double> f = frequencies(system);
  // (beta L)^2 sqrt(EI / m L^4) / 2 pi of a cantilever; axial and torsional: quarter waves
  for (double beta_L : {1.875104068711961, 4.694091132974174, 7.854757438237613}) {
    for (double EI : {EIy, EIz}) {
      const double expected = beta_L * beta_L * std::sqrt(EI / (m_l * std::pow(L, 4))) / (2 * M_PI);
      // Rotary inertia, which the closed form leaves out, lowers by about (beta r)^2 / 2 < 2e-3; mesh 2e-5
      EXPECT_LT(miss(f, expected), 2.5e-3) << expected;
    }
  }
  EXPECT_LT(miss(f, std::sqrt(E / density) / (4 * L)), 2e-3);  // linear elements: (pi / 4n)^2 / 6
  const double J = A * (b * b + h * h) / 12 * density;         // per length
  const double ratio = b / h,
               GJ = G * h * b * b * b * (1.0 / 3 - 0.21 * ratio * (1 - std::pow(ratio, 4) / 12));
  EXPECT_LT(miss(f, std::sqrt(GJ / J) / (4 * L)), 2e-3);
}

TEST(FlexibleBody, OfABeamConvergesAtFourthOrder) {
  // Against a fine mesh of the same model.
  const auto first = [](int elements) {
    Cantilever system(elements);
    return frequencies(system)[2];  // the second bending mode in the soft direction
  };
  const double fine = first(32), e1 = first(4) - fine, e2 = first(8) - fine;
  EXPECT_GT(e1, 0);
  EXPECT_NEAR(std::log2(e1 / e2), 4, 0.3);
}

TEST(FlexibleBody, SagsUnderItsWeightAsTheClosedFormSays) {
  Cantilever system(4);
  system.field = 9.81;
  const State s = solve_static_equilibrium(system);
  system.evaluate(s);
  // w = q L^4 / 8 EI; consistent loads: exact at the nodes
  const VectorXd d = system.beam.displacements();
  EXPECT_NEAR(d[4 * 6 + 2], -m_l * 9.81 * std::pow(L, 4) / (8 * EIy), 1e-8);
  EXPECT_NEAR(d[4 * 6 + 4], m_l * 9.81 * std::pow(L, 3) / (6 * EIy), 1e-8);  // turns about +y: tip down
}

TEST(FlexibleBody, TakesForcesAtItsNodes) {
  class Loaded : public Cantilever {
   public:
    Loaded() : Cantilever(3) {}
    Frame tip;

   protected:
    void positions() override {
      beam = Frame();
      tip = beam.node(3);
    }
    void forces() override { tip.add_force({0, 100, 0}, tip.origin()); }
  } system;
  const State s = solve_static_equilibrium(system);
  system.evaluate(s);
  EXPECT_NEAR(system.beam.displacements()[3 * 6 + 1], 100 * std::pow(L, 3) / (3 * EIz), 1e-6);
  EXPECT_NEAR(system.tip.origin().y(), 100 * std::pow(L, 3) / (3 * EIz), 1e-6);
  EXPECT_THROW(system.beam.node(4), ModelError);
}

TEST(FlexibleBody, FreeInSpaceHasTheModesOfAFreeBeam) {
  class Free : public System {
   public:
    FreeMotion motion = free_motion("F");
    FlexibleBody& beam = flexible_body("beam", beam_model(steel(8)), {.clamped_nodes = {3}});

   protected:
    void positions() override { beam = motion.frame(); }
  } system;
  // Shapes clamped somewhere at a node and the motion of the frame together are all motions of a free beam.
  const std::vector<double> f = frequencies(system);
  for (int i = 0; i < 6; ++i) EXPECT_LT(f[static_cast<std::size_t>(i)], 0.1);  // rigid
  for (double beta_L : {4.730040744862704, 7.853204624095838})
    for (double EI : {EIy, EIz}) {
      const double expected = beta_L * beta_L * std::sqrt(EI / (m_l * std::pow(L, 4))) / (2 * M_PI);
      EXPECT_LT(miss(f, expected), 4e-3) << expected;  // rotary inertia
    }
}

TEST(FlexibleBody, WithoutShapesIsARigidBody) {
  const FlexibleModel model = beam_model(steel(2));
  class Pair : public System {
   public:
    FreeMotion motion = free_motion("F");
    Body* rigid = nullptr;
    FlexibleBody* flexible = nullptr;

   protected:
    void positions() override {
      if (rigid) *rigid = motion.frame() * translate(L / 2, 0, 0);
      if (flexible) *flexible = motion.frame();
    }
    void forces() override { gravity(); }
  };
  Pair rigid, flexible;
  const double mass = m_l * L;
  rigid.rigid = &rigid.body("box", Inertia::box(mass, L, b, h));
  flexible.flexible = &flexible.flexible_body("beam", model, {.clamped_nodes = {0}, .modes = 0});
  EXPECT_NEAR(flexible.flexible->mass(), mass, 1e-12 * mass);
  for (int trial = 0; trial < 5; ++trial) {
    State s = rigid.initial_state();
    s.q = VectorXd::Random(6);
    s.qd = 3 * VectorXd::Random(6);
    s.qdd = 10 * VectorXd::Random(6);
    const VectorXd expected = rigid.compute_residual(s);
    EXPECT_LT((flexible.compute_residual(s) - expected).norm(), 1e-12 * expected.norm());
    EXPECT_LT((flexible.compute_mass_matrix(s) - rigid.compute_mass_matrix(s)).norm(), 1e-12 * mass * L * L);
    EXPECT_NEAR(flexible.compute_energy(s).kinetic, rigid.compute_energy(s).kinetic, 1e-11 * mass);
    EXPECT_NEAR(flexible.compute_energy(s).potential, rigid.compute_energy(s).potential, 1e-11 * mass);
  }
}

// A soft beam, swung about so that every term matters.
class SoftArm : public System {
 public:
  Coordinate a = coordinate("a", 0.4, 2.0), c = coordinate("c", -0.3, 1.5);
  FlexibleBody& arm;
  Body& load = body("load", Inertia(1.5, 0.02, 0.03, 0.04));
  explicit SoftArm(const FlexibleModel& model, double damping = 0)
      : arm(flexible_body("arm", model, {.clamped_nodes = {0}, .modes = 5}, damping)) {}

 protected:
  void positions() override {
    arm = rotate_z(a) * rotate_y(c) * translate(0.1, 0, 0.2);
    load = arm.node(4) * translate(0, 0, 0.1);
  }
  void forces() override { gravity(); }
};

FlexibleModel soft_model() {
  return beam_model(BeamData::rectangle(1, 4, 2e8, 8e7, 1000, 0.03, 0.05));
}

TEST(FlexibleBody, ObeysLagrangesEquationsOfItsEnergies) {
  SoftArm system(soft_model());
  State s = system.initial_state();
  for (int trial = 0; trial < 3; ++trial) {
    s.q = 0.3 * VectorXd::Random(system.size());
    s.qd = 2 * VectorXd::Random(system.size());
    s.qdd = 5 * VectorXd::Random(system.size());
    const auto T = [&](const VectorXd& q, const VectorXd& qd) {
      State x = s;
      x.q = q;
      x.qd = qd;
      return system.compute_energy(x).kinetic;
    };
    const auto V = [&](const VectorXd& q) {
      State x = s;
      x.q = q;
      return system.compute_energy(x).potential;
    };
    const auto difference = [](auto f) {  // fourth order, step 1e-3
      return (f(-2e-3) - 8 * f(-1e-3) + 8 * f(1e-3) - f(2e-3)) / 12e-3;
    };
    const VectorXd r = system.compute_residual(s);
    for (int i = 0; i < system.size(); ++i) {
      const VectorXd e = VectorXd::Unit(system.size(), i);
      // dT/dqd_i is linear in qd: its difference is exact. d/dt along the motion.
      const double momentum_rate = difference([&](double d) {
        const VectorXd q = s.q + d * s.qd, qd = s.qd + d * s.qdd;
        return (T(q, qd + e) - T(q, qd - e)) / 2;
      });
      const double force = difference([&](double d) { return T(s.q + d * e, s.qd); }) -
                           difference([&](double d) { return V(s.q + d * e); });
      // truncation h^4 / 30 of fifth derivatives: 1e-13 x 1e3; rounding of energies up to 1e4 J: 1e-12 / h
      EXPECT_NEAR(r[i], momentum_rate - force, 1e-7 * (1 + r.norm())) << system.coordinate_name(i);
    }
  }
}

TEST(FlexibleBody, HasTheMassMatrixOfItsResidual) {
  SoftArm system(soft_model());
  State s = system.initial_state();
  s.q = 0.2 * VectorXd::Random(system.size());
  s.qd = VectorXd::Random(system.size());
  const MatrixXd M = system.compute_mass_matrix(s);
  const VectorXd bias = system.compute_bias(s);
  for (int i = 0; i < system.size(); ++i) {
    s.qdd = VectorXd::Unit(system.size(), i);
    EXPECT_LT((system.compute_residual(s) - bias - M.col(i)).norm(), 1e-12 * (M.norm() + bias.norm()));
  }
}

TEST(FlexibleBody, KeepsItsEnergyInLargeMotion) {
  SoftArm system(soft_model());
  RungeKutta integrator(system, {.relative_tolerance = 1e-9, .absolute_tolerance = 1e-11});
  const EnergyBalance start = system.compute_energy(integrator.state());
  integrator.advance(1);
  const EnergyBalance end = system.compute_energy(integrator.state());
  EXPECT_NEAR(end.kinetic + end.potential, start.kinetic + start.potential, 1e-6 * start.kinetic);
  EXPECT_GT(integrator.state().q.tail(system.size() - 2).norm(), 1e-3);  // it bends
}

TEST(FlexibleBody, DampsItsModesAsGiven) {
  Cantilever system(4, 5, 0.03);
  for (const Mode& m : compute_modes(linearize(system, system.initial_state())))
    EXPECT_NEAR(m.damping, 0.03, 1e-6) << m.frequency;
}

TEST(FlexibleBody, AccountsForThePowerOfAShapeMovedByHand) {
  SoftArm system(soft_model(), 0.02);
  Coordinate eta = system.arm.coordinate(0);
  eta.prescribe([](double t) {
    return ImposedMotion{0.05 * std::sin(3 * t), 0.15 * std::cos(3 * t), -0.45 * std::sin(3 * t)};
  });
  const auto imbalance = [&](double step) {
    Newmark integrator(system, {.step = step});
    EnergyBalance before = system.compute_energy(integrator.state());
    const double E0 = before.kinetic + before.potential;
    double work = 0, worst = 0;
    integrator.advance(0.5, [&](const State& s) {
      const EnergyBalance now = system.compute_energy(s);
      work += 0.5 * step * (before.supplied - before.dissipated + now.supplied - now.dissipated);
      worst = std::max(worst, std::abs(now.kinetic + now.potential - E0 - work));
      before = now;
    });
    return worst;
  };
  const double coarse = imbalance(1e-3), fine = imbalance(5e-4);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.2);
}

TEST(FlexibleModel, IsImportedWithItsMatrices) {
  // The beam's own consistent matrices, six rows per node, as if they came from elsewhere.
  const FlexibleModel own = beam_model(steel(6));
  const SparseMatrix M = SparseMatrix(own.N.transpose()) * own.M * own.N;
  const FlexibleModel from_outside = FlexibleModel::imported(own.nodes, M, own.K);
  class Model : public System {
   public:
    explicit Model(const FlexibleModel& m)
        : beam(flexible_body("beam", m, {.clamped_nodes = {0}, .modes = 6})) {}
    Coordinate a = coordinate("a", 0, 1);
    FlexibleBody& beam;

   protected:
    void positions() override { beam = rotate_z(a); }
  } expected(own), imported(from_outside);
  EXPECT_NEAR(imported.beam.mass(), expected.beam.mass(), 1e-10);
  State s = expected.initial_state();
  EXPECT_NEAR(imported.compute_energy(s).kinetic, expected.compute_energy(s).kinetic, 1e-10);
  expected.a.lock(0);  // turning, they differ by products of small rotations
  imported.a.lock(0);
  const std::vector<double> f = frequencies(expected), g = frequencies(imported);
  for (std::size_t i = 0; i < f.size(); ++i) EXPECT_NEAR(g[i], f[i], 1e-7 * f[i]);
}

TEST(FlexibleModel, IsImportedWithThreeRowsPerNode) {
  // Four masses on the corners of a square joined by springs along all sides and diagonals, and a fifth above: a truss.
  Eigen::Matrix3Xd nodes(3, 5);
  nodes << 0, 1, 1, 0, 0.5, 0, 0, 1, 1, 0.5, 0, 0, 0, 0, 0.7;
  MatrixXd K = MatrixXd::Zero(15, 15);
  for (int i = 0; i < 5; ++i)
    for (int j = i + 1; j < 5; ++j) {
      const Vector3d e = (nodes.col(j) - nodes.col(i)).normalized();
      const Eigen::Matrix3d k = 1000 * e * e.transpose();
      K.block<3, 3>(3 * i, 3 * i) += k;
      K.block<3, 3>(3 * j, 3 * j) += k;
      K.block<3, 3>(3 * i, 3 * j) -= k;
      K.block<3, 3>(3 * j, 3 * i) -= k;
    }
  const MatrixXd M = 0.4 * MatrixXd::Identity(15, 15);
  const FlexibleModel model = FlexibleModel::imported(nodes, M.sparseView(), K.sparseView());
  class Truss : public System {
   public:
    explicit Truss(const FlexibleModel& m)
        : truss(flexible_body("truss", m, {.clamped_dofs = {0, 1, 2, 4, 5, 8}})) {}
    FreeMotion motion = free_motion("F");
    FlexibleBody& truss;

   protected:
    void positions() override { truss = motion.frame(); }
  } system(model);
  // The same five masses free in space, each with three coordinates: all fifteen frequencies.
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> eigen(K, M);
  const std::vector<double> f = frequencies(system);
  ASSERT_EQ(f.size(), 15u);
  for (std::size_t i = 6; i < 15; ++i)
    EXPECT_NEAR(f[i], std::sqrt(eigen.eigenvalues()[static_cast<Eigen::Index>(i)]) / (2 * M_PI), 1e-6);
}

TEST(FlexibleModel, RefusesWhatIsNoFreeBody) {
  const FlexibleModel model = beam_model(steel(2));
  const auto refusal = [](const FlexibleModel& m) {
    try {
      m.check("flexible body \"b\"");
    } catch (const ModelError& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal(model), "accepted");
  FlexibleModel wrong = model;
  wrong.K.coeffRef(0, 0) *= 2;
  EXPECT_NE(refusal(wrong).find("K resists rigid motion"), std::string::npos) << refusal(wrong);
  wrong = model;
  wrong.M.coeffRef(0, 0) *= 2;
  EXPECT_NE(refusal(wrong).find("along x, y, z"), std::string::npos) << refusal(wrong);
  wrong = model;
  wrong.K.coeffRef(0, 6) *= 2;
  EXPECT_NE(refusal(wrong).find("K is not symmetric"), std::string::npos);
  wrong = model;
  wrong.nodes.conservativeResize(3, 2);
  EXPECT_NE(refusal(wrong).find("K is 18 x 18"), std::string::npos);
  EXPECT_THROW(beam_model({}), ModelError);
  EXPECT_THROW(compute_shapes(model, {.clamped_nodes = {3}}), ModelError);
  EXPECT_THROW(compute_shapes(model, {.clamped_dofs = {0, 1, 2}}), ModelError);  // turns freely
  EXPECT_THROW(compute_shapes(model, {.clamped_nodes = {0}, .modes = 99}), ModelError);
  EXPECT_THROW(compute_shapes(model, {.clamped_nodes = {0}, .interface_dofs = {1}}), ModelError);
}

TEST(FlexibleBody, RefusesShapesThatMoveItAsARigidBody) {
  class Loose : public System {
   public:
    Loose() {
      std::vector<int> both_ends;
      for (int i = 0; i < 6; ++i) both_ends.insert(both_ends.end(), {i, 12 + i});
      flexible_body("beam", beam_model(steel(2)), {.interface_dofs = both_ends, .modes = 0});
    }

   protected:
    void positions() override {}
  };
  EXPECT_THROW(Loose(), ModelError);
}

TEST(FlexibleModel, HasStaticShapesAtItsInterface) {
  const FlexibleModel model = beam_model(steel(4));
  const int tip_w = 4 * 6 + 2;
  const MatrixXd shapes =
      compute_shapes(model, {.clamped_nodes = {0}, .interface_dofs = {tip_w}, .modes = 0});
  ASSERT_EQ(shapes.cols(), 1);
  // w(x) = x^2 (3 L - x) / 2 L^3 of a cantilever with a force at its tip
  for (int i = 1; i <= 4; ++i) {
    const double x = 0.25 * i;
    EXPECT_NEAR(shapes(6 * i + 2, 0), x * x * (3 - x) / 2, 1e-9);
  }
}

}  // namespace
