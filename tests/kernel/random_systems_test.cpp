// Random trees, gears and closed loops: the kernel's sweeps against the slow textbook reference, which takes the same
// description with Taylor arithmetic of its own.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <random>

#include "easydyn/easydyn.hpp"
#include "tests/reference/textbook_dynamics.hpp"

namespace easydyn {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d, Eigen::VectorXd;
using reference::Jet, reference::JetPose;

// Two ways to read a description: with the kernel's expressions and frames, with jets and their poses.
struct KernelWorld {
  using Scalar = Expr;
  using Pose = Frame;
  static Expr constant(double v) { return Expr(v); }
  static Frame ground() { return Frame(); }
  static Frame turned(const Frame& F, const Vector3d& axis, const Expr& angle) {
    return F * rotate(axis, angle);
  }
  static Frame moved(const Frame& F, const Expr& x, const Expr& y, const Expr& z) {
    return F * translate(x, y, z);
  }
  static std::array<Expr, 3> point(const Frame& F, const Vector3d& p) {
    const ExprVector e = F.express_point(p);
    return {e.x(), e.y(), e.z()};
  }
};
struct ReferenceWorld {
  int size;  // variables of the Taylor arithmetic
  using Scalar = Jet;
  using Pose = JetPose;
  Jet constant(double v) const { return Jet::constant(size, v); }
  JetPose ground() const { return JetPose::identity(size); }
  static JetPose turned(const JetPose& T, const Vector3d& axis, const Jet& angle) {
    const Matrix3d C =
        Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), axis.normalized()).toRotationMatrix();
    return T.turned(C).rotated(2, angle).turned(C.transpose());
  }
  static JetPose moved(const JetPose& T, const Jet& x, const Jet& y, const Jet& z) {
    return T.translated(x, y, z);
  }
  std::array<Jet, 3> point(const JetPose& T, const Vector3d& p) const {
    const JetPose P = T.translated(constant(p.x()), constant(p.y()), constant(p.z()));
    return {P.p[0], P.p[1], P.p[2]};
  }
};

class Dice {
 public:
  explicit Dice(int seed) : engine_(static_cast<unsigned>(seed)) {}
  double real(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine_); }
  int integer(int low, int high) { return std::uniform_int_distribution<>(low, high)(engine_); }
  Vector3d vector(double size) { return {real(-size, size), real(-size, size), real(-size, size)}; }
  VectorXd vector(int n, double size) {
    VectorXd v(n);
    for (double& x : v) x = real(-size, size);
    return v;
  }

 private:
  std::mt19937 engine_;
};

/// A scalar of the coordinates and the time: one coordinate, a gear, a product, a curve, a drive.
struct Function {
  int kind, i, j;
  double a, b, c;
  static Function random(Dice& dice, int n) {
    return {dice.integer(0, 5), dice.integer(0, n - 1), dice.integer(0, n - 1),
            dice.real(-1, 1),   dice.real(-0.5, 0.5),   dice.real(-1, 1)};
  }
  template <class World>
  auto operator()(const World& w, const std::vector<typename World::Scalar>& z) const {
    const auto &x = z[static_cast<std::size_t>(i)], &y = z[static_cast<std::size_t>(j)], &t = z.back();
    switch (kind) {
      case 0:
        return w.constant(c) + x;
      case 1:
        return w.constant(a) * x + w.constant(b) * y + w.constant(c);
      case 2:
        return w.constant(a) * x * y + sin(x);
      case 3:
        return exp(w.constant(b) * x) / sqrt(w.constant(1) + y * y);
      case 4:
        return x + w.constant(a) * sin(w.constant(3) * t + w.constant(c));
      default:
        return cos(w.constant(a) * x + w.constant(b) * t) * y;
    }
  }
};

struct RandomJoint {
  int parent;  // -1: ground
  bool is_rotation;
  Vector3d axis;
  Function f[3];
  Vector3d fixed_axis, offset;
  double fixed_angle;
};

struct RandomBody {
  int joint;
  Inertia inertia;
  Vector3d offset;
};

/// Which loop stands on the last joint of the tree. Its unknowns are angles.
enum class Linkage { none, four_bar, spatial_four_bar, chain };

/// Everything that describes one mechanism.
struct Description {
  int n;
  Linkage linkage;
  std::vector<RandomJoint> joints;
  std::vector<RandomBody> bodies;
  // Of the linkage.
  Function crank;
  double lengths[4] = {};
  Vector3d axes[4], arms[4];
  VectorXd guess;
  VectorXd q0;  // near which it is looked at; at t = 0 the guess closes the loop

