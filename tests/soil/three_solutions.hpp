#pragma once

// The tram's ground and sleepers, solved in three ways.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "soil/element_mobility.hpp"
#include "soil/layered/layered_prediction.hpp"
#include "soil/mobility_prediction.hpp"
#include "soil/prediction.hpp"
#include "soil/site_file.hpp"
#include "tests/soil/record_difference.hpp"

namespace easydyn::soil::test {

/// Two axles of 50 kN, 1.8 m apart, at `speed` over sleepers of 0.285 m x 2.5 m every 0.72 m (track/track_data.cpp), from
/// -loaded to loaded, and a blow at x = 0 when the first one is there: a Ricker pulse with energy to the highest frequency.
inline SurfaceLoads make_tram_loads(double loaded, double speed, double highest_frequency) {
  SurfaceLoads loads;
  const int half = static_cast<int>(loaded / 0.72);
  for (int j = -half; j <= half; ++j) loads.footprints.push_back({0.72 * j, 0, 0.285, 2.5});
  const double reach = 0.72 * half + 4, duration = (2 * reach + 1.8) / speed;
  const auto samples = static_cast<Eigen::Index>(duration * 20 * highest_frequency) + 1;
  loads.time = Eigen::VectorXd::LinSpaced(samples, -reach / speed, duration - reach / speed);
  loads.force.resize(samples, 2 * half + 1);
  for (Eigen::Index i = 0; i < samples; ++i) {
    const double t = loads.time(i), a = std::pow(std::numbers::pi * highest_frequency / 2.5 * t, 2);
    for (int j = -half; j <= half; ++j) {
      const double x = 0.72 * j;
      const auto bowl = [](double distance) {
        return std::exp(-distance * distance);
      };  // of the rail, 1 m wide
      loads.force(i, j + half) = 2e4 * (bowl(x - speed * t) + bowl(x - speed * t + 1.8)) +
                                 3e4 * (1 - 2 * a) * std::exp(-a) * bowl(x);
    }
  }
  return loads;
}

/// Largest differences over the receivers.
struct Differences {
  double elements_from_layered, direct_from_layered, elements_from_direct;
};

inline Differences solve_in_three_ways(const Site& site, const SurfaceLoads& loads) {
  const Vibrations layered =
      predict_vibrations(compute_mobility(site, loads.footprints, GroundDamping::maxwell_body), loads);
  ElementMobility responses(site, loads.footprints);
  const Vibrations elements = predict_vibrations(responses.compute(), loads);
  WaveSolver solver = make_solver(site, loads);
  const Vibrations direct = predict_vibrations(site, loads, solver, nullptr);
  const Eigen::VectorXd e = compute_record_difference(elements, layered),
                        d = compute_record_difference(direct, layered),
                        ed = compute_record_difference(elements, direct);
  for (Eigen::Index r = 0; r < e.size(); ++r) {
    std::printf("%s: elements, layered %.4f; direct, layered %.4f; elements, direct %.4f\n",
                site.receivers[static_cast<std::size_t>(r)].name.c_str(), e(r), d(r), ed(r));
  }
  return {e.maxCoeff(), d.maxCoeff(), ed.maxCoeff()};
}

}  // namespace easydyn::soil::test
