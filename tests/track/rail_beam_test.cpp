#include "track/rail_beam.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include "easydyn/error.hpp"
#include "tests/reference/winkler_beam.hpp"
#include "track/rail_section.hpp"

namespace {

using namespace easydyn::track;

TEST(BeamElement, HasTwoRigidBodyMotionsAndAPositiveMass) {
  const BeamElement element(6.38e6, 60.21, 0.15);
  const Eigen::Matrix4d K = element.compute_stiffness(), M = element.compute_mass();
  EXPECT_EQ(K, K.transpose());
  EXPECT_EQ(M, M.transpose());
  const Eigen::Vector4d heave(1, 0, 1, 0), pitch(0, 1, 0.15, 1);
  EXPECT_NEAR((K * heave).norm() / K.norm(), 0, 1e-15);
  EXPECT_NEAR((K * pitch).norm() / K.norm(), 0, 1e-15);
  EXPECT_NEAR(heave.dot(M * heave), 60.21 * 0.15, 1e-12);                   // mass
  EXPECT_NEAR(pitch.dot(M * pitch), 60.21 * std::pow(0.15, 3) / 3, 1e-12);  // inertia about node 1
  EXPECT_EQ(Eigen::LLT<Eigen::Matrix4d>(M).info(), Eigen::Success);         // positive definite
}

TEST(BeamShape, ReproducesCubicsAndTheirDerivatives) {
  const double l = 0.7;
  const auto w = [](double x) { return 1 + 2 * x - 3 * x * x + 4 * x * x * x; };
  const auto dw = [](double x) { return 2 - 6 * x + 12 * x * x; };
  const Eigen::Vector4d q(w(0), dw(0), w(l), dw(l));
  for (const double xi : {0.0, 0.3, 0.8, 1.0}) {
    const BeamShape s = compute_beam_shape(xi, l);
    const double x = xi * l;
    EXPECT_NEAR(s.N.dot(q), w(x), 1e-14);
    EXPECT_NEAR(s.dN.dot(q), dw(x), 1e-13);
    EXPECT_NEAR(s.ddN.dot(q), -6 + 24 * x, 1e-12);
  }
}

/// First natural frequency of a beam pinned at both ends, n elements.
double pinned_frequency(const BeamProperties& beam, double L, int n) {
  const BeamElement element(beam, L / n);
  const int size = 2 * n + 2;
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(size, size), M = K;
  for (int e = 0; e < n; ++e) {
    K.block<4, 4>(2 * e, 2 * e) += element.compute_stiffness();
    M.block<4, 4>(2 * e, 2 * e) += element.compute_mass();
  }
  // without the two end deflections: unknowns 0 and size - 2
  std::vector<int> free;
  for (int i = 1; i < size; ++i)
    if (i != size - 2) free.push_back(i);
  const Eigen::MatrixXd K_ff = K(free, free), M_ff = M(free, free);
  // inverse iteration; the second mode is 16 times stiffer
  const Eigen::LDLT<Eigen::MatrixXd> solver(K_ff);
  Eigen::VectorXd mode = Eigen::VectorXd::LinSpaced(K_ff.rows(), 1, 2);
  for (int i = 0; i < 20; ++i) mode = solver.solve(M_ff * mode).normalized();
  return std::sqrt(mode.dot(K_ff * mode) / mode.dot(M_ff * mode)) / (2 * std::acos(-1.0));
}

TEST(BeamElement, FindsThePinnedPinnedFrequencyOf1420Hz) {
  const RailSection& rail = rail_section("60E1");
  const double exact =
      easydyn::reference::pinned_pinned_frequency(rail.bending_stiffness(), rail.mass_per_length, 0.6);
  EXPECT_NEAR(exact, 1420, 2);  // quoted to three digits
  // error of the first mode with n cubic elements: (pi / n)^4 / 1440
  EXPECT_NEAR(pinned_frequency({rail.bending_stiffness(), rail.mass_per_length}, 0.6, 4) / exact, 1, 3e-4);
  EXPECT_NEAR(pinned_frequency({rail.bending_stiffness(), rail.mass_per_length}, 0.6, 16) / exact, 1, 2e-6);
}

BeamProperties timoshenko_rail() {
  const RailSection& rail = rail_section("60E1");
  return {rail.bending_stiffness(), rail.mass_per_length, rail.shear_stiffness(), rail.rotary_inertia()};
}

TEST(TimoshenkoElement, CarriesACantileverExactlyAtAnyLengthAndShearStiffness) {
  const double F = 1000, L = 1.2;
  for (const double shear :
       {1e5, 2.24e8, 1e14})  // very soft, a rail, practically Euler and Bernoulli: no locking
    for (const int n : {1, 3}) {
      const BeamProperties beam{6.38e6, 60, shear, 0.2};
      const BeamElement element(beam, L / n);
      Eigen::MatrixXd K = Eigen::MatrixXd::Zero(2 * n + 2, 2 * n + 2);
      for (int e = 0; e < n; ++e) K.block<4, 4>(2 * e, 2 * e) += element.compute_stiffness();
      const Eigen::MatrixXd clamped = K.bottomRightCorner(2 * n, 2 * n);
      const Eigen::VectorXd q = clamped.ldlt().solve(F * Eigen::VectorXd::Unit(2 * n, 2 * n - 2));
      // F L^3 / 3 E I + F L / kappa G A; rotation F L^2 / 2 E I
      EXPECT_NEAR(q[2 * n - 2] / (F * L * L * L / (3 * 6.38e6) + F * L / shear), 1, 1e-10);
      EXPECT_NEAR(q[2 * n - 1] / (F * L * L / (2 * 6.38e6)), 1, 1e-10);
    }
}

TEST(TimoshenkoElement, ShapesCarryTheRotationAndTheConstantShear) {
  const BeamElement element(timoshenko_rail(), 0.3);
  const double Phi = 12 * 6.3798e6 / (0.38 * 77e9 * 7.67e-3 * 0.09);
  for (const double xi : {0.0, 0.3, 1.0}) {
    const BeamShape s = element.shape(xi);
    const Eigen::RowVector4d shear = s.dN - element.rotation_shape(xi);
    // kappa G A (w' - phi) = Q = (12 (w_1 - w_2) + 6 l (phi_1 + phi_2)) E I / l^3 (1 + Phi) with its sign, constant
    const Eigen::RowVector4d expected = -Phi / (1 + Phi) * Eigen::RowVector4d(1 / 0.3, 0.5, -1 / 0.3, 0.5);
    EXPECT_LT((shear - expected).norm(), 1e-12);
    EXPECT_NEAR((s.dN * Eigen::Vector4d(0, 1, 0.3, 1))[0], 1, 1e-13);  // rigid rotation
    EXPECT_NEAR(s.N * Eigen::Vector4d(1, 0, 1, 0), 1, 1e-14);
  }
  const Eigen::Matrix4d M = element.compute_mass();
  const Eigen::Vector4d pitch(0, 1, 0.3, 1);
  EXPECT_NEAR(pitch.dot(M * pitch), 60.21 * std::pow(0.3, 3) / 3 + timoshenko_rail().rotary_inertia * 0.3,
              1e-12);
}

TEST(TimoshenkoElement, FindsTheFrequencyOfThePinnedTimoshenkoBeam) {
  // closed form: rhoI rhoA w^4 - (rhoI S k^2 + rhoA (EI k^2 + S)) w^2 + EI S k^4 = 0, k = pi / L, S = kappa G A
  const BeamProperties beam = timoshenko_rail();
  const double k = std::acos(-1.0) / 0.6, S = beam.shear_stiffness, EI = beam.bending_stiffness;
  const double a = beam.rotary_inertia * beam.mass_per_length,
               b = beam.rotary_inertia * S * k * k + beam.mass_per_length * (EI * k * k + S),
               c = EI * S * std::pow(k, 4);
  const double exact = std::sqrt((b - std::sqrt(b * b - 4 * a * c)) / (2 * a)) / (2 * std::acos(-1.0));
  EXPECT_LT(exact, 0.85 * 1420);  // shear and rotary inertia matter: 1420 Hz by Euler and Bernoulli
  std::vector<double> error;
  for (const int n : {4, 8, 16}) error.push_back(pinned_frequency(beam, 0.6, n) / exact - 1);
  // second order: the shear force is constant in an element, as the strain of a linear rod, whose frequencies err by
  // (k l)^2 / 24; here times the part of the shear, 0.41
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.05);  // measured 2.006
  EXPECT_NEAR(std::log2(error[1] / error[2]), 2, 0.05);  // measured 2.002
  EXPECT_NEAR(error[0], 0.0106, 0.0002);                 // measured; the default of four elements per bay
}

