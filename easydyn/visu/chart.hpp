#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace easydyn::visu {

enum class Scale { linear, logarithmic };

/// How a series is drawn. `steps`: y holds over a band around each x, up to half way to its neighbours (on a
/// logarithmic axis the geometric mean): one-third octave spectra. `bars`: the same, filled.
enum class Stroke { line, dashed, points, line_and_points, steps, bars };

/// y over x; NaN in y is a gap.
struct Series {
  std::string name;
  Eigen::VectorXd x, y;
  Stroke stroke = Stroke::line;
  std::string colour = {};  ///< "#rrggbb"; empty: the next of the palette
};

/// The area between two curves, e.g. the envelope of many histories.
struct Band {
  std::string name;
  Eigen::VectorXd x, lower, upper;
  std::string colour = {};  ///< empty: grey
};

struct Axis {
  std::string label;  ///< e.g. "time"
  std::string unit;   ///< e.g. "s"; empty: a pure number
  Scale scale = Scale::linear;
  std::optional<double> min = {}, max = {};  ///< empty: from the data
  std::vector<double> ticks = {};            ///< where to put numbers; empty: chosen by the page
};

/// A diagram: axes with units, legend, zoom by dragging, read-out under the cursor.
struct Chart {
  std::string title;
  Axis x, y;
  std::vector<Series> series;
  std::vector<Band> bands = {};
  std::string caption = {};
  double height = 280;  ///< [px] on the screen
};

/// @throws ModelError naming chart and series: x and y of different length, x not ascending or not finite,
///         a logarithmic axis without a positive value, nothing to draw
void check(const Chart& chart);

/// Indices of at most about `max_points` samples which keep the look of a curve: of every slice of x, the
/// first sample, the smallest and the largest value; gaps (NaN) stay gaps. `y` may hold several curves
/// (columns) over the same x; the kept samples are then common to all.
std::vector<Eigen::Index> thinned_indices(const Eigen::VectorXd& x, const Eigen::MatrixXd& y, int max_points);

/// The chart as JSON for the viewer, each curve thinned to `max_points`. @throws ModelError as check()
std::string to_json(const Chart& chart, int max_points = 4000);

}  // namespace easydyn::visu
