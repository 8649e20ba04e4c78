#pragma once

// Private to soil/report: results that are compared, at the receivers that they have in common.

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "easydyn/parameter.hpp"
#include "soil/report/receivers.hpp"
#include "soil/vibrations.hpp"

namespace easydyn::soil::report {

/// Levels that lie farther below the strongest band [dB] are rounding and noise of a record.
inline constexpr double weakest_level = 60;

/// The files of one folder.
struct Result {
  std::string label;
  std::filesystem::path folder;
  std::string program, created, command, description;
  Vibrations vibrations;
  std::vector<Parameter> parameters;  // of step 1, if its file is there, and of the ground

  double step() const {
    const Eigen::VectorXd& t = vibrations.time;
    return (t(t.size() - 1) - t(0)) / static_cast<double>(t.size() - 1);
  }
  double duration() const { return step() * static_cast<double>(vibrations.time.size()); }  // [s]
};

/// @throws InputError if the folder has no vibrations.h5, or that no record
Result read_result(const std::filesystem::path& folder, const std::string& label);

/// What tells the folders apart: the last name of each, with as many of the names before it as needed.
/// @throws InputError if two are the same folder
std::vector<std::string> make_labels(const std::vector<std::filesystem::path>& folders);

/// Receivers that at least two results have.
struct Places {
  Receivers receivers;
  std::vector<std::vector<Eigen::Index>> column;  // of every place: its receiver in each result, -1: none

  /// The result that the others are compared with.
  std::size_t reference(Eigen::Index place) const {
    const std::vector<Eigen::Index>& c = column[size_t(place)];
    return size_t(std::find_if(c.begin(), c.end(), [](Eigen::Index i) { return i >= 0; }) - c.begin());
  }
  bool has(Eigen::Index place, std::size_t result) const { return column[size_t(place)][result] >= 0; }
};

/// Receivers at the same place within 1 mm, whatever their order or name.
/// @throws InputError if there is none
Places find_common_places(const std::vector<Result>& results);

/// The results at one place, against the first that has it.
class Comparison {
 public:
  Comparison(const std::vector<Result>& results, const Places& places);

  const std::vector<Result>& results() const { return results_; }
  const Places& places() const { return places_; }
  const Eigen::VectorXd& centres() const { return centres_; }  ///< of the bands that a result knows [Hz]

  const Indicators& indicators(Eigen::Index place, std::size_t result) const {
    return results_[result].vibrations.indicators[size_t(places_.column[size_t(place)][result])];
  }
  Eigen::VectorXd velocity(Eigen::Index place, std::size_t result) const {  ///< v_z [mm/s]
    return 1e3 * results_[result].vibrations.vz.col(places_.column[size_t(place)][result]);
  }
  /// Levels of v_z in the bands [dB], as if every record had the length of the first result's.
  Eigen::VectorXd levels(Eigen::Index place, std::size_t result) const;
  /// Positive where the result is quieter than the reference [dB]; NaN where one of them is not known or weak.
  Eigen::VectorXd insertion_loss(Eigen::Index place, std::size_t result) const;

 private:
  const std::vector<Result>& results_;
  const Places& places_;
  Eigen::VectorXd centres_;
};

}  // namespace easydyn::soil::report