  Description(int seed, Linkage kind) : linkage(kind) {
    Dice dice(seed);
    n = dice.integer(2, 6);
    q0 = dice.vector(n, 2);
    const int count = kind == Linkage::none ? dice.integer(3, 12) : dice.integer(1, 4);
    const auto random_inertia = [&] {  // a box turned in its frame
      const Vector3d edges = dice.vector(0.5) + Vector3d::Constant(0.7);
      const Matrix3d R = Eigen::AngleAxisd(dice.real(0, 3), dice.vector(1).normalized()).toRotationMatrix();
      const double mass = dice.real(0.5, 3);
      return Inertia(mass, R * Inertia::box(mass, edges.x(), edges.y(), edges.z()).J * R.transpose());
    };
    for (int k = 0; k < count; ++k) {
      RandomJoint joint{dice.integer(-1, k - 1), dice.integer(0, 2) > 0, {}, {}, {}, {}, 0};
      const int axis = dice.integer(0, 3);
      joint.axis = axis < 3 ? Vector3d(Vector3d::Unit(axis)) : dice.vector(1);
      for (Function& f : joint.f) f = Function::random(dice, n);
      joint.fixed_axis = dice.vector(1);
      joint.fixed_angle = dice.real(-3, 3);
      joint.offset = dice.vector(0.6);
      joints.push_back(joint);
      if (dice.integer(0, 2) > 0 || k == count - 1) bodies.push_back({k, random_inertia(), dice.vector(0.3)});
    }
    crank = {1, dice.integer(0, n - 1), dice.integer(0, n - 1), 1, dice.real(-0.5, 0.5), dice.real(-1, 1)};
    for (Vector3d& axis : axes) axis = dice.vector(1);
    for (Vector3d& arm : arms) arm = dice.vector(0.6);
    switch (kind) {
      case Linkage::none:
        return;
      case Linkage::four_bar:
        // Crank-rocker after Grashof: the crank is shortest, shortest and longest are shorter than the others.
        lengths[0] = dice.real(0.2, 0.4);
        lengths[1] = dice.real(0.9, 1.0);
        lengths[2] = dice.real(0.8, 1.0);
        lengths[3] = dice.real(0.9, 1.1);
        guess = VectorXd::Zero(2);
        guess << 0.8, 1.8;
        break;
      case Linkage::spatial_four_bar:
        guess = dice.vector(1, 1);
        break;
      case Linkage::chain:
        guess = dice.vector(3, 1);
        break;
    }
    for (int k = 0; k < static_cast<int>(guess.size()); ++k)
      bodies.push_back({count + k, random_inertia(), dice.vector(0.3)});
    close_at_guess();
  }

  /// Frames of the tree's joints.
  template <class World>
  auto tree(const World& w, const std::vector<typename World::Scalar>& z) const {
    std::vector<typename World::Pose> poses;
    for (const RandomJoint& k : joints) {
      auto T = k.parent < 0 ? w.ground() : poses[static_cast<std::size_t>(k.parent)];
      T = w.turned(T, k.fixed_axis, w.constant(k.fixed_angle));
      T = w.moved(T, w.constant(k.offset.x()), w.constant(k.offset.y()), w.constant(k.offset.z()));
      T = k.is_rotation ? w.turned(T, k.axis, k.f[0](w, z))
                        : w.moved(T, k.f[0](w, z), k.f[1](w, z), k.f[2](w, z));
      poses.push_back(T);
    }
    return poses;
  }

  /// Frames of the linkage's parts, by the unknown angles p.
  template <class World>
  auto parts(const World& w, const typename World::Pose& base, const std::vector<typename World::Scalar>& p,
             const std::vector<typename World::Scalar>& z) const {
    const auto move = [&](const auto& T, const Vector3d& v) {
      return w.moved(T, w.constant(v.x()), w.constant(v.y()), w.constant(v.z()));
    };
    std::vector<typename World::Pose> result;
    switch (linkage) {
      case Linkage::none:
        break;
      case Linkage::four_bar: {  // in the plane x-y of the base: coupler and rocker
        const auto pin = move(w.turned(base, Vector3d::UnitZ(), crank(w, z)), {lengths[0], 0, 0});
        result.push_back(w.turned(pin, Vector3d::UnitZ(), p[0] - crank(w, z)));
        result.push_back(w.turned(move(base, {lengths[3], 0, 0}), Vector3d::UnitZ(), p[1]));
        break;
      }
      case Linkage::spatial_four_bar:  // rocker
        result.push_back(w.turned(move(base, arms[2]), axes[1], p[0]));
        break;
      case Linkage::chain: {
        auto T = base;
        for (std::size_t k = 0; k < 3; ++k) {
          T = move(w.turned(T, axes[k], p[k]), arms[k]);
          result.push_back(T);
        }
        break;
      }
    }
    return result;
  }

