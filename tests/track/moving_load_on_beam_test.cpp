// A simply supported beam under a moving force and under a moving sprung mass, through the kernel: the beam is a linear
// structure, the load touches it through a port.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "easydyn/mbs/system.hpp"
#include "easydyn/sim/implicit_stepper.hpp"
#include "track/rail_beam.hpp"

namespace {

using namespace easydyn;
using track::BeamElement;
using track::BeamShape;
const double pi = std::acos(-1.0);

/// Pinned at both ends, n elements; the end deflections are no coordinates.
class PinnedBeam {
 public:
  PinnedBeam(System& system, double EI, double m, double L, int n)
      : system_(&system), n_(n), L_(L), structure_(make(system, BeamElement(EI, m, L / n), n)) {}

  PortShape shape(double x) const {
    const int e = std::clamp(static_cast<int>(x / L_ * n_), 0, n_ - 1);
    const BeamShape s = track::compute_beam_shape(x / L_ * n_ - e, L_ / n_);
    PortShape shape;
    for (int i = 0; i < 4; ++i)
      if (const int dof = coordinate(2 * e + i, n_); dof >= 0) shape.add(dof, s.N[i], s.dN[i]);
    return shape;
  }
  /// A force off the beam does not act.
  Port touch(double x) const { return system_->touch(structure_, shape(std::clamp(x, 0.0, L_))); }
  double midspan(const State& state) const {
    const PortShape s = shape(0.5 * L_);
    double w = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(s.count); ++i)
      w += s.value[i] * state.q[system_->structure_offset(0) + s.index[i]];
    return w;
  }

  /// Amplitude of the first mode sin(pi x / L): what it has in common with the motion, by the mass matrix.
  double first_mode(const State& state) const {
    Eigen::VectorXd mode = Eigen::VectorXd::Zero(2 * n_);
    for (int node = 0; node <= n_; ++node) {
      const double angle = pi * node / n_;
      if (const int w = coordinate(2 * node, n_); w >= 0) mode[w] = std::sin(angle);
      mode[coordinate(2 * node + 1, n_)] = pi / L_ * std::cos(angle);
    }
    const Eigen::VectorXd weight = structure_.M() * mode;
    return weight.dot(state.q.segment(system_->structure_offset(0), 2 * n_)) / weight.dot(mode);
  }

 private:
  static int coordinate(int unknown, int n) {  // of the 2 n + 2 of the free beam
    if (unknown == 0 || unknown == 2 * n) return -1;
    return unknown < 2 * n ? unknown - 1 : 2 * n - 1;
  }
  static LinearStructure& make(System& system, const BeamElement& element, int n) {
    const Eigen::Matrix4d M_e = element.compute_mass(), K_e = element.compute_stiffness();
    SparseMatrix M(2 * n, 2 * n), C(2 * n, 2 * n), K(2 * n, 2 * n);
    for (int e = 0; e < n; ++e)
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
          const int a = coordinate(2 * e + i, n), b = coordinate(2 * e + j, n);
          if (a < 0 || b < 0) continue;
          M.coeffRef(a, b) += M_e(i, j);
          K.coeffRef(a, b) += K_e(i, j);
        }
    return system.structure("beam", M, C, K);
  }
  System* system_;
  int n_;
  double L_;
  LinearStructure& structure_;
};

// ---- a moving force: STEM benchmark "moving_load_on_beam" after Fryba 1972, ch. 1.3 (retyped) ----

constexpr double L = 25, P = 1000, v = 10, EI_force = 210e9 * 1e-4, m_force = 7850 * 0.01;

class MovingForceOnBeam : public System {
 public:
  explicit MovingForceOnBeam(int n) : beam(*this, EI_force, m_force, L, n) {}
  PinnedBeam beam;

 protected:
  void positions() override {}
  void forces() override { beam.touch(v * time().value()).add_force(P); }
};

/// Fryba: w(L/2) = (2 P L^3 / pi^4 EI) sum_n sin(n pi / 2) [sin n W t - (a / n) sin w_n t] / (n^2 (n^2 - a^2)),
/// W = pi v / L, a = v / v_cr, v_cr = (pi / L) sqrt(EI / m), w_n = n^2 (pi / L)^2 sqrt(EI / m).
double fryba_midspan(double t, int modes = 200) {
  const double v_cr = pi / L * std::sqrt(EI_force / m_force), a = v / v_cr;
  double sum = 0;
  for (int n = 1; n <= modes; n += 2) {
    const double sign = n % 4 == 1 ? 1 : -1;
    sum += sign * (std::sin(n * pi * v / L * t) - a / n * std::sin(n * n * pi / L * v_cr * t)) /
           (double(n) * n * (double(n) * n - a * a));
  }
  return 2 * P * L * L * L / (std::pow(pi, 4) * EI_force) * sum;
}

