// Boundaries of the ground model, compared on axisymmetric ground: the tables of docs/soil_boundary.md.
//
//   boundary_study                      what each boundary sends back, on three grounds
//   boundary_study stability [SECONDS]  a constant load, held (20 s)
//   boundary_study cost                 time per element and step

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <complex>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "bench/axisymmetric_ground.hpp"
#include "soil/frequency_filter.hpp"

namespace easydyn::soil {
namespace {

constexpr double pi = std::numbers::pi;
using Complex = std::complex<double>;

constexpr std::array<double, 7> frequencies{3, 5, 8, 10, 14, 20, 30};
constexpr std::array<double, 3> receivers{4, 8, 16};  // [m], the last one 3 m inside the edge
constexpr double margin = 3, large_margin = 180;      // [m]
constexpr double radius = 0.5773502691896258;   // [m] of a disc with the second moments of a square of 1 m
constexpr double begin = -0.4, duration = 1.6;  // [s]
constexpr double safety = 0.9;                  // time step / stable step

constexpr double low_resolution = 1.6;  // of a crossover (wave_solver.cpp)

struct Ground {
  std::string name;
  std::vector<Layer> layers;
};

struct Case {
  std::string name;
  int elements = 8;
  AxisymmetricBoundary boundary = {};
  double crossover = 0;  // [Hz]
};

Layer make_layer(double thickness, double cs, double nu) {
  Layer layer;
  layer.thickness = thickness;
  layer.density = 1800;
  layer.cs = cs;
  layer.cp = cs * std::sqrt((2 - 2 * nu) / (1 - 2 * nu));
  return layer;
}

std::vector<Ground> make_grounds() {
  return {
      {"cs 150 m/s, nu 1/3", {make_layer(0, 150, 1.0 / 3)}},
      {"5 m of cs 150 m/s on 300 m/s, nu 1/3", {make_layer(5, 150, 1.0 / 3), make_layer(0, 300, 1.0 / 3)}},
      {"cs 150 m/s, nu 0.45", {make_layer(0, 150, 0.45)}}};
}

/// `strength` of a perfectly matched layer is for the compression wave, that of a sponge for the shear wave.
Case make_case(const std::string& name, int elements, AbsorbingLayer layer, double strength, double alpha,
               FarField far_field = FarField::springs) {
  Case c{name, elements};
  c.boundary.layer = layer;
  c.boundary.strength = strength;
  c.boundary.alpha = alpha;
  c.boundary.far_field = far_field;
  return c;
}

std::vector<Case> make_cases() {
  using enum AbsorbingLayer;
  std::vector<Case> cases;
  cases.push_back(make_case("dashpots", 8, none, 0, 0, FarField::none));
  cases.push_back(make_case("dashpots, infinite elements", 8, none, 0, 0, FarField::infinite_elements));
  cases.push_back(make_case("sponge, infinite elements", 8, sponge, 12, 0, FarField::infinite_elements));
  for (const int n : {8, 16}) {
    cases.push_back(make_case("dashpots, springs", n, none, 0, 0));
    cases.push_back(make_case("sponge, dashpots, springs", n, sponge, 12, 0));
    cases.push_back(make_case("matched sponge", n, matched_sponge, 14, 6));
    cases.push_back(make_case("multiaxial PML, p 0.1", n, pml, 14, 6));
    cases.back().boundary.multiaxial = 0.1;
    cases.push_back(make_case("PML, strength 14, alpha 6", n, pml, 14, 6));
    cases.push_back(make_case("PML, strength 5, alpha 20", n, pml, 5, 20));
  }
  for (const int n : {3, 4, 5}) cases.push_back(make_case("PML, strength 5, alpha 20", n, pml, 5, 20));
  cases.push_back(make_case("PML, 5, alpha 20, loss 0.01", 4, pml, 5, 20));
  cases.back().boundary.loss = 0.01;
  for (const int f : {10, 15}) {
    cases.push_back(make_case("crossover " + std::to_string(f) + " Hz", 8, sponge, 12, 0));
    cases.back().crossover = f;
  }
  return cases;
}

AxisymmetricGround make_model(const Ground& ground, const Case& c, double distance,
                              double far_frequency = 0) {
  Site site;
  site.layers = ground.layers;
  for (const double r : receivers) site.receivers.push_back({"r", {r, 0, 0}});
  site.margin = distance;
  LatticeOptions options;
  options.quarter_model = true;
  options.lanes = 1;
  options.sponge_elements = c.elements;
  options.far_frequency = far_frequency;
  AxisymmetricBoundary boundary = c.boundary;
  const Layer& last = ground.layers.back();
  boundary.speed = boundary.layer == AbsorbingLayer::sponge ? last.cs : last.cp;
  return {make_lattice(site, {{0, 0, 1, 1}}, options), ground.layers, boundary, radius};
}

/// Force at even times from `begin` on.
struct Load {
  static constexpr double step = 2.5e-4;
  Eigen::VectorXd force;
  double operator()(double t) const {
    const double place = (t - begin) / step;
    const auto i = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(place), 0, force.size() - 2);
    return force(i) + (place - static_cast<double>(i)) * (force(i + 1) - force(i));
  }
};

/// Ricker pulse of 12 Hz.
Load make_pulse() {
  const auto count = static_cast<Eigen::Index>((duration - begin) / Load::step) + 2;
  Load load{Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const double a = std::pow(pi * 12 * (begin + static_cast<double>(i) * Load::step - 0.15), 2);
    load.force(i) = 1e4 * (1 - 2 * a) * std::exp(-a);
  }
  return load;
}

/// What the load holds below a crossover (wave_solver.cpp).
Load split_low(const Load& load, double crossover) {
  const auto share = [&](double f) -> Complex {
    const double place = f > 0 ? std::log(f / crossover) / std::log(std::numbers::sqrt2) : -1;
    return place <= -1 ? 1.0 : place >= 1 ? 0.0 : 0.5 * (1 - std::sin(pi / 2 * place));
  };
  return {apply_filter(load.force, Load::step, share, RecordEnds::mirrored)};
}

/// Spectra of v_r, v_z at the receivers.
using Spectra = std::array<std::array<std::array<Complex, 2>, frequencies.size()>, receivers.size()>;

void add_spectra(AxisymmetricGround& model, double dt, const Load& load, Spectra& spectra) {
  model.set_time_step(dt);
  const auto steps = static_cast<int>((duration - begin) / dt);
  for (int step = 0; step < steps; ++step) {
    const double t = begin + step * dt;
    model.advance(load(t));
    for (std::size_t r = 0; r < receivers.size(); ++r) {
      const auto v = model.velocity(receivers[r]);
      for (std::size_t f = 0; f < frequencies.size(); ++f) {
        const Complex phase = std::polar(1.0, -2 * pi * frequencies[f] * (t + 0.5 * dt));
        for (int c = 0; c < 2; ++c) spectra[r][f][c] += dt * v[c] * phase;
      }
    }
  }
}

/// |difference| / |motion| [dB] of both components.
double compute_level(const Spectra& spectra, const Spectra& expected, std::size_t r, std::size_t f) {
  double difference = 0, norm = 0;
  for (int c = 0; c < 2; ++c) {
    difference += std::norm(spectra[r][f][c] - expected[r][f][c]);
    norm += std::norm(expected[r][f][c]);
  }
  return 10 * std::log10(difference / norm);
}

void compare(const Ground& ground) {
  std::printf("\n%s: difference [dB] at\n%-28s  n      m", ground.name.c_str(), "");
  for (const double f : frequencies) std::printf(" %3.0f Hz", f);
  std::printf("   time step / that of the sponge\n");
  const Load pulse = make_pulse();
  const double dt = safety * make_model(ground, Case{}, margin).compute_stable_step();
  Case large;
  large.elements = 20;
  Spectra reference{};
  AxisymmetricGround large_model = make_model(ground, large, large_margin);
  add_spectra(large_model, dt, pulse, reference);
  for (const Case& c : make_cases()) {
    AxisymmetricGround model = make_model(ground, c, margin);
    const double own = safety * model.compute_stable_step();
    Spectra spectra{};
    Load load = pulse;
    if (c.crossover > 0) {
      const Load low_load = split_low(pulse, c.crossover);
      load.force -= low_load.force;
      AxisymmetricGround low = make_model(ground, c, margin, low_resolution * c.crossover);
      add_spectra(low, std::min(dt, safety * low.compute_stable_step()), low_load, spectra);
    }
    add_spectra(model, std::min(own, dt), load, spectra);
    for (std::size_t r = 0; r < receivers.size(); ++r) {
      std::printf("%-28s %2d %6.0f", r == 0 ? c.name.c_str() : "", c.elements, receivers[r]);
      for (std::size_t f = 0; f < frequencies.size(); ++f)
        std::printf(" %6.1f", compute_level(spectra, reference, r, f));
      if (r == 0) std::printf("   %.2f", own / dt);
      std::printf("\n");
    }
    std::fflush(stdout);
  }
}

/// A constant load: deflection at the last receiver, and the largest velocity of all nodes, which must vanish.
void hold(const Ground& ground, double seconds) {
  std::printf("\n%s: load of 10 kN held; u_z at %g m [m], largest velocity [m/s]\n", ground.name.c_str(),
              receivers.back());
  std::vector<Case> cases{make_case("sponge, dashpots, springs", 8, AbsorbingLayer::sponge, 12, 0)};
  const auto add = [&](int n, double strength, double alpha) {
    cases.push_back(make_case(fmt::format("PML, strength {}, alpha {}", strength, alpha), n,
                              AbsorbingLayer::pml, strength, alpha));
  };
  add(8, 14, 6);
  add(4, 14, 6);
  add(4, 10, 20);
  add(8, 5, 20);
  add(4, 5, 20);
  for (const Case& c : cases) {
    AxisymmetricGround model = make_model(ground, c, margin);
    const double dt = safety * model.compute_stable_step();
    model.set_time_step(dt);
    std::printf("%-28s %2d", c.name.c_str(), c.elements);
    int quarter = 1;
    for (long step = 0; static_cast<double>(step) * dt < seconds; ++step) {
      const double t = static_cast<double>(step) * dt;
      model.advance(t < 0.2 ? 1e4 * std::pow(std::sin(pi / 2 * t / 0.2), 2) : 1e4);
      if (t + dt < quarter * seconds / 4) continue;
      std::printf("  %3.0f s %10.3e %8.1e", quarter * seconds / 4, model.displacement(receivers.back())[1],
                  model.largest_velocity());
      std::fflush(stdout);
      ++quarter;
    }
    std::printf("\n");
  }
}

/// Time of a step per element of the layer, over that of a plain element.
void measure_cost(const Ground& ground) {
  const auto measure = [&](const Case& c) {
    AxisymmetricGround model = make_model(ground, c, margin);
    model.set_time_step(safety * model.compute_stable_step());
    double best = std::numeric_limits<double>::infinity();
    for (int repeat = 0; repeat < 15; ++repeat) {
      const auto start = std::chrono::steady_clock::now();
      for (int step = 0; step < 100; ++step) model.advance(1);
      best = std::min(best,
                      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / 100);
    }
    return std::pair{best, model};
  };
  const Case plain = make_case("plain", 8, AbsorbingLayer::none, 0, 0);
  const auto [plain_time, plain_model] = measure(plain);
  const double element = plain_time / static_cast<double>(plain_model.elements());
  std::printf("plain element: %.3g us per step\n", 1e6 * element);
  for (const auto layer : {AbsorbingLayer::sponge, AbsorbingLayer::matched_sponge, AbsorbingLayer::pml}) {
    const auto [time, model] = measure(make_case("", 8, layer, 5, 20));
    std::printf("%s: %.2f x\n",
                layer == AbsorbingLayer::sponge           ? "sponge"
                : layer == AbsorbingLayer::matched_sponge ? "matched sponge"
                                                          : "PML",
                1 + (time - plain_time) / element / static_cast<double>(model.layer_elements()));
  }
}

}  // namespace
}  // namespace easydyn::soil

int main(int argc, char** argv) {
  using namespace easydyn::soil;
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "cost") {
    measure_cost(make_grounds().front());
  } else if (what == "stability") {
    auto grounds = make_grounds();
    grounds.push_back({"cs 150 m/s, nu 0.49", {make_layer(0, 150, 0.49)}});
    for (const Ground& ground : grounds) hold(ground, argc > 2 ? std::atof(argv[2]) : 20);
  } else if (what.empty()) {
    for (const Ground& ground : make_grounds()) compare(ground);
  } else {
    std::fprintf(stderr, "usage: boundary_study [stability [SECONDS] | cost]\n");
    return 2;
  }
  return 0;
}