  /// What the unknown angles must make zero.
  template <class World>
  auto equations(const World& w, const typename World::Pose& base,
                 const std::vector<typename World::Scalar>& p,
                 const std::vector<typename World::Scalar>& z) const {
    std::vector<typename World::Scalar> g;
    if (linkage == Linkage::four_bar) {
      const auto angle = crank(w, z);
      const auto l = [&](int i) { return w.constant(lengths[i]); };
      g.push_back(l(0) * cos(angle) + l(1) * cos(p[0]) - l(2) * cos(p[1]) - l(3));
      g.push_back(l(0) * sin(angle) + l(1) * sin(p[0]) - l(2) * sin(p[1]));
      return g;
    }
    const auto links = parts(w, base, p, z);
    if (linkage == Linkage::spatial_four_bar) {  // a rod of constant length from the crank to the rocker
      const auto A = w.point(w.turned(base, axes[0], crank(w, z)), arms[0]), B = w.point(links[0], arms[1]);
      auto square = w.constant(-lengths[0] * lengths[0]);
      for (std::size_t i = 0; i < 3; ++i) square = square + (B[i] - A[i]) * (B[i] - A[i]);
      g.push_back(square);
    } else {  // the tip of the chain where the crank's arm is
      const auto A = w.point(w.turned(base, axes[3], crank(w, z)), arms[3]),
                 B = w.point(links[2], Vector3d::Zero());
      for (std::size_t i = 0; i < 3; ++i) g.push_back(B[i] - A[i]);
    }
    return g;
  }

 private:
  /// Sizes that are free are set so that the loop is closed at q0, t = 0 by the guess.
  void close_at_guess() {
    const ReferenceWorld w{1};
    std::vector<Jet> z, p;
    for (const double q : q0) z.push_back(w.constant(q));
    z.push_back(w.constant(0));
    for (const double x : guess) p.push_back(w.constant(x));
    const JetPose base = w.ground();
    const auto vector = [](const std::array<Jet, 3>& v) { return Vector3d(v[0].f, v[1].f, v[2].f); };
    if (linkage == Linkage::spatial_four_bar)
      lengths[0] = (vector(w.point(w.turned(base, axes[0], crank(w, z)), arms[0])) -
                    vector(w.point(parts(w, base, p, z)[0], arms[1])))
                       .norm();
    if (linkage == Linkage::chain) {
      const Vector3d tip = vector(w.point(parts(w, base, p, z)[2], Vector3d::Zero()));
      arms[3] = Eigen::AngleAxisd(-crank(w, z).f, axes[3].normalized()) * tip;
    }
  }
};

template <int N>
class RandomSystem : public System {
 public:
  explicit RandomSystem(const Description& description) : System("random"), d_(description) {
    for (int i = 0; i < d_.n; ++i) coordinates_.push_back(coordinate("q" + std::to_string(i), d_.q0[i]));
    for (const RandomBody& b : d_.bodies)
      bodies_of_.push_back(&body("body " + std::to_string(bodies_of_.size()), b.inertia));
    if constexpr (N > 0) {
      std::array<double, N> guess;
      for (int i = 0; i < N; ++i) guess[static_cast<std::size_t>(i)] = d_.guess[i];
      closing_.push_back(loop<N>("loop", guess));
    }
  }

 protected:
  void positions() override {
    const KernelWorld w;
    std::vector<Expr> z(coordinates_.begin(), coordinates_.end());
    z.push_back(time());
    std::vector<Frame> frames = d_.tree(w, z);
    if constexpr (N > 0) {
      const Frame base = frames.back();
      const auto p = closing_[0].solve([&](const auto& unknown) {
        return d_.equations(w, base, std::vector<Expr>(unknown.begin(), unknown.end()), z);
      });
      for (const Frame& F : d_.parts(w, base, std::vector<Expr>(p.begin(), p.end()), z)) frames.push_back(F);
    }
    for (std::size_t b = 0; b < bodies_of_.size(); ++b)
      *bodies_of_[b] = frames[static_cast<std::size_t>(d_.bodies[b].joint)] * translate(d_.bodies[b].offset);
  }
  void forces() override { gravity(); }

 private:
  Description d_;
  std::vector<Coordinate> coordinates_;
  std::vector<Body*> bodies_of_;
  std::vector<Loop<N>> closing_;
};