struct ForceError {
  double midspan = 0, first_mode = 0;  ///< relative to the largest deflection, 0.01815940 m
};

ForceError force_error(int elements, double step) {
  MovingForceOnBeam system(elements);
  Newmark newmark(system, {.step = step});
  ForceError worst;
  for (long i = 1; i <= std::lround(2.5 / step); ++i) {
    newmark.step();
    const State& s = newmark.state();
    worst.midspan =
        std::max(worst.midspan, std::abs(system.beam.midspan(s) - fryba_midspan(s.t, 60)) / 0.01815940);
    worst.first_mode =
        std::max(worst.first_mode, std::abs(system.beam.first_mode(s) - fryba_midspan(s.t, 1)) / 0.01815940);
  }
  return worst;
}

TEST(SimplySupportedBeam, UnderAMovingForceFollowsFryba) {
  // values of the source's table, 200 modes
  EXPECT_NEAR(fryba_midspan(1.25), 0.017566694427246954, 1e-12);
  EXPECT_NEAR(fryba_midspan(1.3275), 0.01815940359130847, 1e-12);
  EXPECT_LT(force_error(10, 2.5e-3).midspan, 1e-3);  // mesh and step of the source: measured 3.1e-4
  EXPECT_LT(force_error(16, 4e-4).midspan, 2e-5);    // measured 4.9e-6
}

// Of the first mode, as the free vibrations of higher ones lose their phase one by one in 2.5 s and hide the order.
TEST(SimplySupportedBeam, UnderAMovingForceConvergesWithOrder2InTimeAnd4InSpace) {
  std::vector<double> in_time, in_space;
  for (const double step : {4e-3, 2e-3, 1e-3}) in_time.push_back(force_error(40, step).first_mode);
  for (const int n : {8, 16}) in_space.push_back(force_error(n, 1e-4).first_mode);
  // measured 2.2e-4, 5.6e-5, 1.4e-5 in time, 4.1e-5, 2.4e-6 in space
  EXPECT_NEAR(std::log2(in_time[0] / in_time[1]), 2, 0.05);
  EXPECT_NEAR(std::log2(in_time[1] / in_time[2]), 2, 0.05);
  EXPECT_NEAR(std::log2(in_space[0] / in_space[1]), 4, 0.2);
}

// ---- a moving sprung mass on an unsprung mass that stays on the beam: STEM benchmark "test_sdof_uvec_beam" after
// Biggs 1964, sec. 8.5 (retyped) ----

constexpr double m_s = 3000, m_u = 5750, k_s = 1.595e8, c_s = 1000, v_s = 100 / 3.6;
constexpr double EI_s = 2.87e9 * 0.29, m_beam = 2303 * 0.1, W = (m_s + m_u) * 9.81;
constexpr double rigid = std::numeric_limits<double>::infinity();
constexpr double largest_s = 0.03816172050329974;  // largest deflection at midspan in the source's table [m]

/// Sprung and unsprung mass, up from where they stand on the unloaded beam; the contact spring carries W there.
class SprungMass {
 public:
  SprungMass(System& system, double contact)
      : k_c(contact),
        z_s(system.coordinate("sprung")),
        z_u(system.coordinate("unsprung")),
        sprung(system.body("sprung", m_s)),
        unsprung(system.body("unsprung", m_u)) {}
  void place() {
    sprung = translate(0, 0, z_s);
    unsprung = translate(0, 0, z_u);
  }
  void act(Port beam) {
    const double spring = k_s * (z_s.value() - z_u.value()) + c_s * (z_s.rate() - z_u.rate());
    const double change = k_c * (-z_u.value() - beam.displacement());  // of the contact force
    beam.add_force(W + change);
    sprung.add_force({0, 0, -spring}, sprung.position());
    unsprung.add_force({0, 0, spring + change}, unsprung.position());
  }
  double k_c;  ///< [N/m]
  Coordinate z_s, z_u;
  Body &sprung, &unsprung;
};