TEST(BeamElement, RefusesImpossibleValues) {
  using testing::HasSubstr;
  using testing::ThrowsMessage;
  EXPECT_THAT([] { BeamElement(-6.4e6, 60, 0.1); },
              ThrowsMessage<easydyn::ModelError>(HasSubstr("EI = -6.4e+06 N m2, must be > 0")));
  EXPECT_THROW(BeamElement(6.4e6, std::nan(""), 0.1), easydyn::ModelError);
  EXPECT_THROW(BeamElement(6.4e6, 60, 0), easydyn::ModelError);
}

TEST(RailSection, IsFoundByNameAndNamesTheNearestOtherwise) {
  using testing::HasSubstr;
  using testing::ThrowsMessage;
  EXPECT_NEAR(rail_section("60E1").bending_stiffness(), 6.38e6, 0.001e6);
  EXPECT_EQ(rail_section("UIC60").inertia, rail_section("60E1").inertia);
  EXPECT_THAT([] { rail_section("50E1"); },
              ThrowsMessage<easydyn::ModelError>(HasSubstr("\"50E1\" is unknown, the nearest is")));
  EXPECT_THAT([] { rail_section("CN6O"); },
              ThrowsMessage<easydyn::ModelError>(HasSubstr("nearest is \"CN60\"")));
  // a steel section weighs 7850 kg/m3 within 1 %
  for (const RailSection& rail : rail_sections())
    EXPECT_NEAR(rail.mass_per_length / rail.area / 7850, 1, 0.01) << rail.name;
}

}  // namespace
