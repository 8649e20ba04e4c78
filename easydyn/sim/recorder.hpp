#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "easydyn/mbs/system.hpp"
#include "easydyn/visu/chart.hpp"
#include "easydyn/visu/scene.hpp"

namespace easydyn {

/// Watches a simulation: states, energies and poses of the bodies at about uniform times, for charts and for
/// an animated page.
///
///     Recorder recorder(system, 0.02);
///     integrator.advance(10, std::ref(recorder));
///     visu::Scene scene = recorder.scene();  // one frame per body, named after it; add what it looks like
class Recorder {
 public:
  /// @param interval  least time between two records [s], > 0
  /// @throws ModelError if the interval is not positive
  Recorder(System& system, double interval);

  /// Takes the state if its time has come. Powers are integrated over every state that is shown
  /// (trapezoidal).
  void operator()(const State& state);

  /// Records one more number with each state: anything that the system can tell after an evaluation.
  void watch(std::string name, std::function<double(const State&)> value);

  Eigen::VectorXd time() const;
  /// History of a watched number. @throws ModelError if there is none of this name
  const std::vector<double>& watched(const std::string& name) const;
  /// History of coordinate i.
  Eigen::VectorXd coordinate(int i) const;
  /// Energy that should stay constant: kinetic + potential + dissipated - supplied [J].
  Eigen::VectorXd total_energy() const;
  /// Energy supplied since the start [J].
  double supplied_energy() const { return supplied_; }

  visu::Chart coordinate_chart(const std::string& unit) const;
  visu::Chart energy_chart() const;
  /// Watched numbers over time, in one diagram. @throws ModelError if there is none of a name
  visu::Chart watched_chart(const std::string& title, const std::string& label, const std::string& unit,
                            const std::vector<std::string>& names) const;
  /// A scene with one moving frame per body; it has no items yet.
  visu::Scene scene() const;

 private:
  struct Watched {
    std::string name;
    std::function<double(const State&)> value;
    std::vector<double> history;
  };
  System& system_;
  double interval_;
  std::vector<Watched> watched_;
  std::vector<State> states_;
  std::vector<EnergyBalance> energies_;         // dissipated and supplied as energies since the start [J]
  std::vector<std::vector<visu::Pose>> poses_;  // [body][record]
  EnergyBalance last_;
  double last_time_ = 0, dissipated_ = 0, supplied_ = 0;
};

}  // namespace easydyn