/// The first mode of the beam only, one coordinate.
class SprungMassOnOneMode : public System {
 public:
  explicit SprungMassOnOneMode(double contact) : mode(make()), mass(*this, contact) {}
  LinearStructure& mode;
  SprungMass mass;

 protected:
  void positions() override { mass.place(); }
  void forces() override {
    const double theta = pi * v_s * time().value() / L;
    PortShape shape;
    shape.add(0, std::sin(theta), pi / L * std::cos(theta));
    mass.act(touch(mode, shape));
  }

 private:
  LinearStructure& make() {
    SparseMatrix M(1, 1), C(1, 1), K(1, 1);
    M.insert(0, 0) = m_beam * L / 2;
    K.insert(0, 0) = std::pow(pi / L, 4) * EI_s * L / 2;
    return structure("mode", M, C, K);
  }
};

class SprungMassOnBeam : public System {
 public:
  SprungMassOnBeam(int n, double contact) : beam(*this, EI_s, m_beam, L, n), mass(*this, contact) {}
  PinnedBeam beam;
  SprungMass mass;

 protected:
  void positions() override { mass.place(); }
  void forces() override { mass.act(beam.touch(v_s * time().value())); }
};

struct ModalSolution {
  std::vector<double> midspan, vehicle;  ///< downward, at 0.05, 0.10 ... 0.85 s [m]
  double largest = 0, time = 0, largest_vehicle = 0;
};

/// The same problem in modes of the beam by the method of Runge and Kutta of fourth order: independent of the kernel and
/// of finite elements.
/// @param contact     of the contact spring [N/m]; infinity: the unsprung mass is rigidly on the beam
/// @param convective  with the Coriolis and centripetal acceleration of a rigid unsprung mass; Biggs leaves them out
ModalSolution solve_by_modes(int modes, double step, double contact, bool convective = true) {
  const auto N = static_cast<Eigen::Index>(modes);
  const bool is_rigid = std::isinf(contact);
  Eigen::VectorXd k(N), w2(N);
  for (Eigen::Index n = 0; n < N; ++n) {
    k[n] = (static_cast<double>(n) + 1) * pi / L;
    w2[n] = std::pow(k[n], 4) * EI_s / m_beam;
  }
  const double M = m_beam * L / 2;
  // y: modal deflections, sprung and unsprung mass downward (the latter 0 if rigid), then their rates
  const auto rate = [&](double t, const Eigen::VectorXd& y) {
    const Eigen::ArrayXd angle = k.array() * v_s * t;
    const Eigen::VectorXd phi = angle.sin(), dphi = v_s * k.array() * angle.cos();
    const Eigen::VectorXd ddphi = -(v_s * k.array()).square() * angle.sin();
    const auto q = y.head(N), qd = y.segment(N + 2, N);
    const double w = phi.dot(q), z_u = is_rigid ? w : y[N + 1];
    const double dz_u = is_rigid ? phi.dot(qd) + dphi.dot(q) : y[2 * N + 3];
    const double spring = k_s * (y[N] - z_u) + c_s * (y[2 * N + 2] - dz_u);
    Eigen::VectorXd out(2 * N + 4);
    out.head(N + 2) = y.tail(N + 2);
    out[2 * N + 2] = -spring / m_s;
    if (is_rigid) {
      const double extra = convective ? 2 * dphi.dot(qd) + ddphi.dot(q) : 0;
      // (M + m_u phi phi^T) qdd = (W + spring - m_u extra) phi - M w^2 q, by Sherman and Morrison
      const Eigen::VectorXd f = (W + spring - m_u * extra) / M * phi - w2.cwiseProduct(q);
      out.segment(N + 2, N) = f - m_u / M * phi * (phi.dot(f) / (1 + m_u / M * phi.squaredNorm()));
      out[2 * N + 3] = 0;
    } else {
      const double change = contact * (z_u - w);
      out.segment(N + 2, N) = (W + change) / M * phi - w2.cwiseProduct(q);
      out[2 * N + 3] = (spring - change) / m_u;
    }
    return out;
  };
  ModalSolution s;
  Eigen::VectorXd y = Eigen::VectorXd::Zero(2 * N + 4);
  for (long i = 1; i <= std::lround(0.85 / step); ++i) {
    const double t = static_cast<double>(i - 1) * step;
    const Eigen::VectorXd a = rate(t, y), b = rate(t + step / 2, y + step / 2 * a),
                          c = rate(t + step / 2, y + step / 2 * b), d = rate(t + step, y + step * c);
    y += step / 6 * (a + 2 * b + 2 * c + d);
    double w = 0;
    for (Eigen::Index n = 0; n < N; n += 2) w += (n % 4 == 0 ? 1 : -1) * y[n];
    if (w > s.largest) s.largest = w, s.time = static_cast<double>(i) * step;
    s.largest_vehicle = std::max(s.largest_vehicle, y[N]);
    if (i % std::lround(0.05 / step) == 0) s.midspan.push_back(w), s.vehicle.push_back(y[N]);
  }
  return s;
}

