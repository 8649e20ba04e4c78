#include "easydyn/sim/recorder.hpp"

#include <fmt/format.h>

#include "easydyn/require.hpp"

namespace easydyn {

using Eigen::Index;
using Eigen::VectorXd;

Recorder::Recorder(System& system, double interval) : system_(system), interval_(interval) {
  require_positive("recorder", "interval", interval, "s");
  poses_.resize(system.bodies().size());
}

void Recorder::watch(std::string name, std::function<double(const State&)> value) {
  if (!states_.empty())
    throw ModelError(fmt::format("recorder: \"{}\" is to be watched from the start", name));
  watched_.push_back({std::move(name), std::move(value), {}});
}

const std::vector<double>& Recorder::watched(const std::string& name) const {
  for (const Watched& w : watched_)
    if (w.name == name) return w.history;
  throw ModelError(fmt::format("recorder: nothing named \"{}\" is watched", name));
}

void Recorder::operator()(const State& state) {
  const EnergyBalance now = system_.compute_energy(state);
  if (!states_.empty()) {
    const double h = state.t - last_time_;
    dissipated_ += 0.5 * h * (last_.dissipated + now.dissipated);
    supplied_ += 0.5 * h * (last_.supplied + now.supplied);
  }
  last_ = now;
  last_time_ = state.t;
  if (!states_.empty() && state.t < states_.back().t + interval_ * (1 - 1e-9)) return;

  states_.push_back(state);
  energies_.push_back({now.kinetic, now.potential, dissipated_, supplied_});
  for (Watched& w : watched_) w.history.push_back(w.value(state));
  std::size_t b = 0;
  for (const Body& body : system_.bodies())
    poses_[b++].push_back({body.position(), Eigen::Quaterniond(body.frame().rotation())});
}

VectorXd Recorder::time() const {
  VectorXd t(static_cast<Index>(states_.size()));
  for (Index i = 0; i < t.size(); ++i) t[i] = states_[static_cast<std::size_t>(i)].t;
  return t;
}

VectorXd Recorder::coordinate(int i) const {
  VectorXd q(static_cast<Index>(states_.size()));
  for (Index k = 0; k < q.size(); ++k) q[k] = states_[static_cast<std::size_t>(k)].q[i];
  return q;
}

VectorXd Recorder::total_energy() const {
  VectorXd total(static_cast<Index>(energies_.size()));
  for (Index k = 0; k < total.size(); ++k) {
    const EnergyBalance& e = energies_[static_cast<std::size_t>(k)];
    total[k] = e.kinetic + e.potential + e.dissipated - e.supplied;
  }
  return total;
}

visu::Chart Recorder::coordinate_chart(const std::string& unit) const {
  visu::Chart chart{.title = "Coordinates", .x = {"time", "s"}, .y = {"coordinate", unit}, .series = {}};
  for (int i = 0; i < system_.body_size(); ++i)
    chart.series.push_back({system_.coordinate_name(i), time(), coordinate(i)});
  return chart;
}

visu::Chart Recorder::energy_chart() const {
  const auto account = [this](double EnergyBalance::*member) {
    VectorXd values(static_cast<Index>(energies_.size()));
    for (Index k = 0; k < values.size(); ++k) values[k] = energies_[static_cast<std::size_t>(k)].*member;
    return values;
  };
  visu::Chart chart{.title = "Energy", .x = {"time", "s"}, .y = {"energy", "J"}, .series = {}};
  chart.series.push_back({"kinetic", time(), account(&EnergyBalance::kinetic)});
  // A potential energy counts from anywhere: from its start the others are seen beside it.
  VectorXd potential = account(&EnergyBalance::potential);
  const double start = potential.size() > 0 ? potential[0] : 0;
  potential.array() -= start;
  chart.series.push_back({"potential, from its start", time(), potential});
  const VectorXd dissipated = account(&EnergyBalance::dissipated),
                 supplied = account(&EnergyBalance::supplied);
  const double rounding = 1e-12 * (chart.series[0].y.cwiseAbs() + chart.series[1].y.cwiseAbs()).maxCoeff();
  if (dissipated.cwiseAbs().maxCoeff() > rounding) chart.series.push_back({"dissipated", time(), dissipated});
  if (supplied.cwiseAbs().maxCoeff() > rounding) chart.series.push_back({"supplied", time(), supplied});
  chart.series.push_back(
      {"balance (constant)", time(), total_energy().array() - start, visu::Stroke::dashed});
  return chart;
}

visu::Chart Recorder::watched_chart(const std::string& title, const std::string& label,
                                    const std::string& unit, const std::vector<std::string>& names) const {
  visu::Chart chart{.title = title, .x = {"time", "s"}, .y = {label, unit}, .series = {}};
  for (const std::string& name : names) {
    const std::vector<double>& history = watched(name);
    chart.series.push_back({name, time(), VectorXd::Map(history.data(), static_cast<Index>(history.size()))});
  }
  return chart;
}

visu::Scene Recorder::scene() const {
  visu::Scene scene;
  scene.name = system_.name();
  scene.time = time();
  std::size_t b = 0;
  for (const Body& body : system_.bodies()) scene.frames.push_back({body.name(), poses_[b++], std::nullopt});
  return scene;
}

}  // namespace easydyn