/// The same by the reference; `condition` is that of the loop's Jacobian.
reference::TextbookDynamics reference_dynamics(const Description& d, const State& s, double& condition) {
  VectorXd values(d.n + 1);
  values << s.q, s.t;
  const ReferenceWorld w{d.n + 1};
  std::vector<Jet> z;
  for (int i = 0; i <= d.n; ++i) z.push_back(Jet::variable(d.n + 1, i, values[i]));
  std::vector<JetPose> poses = d.tree(w, z);
  condition = 1;
  if (d.linkage != Linkage::none) {
    const int N = static_cast<int>(d.guess.size());
    Eigen::MatrixXd J(N, N);
    const std::vector<Jet> p = reference::solve_implicit(
        [&](const std::vector<Jet>& unknown, const std::vector<Jet>& variables) {
          const ReferenceWorld all{N + d.n + 1};
          const auto g = d.equations(all, all.ground(), unknown, variables);  // the same in any base
          for (int i = 0; i < N; ++i) J.row(i) = g[static_cast<std::size_t>(i)].g.head(N).transpose();
          return g;
        },
        d.guess, values);
    const VectorXd singular = Eigen::JacobiSVD<Eigen::MatrixXd>(J).singularValues();
    condition = std::max(1.0, singular[0]) / singular[N - 1];
    for (const JetPose& T : d.parts(w, poses.back(), p, z)) poses.push_back(T);
  }
  std::vector<reference::TextbookBody> bodies;
  for (const RandomBody& b : d.bodies)
    bodies.push_back({b.inertia.mass, b.inertia.J,
                      poses[static_cast<std::size_t>(b.joint)].translated(
                          w.constant(b.offset.x()), w.constant(b.offset.y()), w.constant(b.offset.z()))});
  return reference::textbook_dynamics(bodies, s.qd, 9.81);
}

/// Largest deviations from the reference, relative to M and to the inertia forces of the motion.
struct Deviation {
  double M = 0, h = 0;
  int compared = 0;
};

template <int N>
void compare(int seed, Linkage linkage, Deviation& worst) {
  const Description d(seed, linkage);
  RandomSystem<N> system(d);
  Dice dice(seed + 1000);
  for (int trial = 0; trial < 4; ++trial) {
    State s = system.initial_state();
    const double reach = linkage == Linkage::none ? 2 : 0.05;
    s.q += dice.vector(d.n, reach);
    s.t = dice.real(-reach, reach);
    s.qd = dice.vector(d.n, 2);
    s.qdd = dice.vector(d.n, 3);
    double condition = 1;
    const reference::TextbookDynamics expected = reference_dynamics(d, s, condition);
    // A loop near a dead point multiplies every rounding by its condition, twice in the biases: none of that here.
    if (condition > 10) continue;
    Eigen::MatrixXd M(d.n, d.n);
    VectorXd h(d.n);
    system.compute_mass_and_bias(s, M, h);
    const double size = expected.M.norm();
    // Velocity terms cancel between bodies: they are measured by the largest of them.
    const double force = expected.h.norm() + size * (1 + s.qd.squaredNorm());
    worst.M = std::max(worst.M, (M - expected.M).norm() / size);
    worst.h =
        std::max({worst.h, (h - expected.h).norm() / force,
                  (system.compute_residual(s) - expected.M * s.qdd - expected.h).norm() / force,
                  std::abs(system.compute_energy(s).kinetic - expected.kinetic) / (1 + expected.kinetic)});
    ++worst.compared;
  }
}

// 1e-12: hundreds of sums in another order, of rounding 1e-16 each (measured 4e-14; loops 1e-13).
TEST(RandomTrees, WithGearsAndDrivesAgreeWithTheTextbook) {
  Deviation worst;
  for (int seed = 0; seed < 30; ++seed) compare<0>(seed, Linkage::none, worst);
  EXPECT_EQ(worst.compared, 120);
  EXPECT_LT(worst.M, 1e-12);
  EXPECT_LT(worst.h, 1e-12);
}

TEST(RandomLoops, OfFourBarsOnMovingBasesAgreeWithTheTextbook) {
  Deviation worst;
  for (int seed = 0; seed < 12; ++seed) compare<2>(seed, Linkage::four_bar, worst);
  EXPECT_GT(worst.compared, 40);
  EXPECT_LT(worst.M, 1e-12);
  EXPECT_LT(worst.h, 1e-12);
}

TEST(RandomLoops, OfARodBetweenSkewAxesAgreeWithTheTextbook) {
  Deviation worst;
  for (int seed = 0; seed < 20; ++seed) compare<1>(seed, Linkage::spatial_four_bar, worst);
  EXPECT_GT(worst.compared, 20);
  EXPECT_LT(worst.M, 1e-12);
  EXPECT_LT(worst.h, 1e-12);
}

TEST(RandomLoops, OfThreeAxesThatFollowAPointAgreeWithTheTextbook) {
  Deviation worst;
  for (int seed = 0; seed < 20; ++seed) compare<3>(seed, Linkage::chain, worst);
  EXPECT_GT(worst.compared, 20);
  EXPECT_LT(worst.M, 1e-12);
  EXPECT_LT(worst.h, 1e-12);
}

}  // namespace
}  // namespace easydyn