TEST(SprungMassOnBeam, InOneModeIsTheTableOfBiggsWithoutConvectiveAccelerations) {
  const ModalSolution s = solve_by_modes(1, 5e-5, rigid, false);
  EXPECT_NEAR(s.largest / largest_s, 1, 1e-6);
  EXPECT_NEAR(s.time, 0.5265, 5e-4);  // rows of the table are 5e-4 s apart
  EXPECT_NEAR(s.largest_vehicle / 0.037207791842175666, 1, 1e-6);
  EXPECT_NEAR(s.midspan[3], 2.517375416e-02, 1e-10);  // 0.2 s
  EXPECT_NEAR(s.vehicle[3], 1.619821179e-02, 1e-10);
  EXPECT_NEAR(s.midspan[13], 1.816972207e-02, 1e-10);  // 0.7 s
  EXPECT_NEAR(s.vehicle[13], 1.165315813e-02, 1e-10);
}

/// Largest difference of the kernel's run from the modal solution, of midspan and vehicle, relative.
template <class Deflection>
double difference(System& system, double step, const ModalSolution& reference, Deflection midspan) {
  Newmark newmark(system, {.step = step});
  double worst = 0;
  for (std::size_t k = 0; k < reference.midspan.size(); ++k) {
    for (long i = 0; i < std::lround(0.05 / step); ++i) newmark.step();
    worst = std::max({worst, std::abs(midspan(newmark.state()) - reference.midspan[k]),
                      std::abs(-newmark.state().q[0] - reference.vehicle[k])});
  }
  return worst / largest_s;
}

TEST(SprungMassOnBeam, ThroughAStiffContactFollowsTheSingleModeWithItsConvectiveAccelerations) {
  const ModalSolution reference = solve_by_modes(1, 5e-5, rigid);
  // they make 1.1 % of the largest deflection
  EXPECT_NEAR(reference.largest / largest_s, 1.0115, 5e-4);
  SprungMassOnOneMode system(1e10);  // yields 9e-6 m, 2e-4 of the deflection
  const double d = difference(system, 5e-4, reference, [](const State& s) { return s.q[2]; });
  EXPECT_LT(d, 5e-4);  // measured 1.9e-4
}

TEST(SprungMassOnBeam, FollowsAllItsModesOnTheContactOfTheSource) {
  const double contact = 1 / 9.1e-8;
  const ModalSolution reference = solve_by_modes(40, 4e-5, contact),
                      fewer = solve_by_modes(20, 1e-4, contact);
  double truncation = 0;
  for (std::size_t k = 0; k < reference.midspan.size(); ++k)
    truncation = std::max(truncation, std::abs(reference.midspan[k] - fewer.midspan[k]) / largest_s);
  const auto error = [&](int elements, double step) {
    SprungMassOnBeam system(elements, contact);
    return difference(system, step, reference, [&](const State& s) { return system.beam.midspan(s); });
  };
  EXPECT_LT(truncation, 1e-4);
  EXPECT_LT(error(20, 1.25e-4), 2e-4);  // measured 4.1e-5
  // down to the truncation at 40 modes: measured 6.3e-4, 1.7e-4 in time; 4.9e-3, 8.2e-5 in space, where a contact
  // that passes nodes and higher modes that lose their phase hide the fourth order
  EXPECT_GT(std::log2(error(20, 1e-3) / error(20, 5e-4)), 1.8);
  EXPECT_GT(0.5 * std::log2(error(4, 4e-5) / error(16, 4e-5)), 2.8);
  EXPECT_LT(error(10, 5e-4), 5e-3);
}

}  // namespace
