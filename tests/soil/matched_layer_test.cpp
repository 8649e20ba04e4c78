// The perfectly matched layer of the wave engine: what must hold to rounding, whatever it absorbs.

#include "soil/matched_layer.hpp"

#include <gmock/gmock.h>

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <cstdio>
#include <cstring>
#include <mutex>

#include "easydyn/error.hpp"
#include "soil/wave_engine.hpp"
#include "tests/soil/small_ground.hpp"
#include "tests/soil/thread_ranks.hpp"

namespace easydyn::soil {
namespace {

enum class Damping { none, viscous, memory };

/// Uneven lattice of two layers, a layer of one or two elements on each outer side, a block and a trench inside.
Lattice make_ground(int degree, bool half) {
  Lattice lattice;
  lattice.degree = degree;
  lattice.half_model = half;
  lattice.x = {-4.1, -3.0, -2.0, -0.8, 0.1, 1.5, 2.2, 3.4};
  lattice.y = {0, 1.1, 2.0, 3.2, 4.0, 5.3, 6.1, 7.5};
  lattice.z = {-5.2, -4.1, -3.0, -1.9, -1.2, -0.5, 0};
  lattice.layer = {1, 1, 1, 0, 0, 0};
  lattice.sponge_x = {2, 1};
  lattice.sponge_y = {half ? 0 : 1, 2};
  lattice.sponge_z = {2, 0};
  lattice.blocks = {{{3, 5}, {1, 4}, {3, 5}, 2}, {{4, 6}, {2, 3}, {4, 6}, -1}};
  return lattice;
}

std::vector<EngineMaterial> make_materials(Damping damping) {
  std::vector<EngineMaterial> materials{{2.3e7, 1.1e7, 1800, 0, {0.02, 0.03}},
                                        {9.1e7, 2.7e7, 2000, 0, {0.01, 0.02}},
                                        {3e7, 5e7, 2300, 0, {0.03, 0}}};
  for (EngineMaterial& m : materials) {
    if (damping == Damping::viscous) m.beta = 2e-5;
    if (damping != Damping::memory) m.memory_weights.clear();
  }
  return materials;
}

EngineBoundary make_layer(double strength) {
  EngineBoundary boundary;
  boundary.origin = {0, 3};  // the far-field springs need a distance
  boundary.absorber = AbsorbingBoundary::matched_layer;
  boundary.layer_strength = strength;
  boundary.layer_speed = 240;
  return boundary;
}

template <class T>
WaveEngine<T> make_engine(const Lattice& lattice, Damping damping, const EngineBoundary& boundary,
                          int threads, Ranks* ranks = nullptr) {
  return WaveEngine<T>(lattice, make_materials(damping),
                       damping == Damping::memory ? std::vector<double>{60, 400} : std::vector<double>{},
                       boundary, threads, ranks);
}

constexpr double time_step = 1e-4;

/// A pulse on two nodes of the surface.
template <class T>
void advance(WaveEngine<T>& engine, int first, int last, bool account = false) {
  const int N = (engine.nodes_x() - 1) / 7;
  for (int step = first; step < last; ++step) {
    const double force = step < 60 ? 1e3 * std::sin(M_PI * step / 60) : 0.0;
    engine.advance({{3 * N + 1, N + 2, force, 2}, {3 * N + 2, N + 1, 0.6 * force, 0}}, account);
  }
}

/// Displacement of the lines that an engine holds, [component][Z][Y][X].
template <class T>
std::vector<double> read_displacement(const WaveEngine<T>& engine) {
  std::vector<double> u(static_cast<std::size_t>(3) * engine.nodes_x() * engine.nodes_y() * engine.nodes_z());
  std::size_t p = 0;
  for (int c = 0; c < 3; ++c)
    for (int Z = 0; Z < engine.nodes_z(); ++Z)
      for (int Y = 0; Y < engine.nodes_y(); ++Y)
        for (int X = 0; X < engine.nodes_x(); ++X, ++p)
          if (engine.has_line(Y, Z)) u[p] = engine.displacement(c, X, Y, Z);
  return u;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double difference = 0, largest = 0;
  for (std::size_t p = 0; p < a.size(); ++p) {
    difference = std::max(difference, std::abs(a[p] - b[p]));
    largest = std::max(largest, std::abs(b[p]));
  }
  return difference / largest;
}

TEST(MatchedLayer, WithoutStretchIsPlainGround) {
  for (const int degree : {3, 4, 5, 6})
    for (const Damping damping : {Damping::none, Damping::viscous, Damping::memory}) {
      if (degree != 4 && damping != Damping::none) continue;
      const Lattice lattice = make_ground(degree, degree == 4);
      auto layer = make_engine<double>(lattice, damping, make_layer(0), 2);
      EngineBoundary plain_boundary = make_layer(0);  // no sponge, dashpots and springs alike
      plain_boundary.absorber = AbsorbingBoundary::sponge;
      auto plain = make_engine<double>(lattice, damping, plain_boundary, 2);
      for (auto* engine : {&layer, &plain}) {
        engine->set_time_step(0.3 * time_step);
        advance(*engine, 0, 150);
      }
      // Two ways to sum the same forces: rounding, grown over 150 steps.
      EXPECT_LT(largest_difference(read_displacement(layer), read_displacement(plain)), 1e-12)
          << "degree " << degree;
    }
}

TEST(MatchedLayer, DampsWhatReachesIt) {
  // Not plain ground: the test above could not see states that are never used.
  const Lattice lattice = make_ground(4, true);
  EngineBoundary boundary = make_layer(5);
  boundary.dashpots = false;
  auto layer = make_engine<double>(lattice, Damping::none, boundary, 1);
  boundary.absorber = AbsorbingBoundary::sponge;
  auto plain = make_engine<double>(lattice, Damping::none, boundary, 1);
  for (auto* engine : {&layer, &plain}) {
    engine->set_time_step(time_step);
    advance(*engine, 0, 600);
    engine->advance({}, true);
  }
  EXPECT_LT(layer.kinetic_energy(), 0.5 * plain.kinetic_energy());
  EXPECT_GT(layer.kinetic_energy(), 0);
}

/// A layer driven at one circular frequency w until its filters are steady. To them, by the trapezoidal rule, i w is exactly
/// i Omega = (2 / dt) i tan(w dt / 2).
struct SteadyLayer {
  static constexpr double dt = 1e-3, w = 700, alpha = 300;  // w dt / 2 = 0.35: tan(0.35) = 0.365
  static constexpr int steps = 300;                         // the slowest pole, alpha, leaves 0.74^steps
  static constexpr int N = 4, n = N + 1, stride = 16, line_size = 3 * N * stride;
  const std::complex<double> i_omega{0, 2 / dt* std::tan(w* dt / 2)};
  const GllRule rule{N};
  Lattice lattice;
  EngineMaterial material{2.3e7, 1.1e7, 1800, 0, {}};
  EngineBoundary boundary;
  AxisTables<double> axes;
  ElementBlock part;
  MatchedLayer<double> layer;
  int nX, nY, nZ;
  std::vector<std::complex<double>> amplitude;  // [component][Z][Y][X]

