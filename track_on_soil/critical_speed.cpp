#include "track_on_soil/critical_speed.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "track/free_track_wave.hpp"
#include "track_on_soil/moving_load_response.hpp"

namespace easydyn::track_on_soil {
namespace {

double compute_rayleigh_speed(const soil::Site& site, const soil::Layer& layer) {
  soil::Site uniform = site;
  uniform.layers = {layer};
  return soil::compute_rayleigh_speeds(soil::LayeredGround(uniform, soil::GroundDamping::none), 10).front();
}

// Largest deflections at several speeds, added to those known.
void add_deflections(const track::TrackData& data, const soil::Site& site, const std::vector<double>& speeds,
                     int threads, std::map<double, double>& known) {
  const Eigen::VectorXd s = Eigen::VectorXd::LinSpaced(251, -20, 5);
  std::atomic<std::size_t> next = 0;
  std::mutex access;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t i = next++; i < speeds.size(); i = next++) {
      try {
        const double largest = compute_moving_load_response(data, site, speeds[i], s).maxCoeff();
        const std::scoped_lock lock(access);
        known[speeds[i]] = largest;
      } catch (...) {
        const std::scoped_lock lock(access);
        failure = std::current_exception();
      }
    }
  };
  if (threads == 0) threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::vector<std::jthread> team;  // joined also where one cannot be created
  for (int t = 1; t < threads; ++t) team.emplace_back(work);
  work();
  team.clear();
  if (failure) std::rethrow_exception(failure);
}

// Maximum of the parabola through three points.
double find_vertex(const double* x, const double* y) {
  const double left = (y[1] - y[0]) / (x[1] - x[0]), right = (y[2] - y[1]) / (x[2] - x[1]);
  const double curvature = (right - left) / (x[2] - x[0]);
  return curvature < 0 ? 0.5 * (x[0] + x[1]) - left / (2 * curvature) : x[1];
}

}  // namespace

std::optional<soil::ModeCrossing> find_mode_crossing(const track::TrackData& data, const soil::Site& site) {
  const track::FreeTrackWave wave = track::compute_free_track_wave(data);
  return soil::find_crossing(soil::LayeredGround(site, soil::GroundDamping::none), wave.frequency,
                             wave.phase_speed);
}

DeflectionOverSpeed compute_deflection_over_speed(const track::TrackData& data, const soil::Site& site,
                                                  int threads) {
  std::vector<double> waves;
  for (const soil::Layer& layer : site.layers) waves.push_back(compute_rayleigh_speed(site, layer));
  const double first = *std::ranges::min_element(waves) / 3, last = 1.15 * *std::ranges::max_element(waves);
  constexpr int coarse = 20;
  std::vector<double> speeds;
  for (int i = 0; i < coarse; ++i) speeds.push_back(first * std::pow(last / first, i / (coarse - 1.0)));
  std::map<double, double> known;
  add_deflections(data, site, speeds, threads, known);

  const auto by_deflection = [](const auto& a, const auto& b) { return a.second < b.second; };
  auto top = std::max_element(known.begin(), known.end(), by_deflection);
  DeflectionOverSpeed result;
  const bool is_inside = top != known.begin() && std::next(top) != known.end();
  if (is_inside) {
    const double a = std::prev(top)->first, b = top->first, c = std::next(top)->first;
    add_deflections(data, site, {(2 * a + b) / 3, (a + 2 * b) / 3, (2 * b + c) / 3, (b + 2 * c) / 3}, threads,
                    known);
    top = std::max_element(known.begin(), known.end(), by_deflection);
    const double x[] = {std::prev(top)->first, top->first, std::next(top)->first};
    const double y[] = {std::prev(top)->second, top->second, std::next(top)->second};
    result.critical_speed = find_vertex(x, y);
  }
  result.speed.resize(static_cast<Eigen::Index>(known.size()));
  result.deflection.resize(result.speed.size());
  Eigen::Index i = 0;
  for (const auto& [speed, deflection] : known) {
    result.speed[i] = speed;
    result.deflection[i++] = deflection;
  }
  return result;
}

double compute_upper_rayleigh_speed(const soil::Site& site) {
  return compute_rayleigh_speed(site, site.layers.front());
}

}  // namespace easydyn::track_on_soil
