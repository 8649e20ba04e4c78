#include "soil/wave_engine.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>
#include <random>

#include "soil/relaxation.hpp"
#include "tests/soil/reference_operator.hpp"
#include "tests/soil/ring_down.hpp"

namespace easydyn::soil {
namespace {

/// Uneven small lattice with two materials; nothing symmetric, so that no error can hide.
Lattice small_lattice(int degree) {
  Lattice lattice;
  lattice.degree = degree;
  lattice.half_model = false;
  lattice.x = {-2.0, -0.8, 0.1, 1.5};
  lattice.y = {-1.1, 0.3, 1.0, 2.4};
  lattice.z = {-3.0, -1.7, -0.9, -0.4, 0.0};
  lattice.layer = {1, 1, 0, 0};
  return lattice;
}

std::vector<EngineMaterial> two_materials() {
  EngineMaterial top{2.3e7, 1.1e7, 1800, 0, {}}, bottom{9.1e7, 2.7e7, 2000, 0, {}};
  return {top, bottom};
}

EngineBoundary free_boundary() {
  EngineBoundary boundary;
  boundary.sponge_speed = 0;
  boundary.dashpots = false;
  return boundary;
}

template <class T>
std::vector<double> fill(WaveEngine<T>& engine, const std::function<double(int, int, int, int)>& value) {
  std::vector<double> u;
  for (int c = 0; c < 3; ++c)
    for (int Z = 0; Z < engine.nodes_z(); ++Z)
      for (int Y = 0; Y < engine.nodes_y(); ++Y)
        for (int X = 0; X < engine.nodes_x(); ++X) {
          engine.set_displacement(c, X, Y, Z, value(c, X, Y, Z));
          u.push_back(engine.displacement(c, X, Y, Z));
        }
  return u;
}

double largest(const std::vector<double>& values) {
  double result = 0;
  for (const double v : values) result = std::max(result, std::abs(v));
  return result;
}

/// Position of the nodes of one axis.
std::vector<double> positions(const std::vector<double>& lines, int degree) {
  const GllRule rule(degree);
  std::vector<double> result;
  for (std::size_t e = 0; e + 1 < lines.size(); ++e)
    for (int i = e == 0 ? 0 : 1; i <= degree; ++i)
      result.push_back(lines[e] + (lines[e + 1] - lines[e]) * (rule.points(i) + 1) / 2);
  return result;
}

template <class T>
double error_against_reference(int degree, int threads, int nx) {
  Lattice lattice = small_lattice(degree);
  while (lattice.nx() < nx) lattice.x.push_back(lattice.x.back() + 0.7 + 0.1 * std::sin(lattice.nx()));
  WaveEngine<T> engine(lattice, two_materials(), {}, free_boundary(), threads);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto u = fill(engine, [&](int, int, int, int) { return uniform(random); });
  const auto f = engine.compute_internal_force();
  const auto expected = test::compute_reference_force(lattice, two_materials(), u);
  std::vector<double> difference(f.size());
  for (std::size_t p = 0; p < f.size(); ++p) difference[p] = f[p] - expected[p];
  return largest(difference) / largest(expected);
}

TEST(WaveEngine, AppliesTheOperatorOfTheTextbook) {
  for (const int degree : {3, 4, 5, 6}) {
    EXPECT_LT(error_against_reference<double>(degree, 1, 3), 1e-13) << "degree " << degree;
    EXPECT_LT(error_against_reference<double>(degree, 2, 3), 1e-13) << "degree " << degree;
    EXPECT_LT(error_against_reference<float>(degree, 1, 3), 1e-5) << "degree " << degree;
  }
  // Several packs of elements, and numbers of elements around the length of a pack.
  for (const int nx : {13, 14, 15, 16, 17, 31}) {
    EXPECT_LT(error_against_reference<double>(3, 1, nx), 1e-13) << nx << " elements";
    EXPECT_LT(error_against_reference<float>(3, 1, nx), 1e-5) << nx << " elements";
  }
}

TEST(WaveEngine, HasTheMassOfTheGround) {
  const Lattice lattice = small_lattice(4);
  WaveEngine<double> engine(lattice, two_materials(), {}, free_boundary(), 1);
  double mass = 0;
  for (int Z = 0; Z < engine.nodes_z(); ++Z)
    for (int Y = 0; Y < engine.nodes_y(); ++Y)
      for (int X = 0; X < engine.nodes_x(); ++X) mass += engine.mass(X, Y, Z);
  EXPECT_NEAR(mass, 3.5 * 3.5 * (0.9 * 1800 + 2.1 * 2000), 1e-9 * mass);  // length x width x layers, by hand
}

TEST(WaveEngine, FeelsNoForceInARigidMotion) {
  const Lattice lattice = small_lattice(4);
  WaveEngine<double> engine(lattice, two_materials(), {}, free_boundary(), 2);
  const auto x = positions(lattice.x, 4), y = positions(lattice.y, 4), z = positions(lattice.z, 4);
  // Translation t plus small rotation r: u = t + r x p.
  const double t[3] = {0.3, -0.2, 0.7}, r[3] = {0.5, -1.1, 0.8};
  fill(engine, [&](int c, int X, int Y, int Z) {
    const double p[3] = {x[X], y[Y], z[Z]};
    return t[c] + r[(c + 1) % 3] * p[(c + 2) % 3] - r[(c + 2) % 3] * p[(c + 1) % 3];
  });
  EXPECT_LT(largest(engine.compute_internal_force()), 1e-12 * 9.1e7);
}

TEST(WaveEngine, IsInEquilibriumUnderAUniformStress) {
  // Uniform strain in one material: forces only on the outer faces.
  Lattice lattice = small_lattice(5);
  lattice.layer = {0, 0, 0, 0};
  WaveEngine<double> engine(lattice, two_materials(), {}, free_boundary(), 1);
  const auto x = positions(lattice.x, 5), y = positions(lattice.y, 5), z = positions(lattice.z, 5);
  const double g[3][3] = {{0.3, 0.1, -0.4}, {0.7, -0.5, 0.2}, {0.6, -0.1, 0.9}};
  fill(engine, [&](int c, int X, int Y, int Z) { return g[c][0] * x[X] + g[c][1] * y[Y] + g[c][2] * z[Z]; });
  const auto f = engine.compute_internal_force();
  const int nX = engine.nodes_x(), nY = engine.nodes_y(), nZ = engine.nodes_z();
  double inside = 0, top = 0;
  for (int c = 0; c < 3; ++c)
    for (int Z = 0; Z < nZ; ++Z)
      for (int Y = 0; Y < nY; ++Y)
        for (int X = 0; X < nX; ++X) {
          const double value = f[((static_cast<std::size_t>(c) * nZ + Z) * nY + Y) * nX + X];
          if (X > 0 && X < nX - 1 && Y > 0 && Y < nY - 1 && Z > 0 && Z < nZ - 1)
            inside = std::max(inside, std::abs(value));
          if (c == 2 && Z == nZ - 1) top += X > 0 && X < nX - 1 && Y > 0 && Y < nY - 1 ? value : 0;
        }
  EXPECT_LT(inside, 1e-12 * 2.3e7);
  // Traction sigma_zz on the top face away from its edges: lambda tr + 2 mu e_zz times the area of its nodes.
  double area = 0;
  for (int Y = 1; Y < nY - 1; ++Y)
    for (int X = 1; X < nX - 1; ++X) area += engine.mass(X, Y, nZ - 1);
  const GllRule rule(5);
  area /= 1800 * rule.weights(5) * 0.4 / 2;  // mass per area of the top nodes
  EXPECT_NEAR(top, (2.3e7 * (0.3 - 0.5 + 0.9) + 2 * 1.1e7 * 0.9) * area, 1e-9 * std::abs(top));
}

TEST(WaveEngine, ConservesEnergyWithoutDamping) {
  // Free box, a pulse on one surface node, double precision: energy = work done, then constant.
  const Lattice lattice = small_lattice(4);
  for (const int threads : {1, 2}) {
    WaveEngine<double> engine(lattice, two_materials(), {}, free_boundary(), threads);
    const double dt = 0.9 * engine.compute_stable_step();
    engine.set_time_step(dt);
    double work = 0;
    for (int step = 0; step < 400; ++step) {
      const double t = step * dt, duration = 150 * dt;
      const double force = t < duration ? -1e3 * std::pow(std::sin(M_PI * t / duration), 2) : 0.0;
      engine.advance({{7, 6, force}}, true);
      work += engine.step_work();
      if (step == 200 || step == 399) {
        EXPECT_NEAR(engine.energy(), work, 1e-11 * work) << threads << " threads";
      }
    }
    EXPECT_GT(work, 0);
  }
}

TEST(WaveEngine, LosesEnergyMonotonicallyInTheSpongeAndTheDashpots) {
  Lattice lattice = small_lattice(4);
  lattice.sponge_x = {1, 1};
  lattice.sponge_y = {1, 1};
  lattice.sponge_z = {1, 0};
  EngineBoundary boundary;
  boundary.sponge_speed = 100;
  WaveEngine<double> engine(lattice, two_materials(), {}, boundary, 1);
  const double dt = 0.9 * engine.compute_stable_step();
  engine.set_time_step(dt);
  double before = 0, peak = 0;
  for (int step = 0; step < 600; ++step) {
    engine.advance({{7, 6, step < 100 ? -1e3 * std::pow(std::sin(M_PI * step / 100.0), 2) : 0.0}}, true);
    if (step > 101) {
      EXPECT_LE(engine.energy(), before * (1 + 1e-12)) << "step " << step;
    }
    before = engine.energy();
    peak = std::max(peak, before);
  }
  EXPECT_LT(before, 0.05 * peak);
}

/// Natural frequencies [Hz] and shapes of a free lattice, from the operator of the textbook as a dense matrix.
struct Modes {
  Eigen::VectorXd frequency;
  Eigen::MatrixXd shape;  ///< ordered [component][Z][Y][X], shape' M shape = 1
  Eigen::VectorXd mass;
};

Modes compute_modes(const Lattice& lattice, const std::vector<EngineMaterial>& materials) {
  WaveEngine<double> engine(lattice, materials, {}, free_boundary(), 1);
  const int n = 3 * engine.nodes_x() * engine.nodes_y() * engine.nodes_z();
  Modes modes;
  modes.mass.resize(n);
  for (int p = 0, c = 0; c < 3; ++c)
    for (int Z = 0; Z < engine.nodes_z(); ++Z)
      for (int Y = 0; Y < engine.nodes_y(); ++Y)
        for (int X = 0; X < engine.nodes_x(); ++X) modes.mass(p++) = engine.mass(X, Y, Z);
  const Eigen::VectorXd scale = modes.mass.cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd A(n, n);  // M^-1/2 K M^-1/2
  for (int p = 0; p < n; ++p) {
    std::vector<double> unit(n, 0.0);
    unit[p] = scale(p);
    const auto f = test::compute_reference_force(lattice, materials, unit);
    A.col(p) = scale.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(f.data(), n));
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  modes.frequency = solver.eigenvalues().cwiseMax(0).cwiseSqrt() / (2 * M_PI);
  modes.shape = scale.asDiagonal() * solver.eigenvectors();
  return modes;
}

/// Releases a free lattice from a natural mode and follows the mode's coordinate for 14 periods; the first four
/// let the memory variables, which start from zero, forget.
test::RingDown release(const Lattice& lattice, const std::vector<EngineMaterial>& materials,
                       const std::vector<double>& rates, const Modes& modes, int mode) {
  WaveEngine<double> engine(lattice, materials, rates, free_boundary(), 1);
  const Eigen::VectorXd shape = modes.shape.col(mode), dual = modes.mass.cwiseProduct(shape);
  const double period = 1 / modes.frequency(mode),
               dt = std::min(0.5 * engine.compute_stable_step(), period / 300);
  engine.set_time_step(dt);
  int p = 0;
  fill(engine, [&](int, int, int, int) { return shape(p++); });
  std::vector<double> q;
  while (static_cast<double>(q.size()) * dt < 19 * period) {
    double sum = 0;
    p = 0;
    for (int c = 0; c < 3; ++c)
      for (int Z = 0; Z < engine.nodes_z(); ++Z)
        for (int Y = 0; Y < engine.nodes_y(); ++Y)
          for (int X = 0; X < engine.nodes_x(); ++X) sum += dual(p++) * engine.displacement(c, X, Y, Z);
    q.push_back(sum);
    engine.advance({}, false);
  }
  return test::measure_ring_down(q, dt, 4 * period, 10);
}

/// Free vibration of a box of two materials damped alike: damping leaves the modes as they are, and each is an
/// oscillator with the complex modulus of the model.
class DampedBox : public testing::Test {
 protected:
  DampedBox() {
    lattice_.degree = 3;
    lattice_.half_model = false;
    lattice_.x = {-0.6, 0.7};
    lattice_.y = {-0.4, 0.5};
    lattice_.z = {-2.6, -1.1, 0.0};
    lattice_.layer = {1, 0};
    modes_ = compute_modes(lattice_, two_materials());
  }
  static constexpr int first_ = 6;  // after the rigid motions
  static constexpr double ratio_ = 0.03;
  Lattice lattice_;
  Modes modes_;
};

// Tolerances: the ratio is that of the modulus at a real frequency; a decaying vibration sees it at a complex
// one, which adds about 2 xi / pi = 1.9 % of the ratio where the modulus changes as causality demands, and a
// third more (2.6 % measured) in the upper part of the band, where two mechanisms change faster. Frequency:
// xi^2 / 2 = 5e-4, left out of the estimate, and the leapfrog's 2e-5.
TEST_F(DampedBox, RingsWithTheRatioAndTheFrequencyOfTheComplexModulus) {
  const double reference = modes_.frequency(first_);
  const Relaxation body = fit_relaxation(ratio_, reference / 3, reference * 10 / 3, reference, 2);
  auto materials = two_materials();
  for (EngineMaterial& m : materials) {
    m.lambda *= body.unrelaxed;
    m.mu *= body.unrelaxed;
    m.memory_weights.assign(body.weights.data(), body.weights.data() + 2);
  }
  const std::vector<double> rates(body.rates.data(), body.rates.data() + 2);
  int high = first_;  // a mode in the upper part of the band
  while (modes_.frequency(high) < 2.5 * reference) ++high;
  ASSERT_LT(modes_.frequency(high), 10.0 / 3 * reference);
  for (const int mode : {first_, high}) {
    const double f = modes_.frequency(mode);
    const test::RingDown ring = release(lattice_, materials, rates, modes_, mode);
    std::complex<double> modulus = body.unrelaxed;  // over that at the reference frequency
    for (int l = 0; l < 2; ++l)
      modulus -= body.unrelaxed * body.weights(l) * body.rates(l) /
                 std::complex<double>(body.rates(l), 2 * M_PI * ring.frequency);
    EXPECT_NEAR(ring.ratio, body.compute_damping_ratio(ring.frequency),
                (mode == first_ ? 0.02 : 0.03) * ratio_)
        << "mode " << mode;
    EXPECT_NEAR(ring.ratio, ratio_, 0.10 * ratio_) << "mode " << mode;  // fit and the above
    EXPECT_NEAR(ring.frequency / f, std::sqrt(modulus.real()), 1e-3) << "mode " << mode;
    if (mode == high) {
      // Stiffer above the reference: frequencies and speeds by 2 xi / pi per factor e. Two mechanisms are within a third of it.
      const double expected = 2 * ratio_ / M_PI * std::log(f / reference);
      EXPECT_NEAR(ring.frequency / f - 1, expected, expected / 3);
    }
  }
}

TEST_F(DampedBox, RingsWithARatioProportionalToTheFrequency) {
  const double reference = modes_.frequency(first_);
  auto materials = two_materials();
  for (EngineMaterial& m : materials) m.beta = ratio_ / (M_PI * reference);
  for (const int mode : {first_, first_ + 4}) {
    const double f = modes_.frequency(mode), expected = ratio_ * f / reference;
    const test::RingDown ring = release(lattice_, materials, {}, modes_, mode);
    EXPECT_NEAR(ring.ratio, expected, 0.01 * expected) << "mode " << mode;
    // The damping force lags by half a step: xi omega dt / 2 at 300 steps per period.
    EXPECT_NEAR(ring.frequency / f, std::sqrt(1 - expected * expected), 0.02 * expected) << "mode " << mode;
  }
}

TEST_F(DampedBox, RingsOnWithoutDamping) {
  const test::RingDown ring = release(lattice_, two_materials(), {}, modes_, first_);
  EXPECT_NEAR(ring.ratio, 0, 1e-5);
  EXPECT_NEAR(ring.frequency / modes_.frequency(first_), 1, 1e-4);
}

TEST(WaveEngine, DoesNotDependOnTheNumberOfThreads) {
  const auto displacement = [](int threads) {
    WaveEngine<double> engine(small_lattice(4), two_materials(), {}, EngineBoundary{}, threads);
    engine.set_time_step(1e-4);
    for (int step = 0; step < 200; ++step) engine.advance({{7, 6, step < 50 ? -1e3 : 0.0}}, false);
    return engine.displacement(2, 3, 9, 16);
  };
  const double one = displacement(1);
  EXPECT_NEAR(displacement(2), one, 1e-12 * std::abs(one));
  EXPECT_NEAR(displacement(3), one, 1e-12 * std::abs(one));
}

}  // namespace
}  // namespace easydyn::soil