  static Lattice make_lattice() {
    Lattice lattice;
    lattice.degree = N;
    lattice.x = {-1.6, 0, 1.1, 2.0, 3.2, 4.5};
    lattice.y = {0, 1.1, 2.0, 3.3};
    lattice.z = {-3.4, -2.2, -1.0, 0};
    lattice.layer = {0, 0, 0};
    lattice.sponge_x = {1, 2};
    lattice.sponge_y = {0, 2};
    lattice.sponge_z = {2, 0};
    return lattice;
  }
  static EngineBoundary make_boundary() {
    EngineBoundary boundary = make_layer(5);
    boundary.layer_alpha = alpha;
    return boundary;
  }
  SteadyLayer()
      : lattice(make_lattice()),
        boundary(make_boundary()),
        axes(lattice, {material}, stride),
        part{{0, lattice.ny()}, {0, lattice.nz()}},
        layer(lattice, boundary, axes, stride, part),
        nX(lattice.nx() * N + 1),
        nY(lattice.ny() * N + 1),
        nZ(lattice.nz() * N + 1),
        amplitude(static_cast<std::size_t>(3) * nX * nY * nZ) {
    layer.set_time_step(dt);
    for (std::size_t p = 0; p < amplitude.size(); ++p)
      amplitude[p] = {std::sin(1.3 * static_cast<double>(p)), std::cos(2.1 * static_cast<double>(p) + 1)};
  }
  std::complex<double> u(int c, int X, int Y, int Z) const {
    return amplitude[((static_cast<std::size_t>(c) * nZ + Z) * nY + Y) * nX + X];
  }
  static std::complex<double> phase(int step) { return std::polar(1.0, w * dt * step); }
  /// d of an axis at node X: strength x speed / length x (distance / length)^2.
  double damping(const std::vector<double>& lines, std::array<int, 2> ends, int X) const {
    const int e = std::min(X / N, static_cast<int>(lines.size()) - 2);
    const double place = lines[e] + (lines[e + 1] - lines[e]) * (rule.points(X - e * N) + 1) / 2;
    const double low = lines[ends[0]], high = lines[lines.size() - 1 - ends[1]];
    const double distance = std::max({low - place, place - high, 0.0});
    const double length = place < low ? low - lines.front() : lines.back() - high;
    return distance > 0 ? 5 * 240 / length * std::pow(distance / length, 2) : 0;
  }
  std::array<double, 3> damping(int X, int Y, int Z) const {
    return {damping(lattice.x, lattice.sponge_x, X), damping(lattice.y, lattice.sponge_y, Y),
            damping(lattice.z, lattice.sponge_z, Z)};
  }
  std::complex<double> stretch(double d) const { return 1.0 + d / (i_omega + alpha); }
  /// Line of nodes in the engine's layout, at a step.
  std::vector<double> line(int Y, int Z, std::complex<double> factor) const {
    std::vector<double> values(line_size, 0.0);
    for (int c = 0; c < 3; ++c)
      for (int X = 0; X < nX; ++X)
        values[static_cast<std::size_t>(c * N + X % N) * stride + X / N] = (factor * u(c, X, Y, Z)).real();
    return values;
  }
};

TEST(MatchedLayer, StretchesItsElementsAsInTheFrequencyDomain) {
  // f_a = sum_q w_q |J| sum_j (prod_{k != j} s_k) sigma_cj (d phi_a / d x_j)_q / m_x, sigma = C : (1 / s_j) d u_c / d x_j: rows that
  // the layer fills, and of the others the difference from plain elements. Measured 1e-14.
  using Complex = std::complex<double>;
  SteadyLayer s;
  constexpr int N = SteadyLayer::N, n = SteadyLayer::n, stride = SteadyLayer::stride;
  const Lattice& lattice = s.lattice;
  for (int ez = 0; ez < lattice.nz(); ++ez)
    for (int ey = 0; ey < lattice.ny(); ++ey) {
      const bool is_whole = s.layer.fills(ey, ez);
      // [component][k][j][X]
      std::vector<Complex> expected(static_cast<std::size_t>(3) * n * n * s.nX);
      const auto at = [&](int c, int k, int j, int X) -> Complex& {
        return expected[((static_cast<std::size_t>(c) * n + k) * n + j) * s.nX + X];
      };
      for (int ex = 0; ex < lattice.nx(); ++ex) {
        const double h[3] = {lattice.x[ex + 1] - lattice.x[ex], lattice.y[ey + 1] - lattice.y[ey],
                             lattice.z[ez + 1] - lattice.z[ez]};
        for (int k = 0; k < n; ++k)
          for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
              const int q[3] = {i, j, k};
              Eigen::Matrix3cd gradient = Eigen::Matrix3cd::Zero();  // (c, d) = d u_c / d x_d
              for (int c = 0; c < 3; ++c)
                for (int d = 0; d < 3; ++d)
                  for (int a = 0; a < n; ++a) {
                    int p[3] = {i, j, k};
                    p[d] = a;
                    gradient(c, d) += s.rule.derivative(q[d], a) * 2 / h[d] *
                                      s.u(c, ex * N + p[0], ey * N + p[1], ez * N + p[2]);
                  }
              const auto stress = [&](const Eigen::Matrix3cd& g) -> Eigen::Matrix3cd {
                return s.material.lambda * g.trace() * Eigen::Matrix3cd::Identity() +
                       s.material.mu * (g + g.transpose());
              };
              const std::array<double, 3> damping = s.damping(ex * N + i, ey * N + j, ez * N + k);
              const Eigen::Vector3cd S(s.stretch(damping[0]), s.stretch(damping[1]), s.stretch(damping[2]));
              const Eigen::Vector3cd across(S(1) * S(2), S(0) * S(2), S(0) * S(1));
              Eigen::Matrix3cd sigma = stress(gradient * S.cwiseInverse().asDiagonal()) * across.asDiagonal();
              if (!is_whole) sigma -= stress(gradient);
              const double volume =
                  s.rule.weights(i) * s.rule.weights(j) * s.rule.weights(k) * h[0] * h[1] * h[2] / 8;
              for (int c = 0; c < 3; ++c)
                for (int d = 0; d < 3; ++d)
                  for (int a = 0; a < n; ++a) {
                    int p[3] = {i, j, k};
                    p[d] = a;
                    at(c, p[2], p[1], ex * N + p[0]) +=
                        volume * sigma(c, d) * s.rule.derivative(q[d], a) * 2.0 / h[d];
                  }
            }
      }
      for (int c = 0; c < 3; ++c)
        for (int k = 0; k < n; ++k)
          for (int j = 0; j < n; ++j)
            for (int X = 0; X < s.nX; ++X) at(c, k, j, X) /= s.axes.mx[X];

      Tile<double> tile{};
      tile.stride = stride;
      tile.hy = lattice.y[ey + 1] - lattice.y[ey];
      tile.hz = lattice.z[ez + 1] - lattice.z[ez];
      tile.lambda = s.material.lambda;
      tile.mu = s.material.mu;
      AlignedVector<double> scratch(s.layer.scratch_size());
      std::vector<std::vector<double>> w(n * n), f(n * n);
      double difference = 0, largest = 0;
      for (int step = 0; step < SteadyLayer::steps; ++step) {
        for (int l = 0; l < n * n; ++l) {
          w[l] = s.line(ey * N + l % n, ez * N + l / n, SteadyLayer::phase(step));
          f[l].assign(SteadyLayer::line_size, 0.0);
          tile.w[l] = w[l].data();
          tile.f[l] = f[l].data();
        }
        s.layer.add_forces(tile, ey, ez, scratch.data());
        if (step < SteadyLayer::steps - 10) continue;
        for (int c = 0; c < 3; ++c)
          for (int k = 0; k < n; ++k)
            for (int j = 0; j < n; ++j)
              for (int X = 0; X < s.nX; ++X) {
                const Complex value = at(c, k, j, X);
                const double computed =
                    f[k * n + j][static_cast<std::size_t>(c * N + X % N) * stride + X / N];
                largest = std::max(largest, std::abs(value));
                difference =
                    std::max(difference, std::abs(computed - (value * SteadyLayer::phase(step)).real()));
              }
      }
      EXPECT_GT(largest, 0);
      EXPECT_LT(difference, 1e-10 * largest) << "row " << ey << ", slab " << ez;
    }
}

TEST(MatchedLayer, GivesItsNodesTheInertiaOfTheFrequencyDomain) {
  // (v+ - v-) / dt + c1 (v+ + v-) / 2 + G u = 0 without forces, G = (i Omega)^2 (s_x s_y s_z - 1) - i Omega c1, c1 the sum
  // of the d.
  using Complex = std::complex<double>;
  SteadyLayer s;
  constexpr int N = SteadyLayer::N, stride = SteadyLayer::stride;
  constexpr double dt = SteadyLayer::dt, mass = 1700;
  int lines = 0, all_axes = 0;
  for (int Z = 0; Z < s.nZ; ++Z)
    for (int Y = 0; Y < s.nY; ++Y) {
      double difference = 0, largest = 0;
      for (int step = 0; step < SteadyLayer::steps; ++step) {
        const Complex here = SteadyLayer::phase(step), half = (here - SteadyLayer::phase(step - 1)) / dt;
        const std::vector<double> u = s.line(Y, Z, here), before = s.line(Y, Z, half);
        std::vector<double> v = before, f(u.size(), 0.0);
        s.layer.add_inertia(Y, Z, mass, u.data(), v.data(), f.data());
        if (step < SteadyLayer::steps - 10) continue;
        for (int c = 0; c < 3; ++c)
          for (int X = 0; X < s.nX; ++X) {
            const std::array<double, 3> d = s.damping(X, Y, Z);
            const double c1 = d[0] + d[1] + d[2];
            const Complex G =
                s.i_omega * s.i_omega * (s.stretch(d[0]) * s.stretch(d[1]) * s.stretch(d[2]) - 1.0) -
                s.i_omega * c1;
            const std::size_t place = static_cast<std::size_t>(c * N + X % N) * stride + X / N;
            const double change = dt * (G * here * s.u(c, X, Y, Z)).real();
            const double expected = ((1 - c1 * dt / 2) * before[place] - change) / (1 + c1 * dt / 2);
            difference = std::max(difference, std::abs(v[place] - dt * f[place] / mass - expected));
            largest = std::max(largest, std::abs(change));
            if (d[0] > 0 && d[1] > 0 && d[2] > 0) ++all_axes;
          }
      }
      EXPECT_LT(difference, 1e-10 * std::max(largest, 1.0)) << "line " << Y << ", " << Z;
      if (largest > 0) ++lines;
    }
  EXPECT_EQ(lines, s.nY * s.nZ);  // the ends along x of all of them
  EXPECT_GT(all_axes, 0);
}

template <class T>
void expect_same_bits_on_threads() {
  for (const bool half : {true, false})
    for (const Damping damping : {Damping::none, Damping::memory}) {
      std::vector<double> alone;
      double energy = 0;
      for (const int threads : {1, 2, 3}) {
        Lattice lattice = make_ground(3, half);
        auto engine = make_engine<T>(lattice, damping, make_layer(5), threads);
        engine.set_time_step(time_step);
        advance(engine, 0, 150, true);
        if (threads == 1) {
          alone = read_displacement(engine);
          energy = engine.kinetic_energy();
        } else {
          EXPECT_EQ(read_displacement(engine), alone) << threads << " threads";
          EXPECT_NEAR(engine.kinetic_energy(), energy, 1e-6 * energy);  // summed in another order
        }
      }
    }
}

TEST(MatchedLayer, HasTheSameBitsOnAnyNumberOfThreads) {
  expect_same_bits_on_threads<float>();
  expect_same_bits_on_threads<double>();
}

TEST(MatchedLayer, HasTheSameBitsOnRanks) {
  // Blocks apart: a region adds them after the row's layer, see RegionPlan; rows of the matched layer do not.
  const Lattice lattice = make_ground(3, true);
  auto alone = make_engine<float>(lattice, Damping::memory, make_layer(5), 1);
  alone.set_time_step(time_step);
  advance(alone, 0, 150);
  const std::vector<double> expected = read_displacement(alone);
  for (const int count : {2, 4, 6}) {
    std::mutex mutex;
    int different = 0, compared = 0;
    test::ThreadRanks::run(count, [&](Ranks& ranks) {
      auto engine = make_engine<float>(lattice, Damping::memory, make_layer(5), 2, &ranks);
      engine.set_time_step(time_step);
      advance(engine, 0, 150);
      const std::vector<double> u = read_displacement(engine);
      const std::lock_guard lock(mutex);
      std::size_t p = 0;
      for (int c = 0; c < 3; ++c)
        for (int Z = 0; Z < engine.nodes_z(); ++Z)
          for (int Y = 0; Y < engine.nodes_y(); ++Y)
            for (int X = 0; X < engine.nodes_x(); ++X, ++p)
              if (engine.has_line(Y, Z)) {
                ++compared;
                different += u[p] != expected[p] ? 1 : 0;
              }
    });
    EXPECT_EQ(different, 0) << count << " ranks";
    EXPECT_GE(compared, static_cast<int>(expected.size()));
  }
}

TEST(MatchedLayer, GoesOnFromItsStatesWithTheSameBits) {
  const Lattice lattice = make_ground(4, false);
  auto through = make_engine<float>(lattice, Damping::memory, make_layer(5), 2),
       until = make_engine<float>(lattice, Damping::memory, make_layer(5), 2),
       from = make_engine<float>(lattice, Damping::memory, make_layer(5), 2);
  for (auto* engine : {&through, &until, &from}) engine->set_time_step(time_step);
  advance(through, 0, 200);
  advance(until, 0, 120);
  std::vector<char> bytes;
  until.visit_state([&](const void* data, std::size_t size) {
    bytes.insert(bytes.end(), static_cast<const char*>(data), static_cast<const char*>(data) + size);
  });
  advance(from, 0, 17);  // whatever it holds is replaced
  std::size_t at = 0;
  from.visit_state([&](void* data, std::size_t size) {
    std::memcpy(data, bytes.data() + at, size);
    at += size;
  });
  EXPECT_EQ(at, bytes.size());
  advance(from, 120, 200);
  EXPECT_EQ(read_displacement(from), read_displacement(through));

  from.set_to_rest();
  advance(from, 0, 200);
  EXPECT_EQ(read_displacement(from), read_displacement(through));
}

TEST(MatchedLayer, MovesInAQuarterAndAHalfAsInTheWhole) {
  Lattice whole;
  whole.degree = 4;
  whole.half_model = false;
  whole.x = {-4.6, -3.4, -2.0, -0.9, 0.0, 0.9, 2.0, 3.4, 4.6};
  whole.y = {-4.3, -2.9, -1.5, -0.7, 0.0, 0.7, 1.5, 2.9, 4.3};
  whole.z = {-3.0, -1.7, -0.9, 0.0};
  whole.layer = {1, 1, 0};
  whole.sponge_x = whole.sponge_y = {2, 2};
  whole.sponge_z = {1, 0};
  whole.blocks = {{{3, 5}, {3, 5}, {1, 2}, 2}};
  Lattice half = whole;
  half.half_model = true;
  half.y.erase(half.y.begin(), half.y.begin() + 4);
  half.sponge_y = {0, 2};
  half.blocks = {{{3, 5}, {0, 1}, {1, 2}, 2}};
  Lattice quarter = half;
  quarter.quarter_model = true;
  quarter.x.erase(quarter.x.begin(), quarter.x.begin() + 4);
  quarter.sponge_x = {0, 2};
  quarter.blocks = {{{0, 1}, {0, 1}, {1, 2}, 2}};
  for (int component = 0; component < 3; ++component) {
    EngineBoundary boundary = make_layer(5);
    boundary.origin = {};
    auto all = make_engine<double>(whole, Damping::memory, boundary, 2);
    boundary.odd_y = component == 1;
    auto two = make_engine<double>(half, Damping::memory, boundary, 2);
    boundary.odd_x = component == 0;
    auto one = make_engine<double>(quarter, Damping::memory, boundary, 2);
    for (auto* engine : {&all, &two, &one}) engine->set_time_step(time_step);
    for (int step = 0; step < 300; ++step) {
      const double force = step < 60 ? 1e3 * std::sin(M_PI * step / 60) : 0.0;
      const bool account = step == 299;
      // In the parts a node on a plane of symmetry counts once for each side.
      one.advance({{0, 0, force / 4, component}, {2, 3, force, component}}, account);
      two.advance({{16, 0, force / 2, component}, {14, 3, force, component}, {18, 3, force, component}},
                  account);
      all.advance({{16, 16, force, component},
                   {14, 19, force, component},
                   {18, 19, force, component},
                   {14, 13, force, component},
                   {18, 13, force, component}},
                  account);
    }
    double in_half = 0, in_quarter = 0, largest = 0;
    for (int c = 0; c < 3; ++c)
      for (int X = 0; X < all.nodes_x(); ++X)
        for (int Y = 16; Y < all.nodes_y(); ++Y)
          for (int Z = 0; Z < all.nodes_z(); ++Z) {
            const double expected = all.displacement(c, X, Y, Z);
            largest = std::max(largest, std::abs(expected));
            in_half = std::max(in_half, std::abs(two.displacement(c, X, Y - 16, Z) - expected));
            if (X >= 16)
              in_quarter = std::max(in_quarter, std::abs(one.displacement(c, X - 16, Y - 16, Z) - expected));
          }
    EXPECT_LT(in_half, 1e-12 * largest) << "force along " << component;  // rounding
    EXPECT_LT(in_quarter, 1e-12 * largest) << "force along " << component;
    EXPECT_NEAR(2 * two.kinetic_energy(), all.kinetic_energy(), 1e-11 * all.kinetic_energy());
    EXPECT_NEAR(4 * one.kinetic_energy(), all.kinetic_energy(), 1e-11 * all.kinetic_energy());
  }
}

SolverOptions layer_options() {
  SolverOptions options = test::small_options();
  options.boundary = AbsorbingBoundary::matched_layer;
  return options;
}

TEST(RunWithAMatchedLayer, CountsItsElementsAndStates) {
  SolverOptions options = layer_options();
  options.degree = 4;
  options.sponge_elements = -1;
  Site site = test::small_site();
  site.points_per_wavelength = 5.5;
  WaveSolver solver(site, test::small_loads(), options);
  const Lattice& lattice = solver.lattice();
  EXPECT_EQ(lattice.sponge_x, (std::array<int, 2>{4, 4}));
  EXPECT_EQ(lattice.sponge_y, (std::array<int, 2>{0, 4}));
  EXPECT_EQ(lattice.sponge_z, (std::array<int, 2>{3, 0}));  // three quarters
  const RunSummary summary = solver.compute_summary();
  EXPECT_EQ(summary.layer_elements,
            lattice.elements() - (lattice.nx() - 8) * (lattice.ny() - 4) * (lattice.nz() - 3));
  // At least 9 numbers at each of 125 points of an element.
  EXPECT_GT(summary.layer_memory, 9.0 * 125 * 4 * static_cast<double>(summary.layer_elements));
  EXPECT_GT(summary.memory, summary.layer_memory);
  EXPECT_GT(summary.checkpoint, summary.layer_memory);
}

TEST(RunWithAMatchedLayer, RefusesWhatReachesIntoItByName) {
  Site site = test::small_site();
  Block trench;
  trench.name = "trench";
  trench.y = {2.4, 2.9};
  trench.z = {-1, 0};
  trench.open = trench.mirrored = true;
  site.blocks = {trench};
  EXPECT_THAT([&] { WaveSolver(site, test::small_loads(), layer_options()); },
              testing::ThrowsMessage<ModelError>(
                  testing::AllOf(testing::HasSubstr("block 1 \"trench\": x = -inf..inf m"),
                                 testing::HasSubstr("--boundary sponge"))));
  site.blocks[0].x = {-1, 1};
  EXPECT_NO_THROW(WaveSolver(site, test::small_loads(), layer_options()));
}

TEST(RunWithAMatchedLayer, RefusesACrossoverAndNoElements) {
  SolverOptions options = layer_options();
  options.crossover_frequency = 10;
  EXPECT_THAT([&] { WaveSolver(test::small_site(), test::small_loads(), options); },
              testing::ThrowsMessage<ModelError>(testing::AllOf(
                  testing::HasSubstr("crossover_frequency = 10 Hz"), testing::HasSubstr("matched layer"))));
  options = layer_options();
  options.sponge_elements = 0;
  EXPECT_THAT([&] { WaveSolver(test::small_site(), test::small_loads(), options); },
              testing::ThrowsMessage<ModelError>(testing::HasSubstr("sponge_elements = 0")));
}

TEST(RunWithAMatchedLayer, RefusesGroundsInWhichItMayGrow) {
  Site site = test::small_site();
  site.layers.back().cp = site.layers.back().cs * std::sqrt((2 - 2 * 0.46) / (1 - 2 * 0.46));
  EXPECT_THAT([&] { WaveSolver(site, test::small_loads(), layer_options()); },
              testing::ThrowsMessage<ModelError>(testing::AllOf(testing::HasSubstr("Poisson ratio = 0.46"),
                                                                testing::HasSubstr("at most 0.45"))));
  site = test::small_site();
  Layer soft = site.layers.back();
  soft.thickness = 2;
  soft.cs = site.layers.back().cp / 4.1;
  soft.cp = 2 * soft.cs;
  site.layers = {soft, site.layers.back()};
  EXPECT_THAT([&] { WaveSolver(site, test::small_loads(), layer_options()); },
              testing::ThrowsMessage<ModelError>(testing::AllOf(
                  testing::HasSubstr("4.1 times the lowest c_s"), testing::HasSubstr("--boundary sponge"))));
}

}  // namespace
}  // namespace easydyn::soil
