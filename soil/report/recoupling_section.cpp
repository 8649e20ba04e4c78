#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easydyn/error.hpp"
#include "soil/frequency_filter.hpp"
#include "soil/report/sections.hpp"
#include "soil/report/text.hpp"

namespace easydyn::soil::report {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using results::ResultReader;

std::string percent(double ratio) {
  return number_text(100 * ratio, 2);
}

// To the microsecond, so that a sum of steps that should be 0 is.
std::string time_text(double t) {
  return visu::short_number_text(std::round(1e6 * t) / 1e6 + 0.0);
}

}  // namespace

std::optional<Comparison> compare_displacements(const ResultReader& track, const ResultReader& ground) {
  for (const char* dataset : {"/foundation/displacement", "/sleeper/x"}) {
    if (!track.has(dataset)) return {};
  }
  for (const char* dataset : {"/footprint/displacement", "/footprint/x", "/footprint/taper"}) {
    if (!ground.has(dataset)) return {};
  }
  const VectorXd sleepers = track.read_vector("/sleeper/x"), footprints = ground.read_vector("/footprint/x");
  const MatrixXd foundation = track.read_matrix("/foundation/displacement");
  const MatrixXd soil = ground.read_matrix("/footprint/displacement");
  const VectorXd taper = ground.read_vector("/footprint/taper");

  // the footprint's sleeper is the one at the same x; loads of other sources follow those of the track
  std::vector<Index> of_track, of_soil;
  for (Index f = 0; f < footprints.size(); ++f) {
    Index nearest = 0;
    const double gap = (sleepers.array() - footprints(f)).abs().minCoeff(&nearest);
    if (gap < 0.01 && std::find(of_track.begin(), of_track.end(), nearest) == of_track.end()) {
      of_track.push_back(nearest);
      of_soil.push_back(f);
    }
  }
  if (of_soil.empty()) throw ModelError("recoupling error: no footprint lies under a sleeper");
  Comparison c{track.read_vector("/time"),
               ground.read_vector("/time"),
               footprints(of_soil),
               taper(of_soil),
               foundation(Eigen::all, of_track),
               soil(Eigen::all, of_soil),
               ground.read_number_attribute("highest_frequency"),
               {},
               {},
               {},
               {}};
  c.error =
      compute_recoupling_error(c.soil_time, c.soil, c.track_time, c.foundation, c.taper, c.highest_frequency);
  if (ground.has("/semi_analytical/footprint_displacement")) {
    c.semi_analytical_time = ground.read_vector("/semi_analytical/time");
    c.semi_analytical_soil =
        ground.read_matrix("/semi_analytical/footprint_displacement")(Eigen::all, of_soil);
    c.semi_analytical_error =
        compute_recoupling_error(c.semi_analytical_time, c.semi_analytical_soil, c.track_time, c.foundation,
                                 c.taper, c.highest_frequency);
  }
  return c;
}

visu::KeyFigure recoupling_key_figure(const Comparison& c) {
  return {"Recoupling error, above 2 Hz", percent(c.error.dynamic.l2), "%",
          "foundation of step 1 against soil of step 2"};
}

void add_recoupling_section(visu::Report& report, const Comparison& c) {
  report.add_section("Where both steps meet: the recoupling error");
  report.add_paragraph(
      "Step 1 replaces the soil by a foundation under every sleeper. If that foundation were perfect, its "
      "displacement u_f would be the displacement that its reactions cause in the soil of step 2. The "
      "difference is the accuracy of the foundation in this very run.");
  visu::Table table{
      {"part", "relative L2 [%]", "relative peak [%]"},
      {},
      fmt::format("Recoupling error over {} sleepers under their full load, from t = {} s to {} s",
                  c.error.footprints, time_text(c.error.from), time_text(c.error.to))};
  if (c.semi_analytical_error) {
    table.header.push_back("relative L2, semi-analytical soil [%]");
    table.header.push_back("relative peak, semi-analytical soil [%]");
  }
  const auto add_row = [&](const std::string& part, const RelativeDifference RecouplingError::*which) {
    std::vector<std::string> row = {part, percent((c.error.*which).l2), percent((c.error.*which).peak)};
    if (c.semi_analytical_error) {
      row.push_back(percent((*c.semi_analytical_error.*which).l2));
      row.push_back(percent((*c.semi_analytical_error.*which).peak));
    }
    table.rows.push_back(std::move(row));
  };
  add_row("whole signal", &RecouplingError::total);
  add_row("quasi-static, below 2 Hz", &RecouplingError::quasi_static);
  add_row("dynamic, above 2 Hz", &RecouplingError::dynamic);
  report.add_table(std::move(table));
  report.add_paragraph(
      std::string(
          "Relative to the displacement of the soil. The quasi-static part depends on how far away the soil "
          "model ends: a box of finite elements held by springs and dashpots stands for the ground beyond "
          "it only roughly. ") +
      (c.semi_analytical_error
           ? "The semi-analytical soil, a layered half-space under the same loads, does not end: of the "
             "quasi-static part, believe its figure. "
           : "") +
      "Downward is positive in the figures, and all curves end at the highest frequency of the soil model.");

  // four sleepers, evenly spread over those under their full load
  std::vector<Index> full;
  for (Index j = 0; j < c.taper.size(); ++j)
    if (c.taper(j) >= 1 - 1e-9) full.push_back(j);
  // what the table compares: both up to the highest frequency of the soil model
  const MatrixXd foundation =
      limit_band(c.foundation, c.track_time(1) - c.track_time(0), c.highest_frequency);
  std::vector<visu::Chart> charts;
  for (const Index k : spread(Index(full.size()) + 2, 6)) {  // the two ends drop out
    if (k == 0 || k == Index(full.size()) + 1 || charts.size() == 4) continue;
    const Index j = full[size_t(k - 1)];
    charts.push_back(
        {.title = fmt::format("Under the sleeper at x = {} m", visu::short_number_text(c.x(j), 4)),
         .x = {"time", "s"},
         .y = {"displacement", "mm"},
         .series = {{"soil, mean over the footprint (step 2)", c.soil_time, 1e3 * c.soil.col(j)},
                    {"foundation u_f (step 1)", c.track_time, 1e3 * foundation.col(j), visu::Stroke::dashed}},
         .height = 230});
    if (c.semi_analytical_error)
      charts.back().series.push_back(
          {"semi-analytical soil", c.semi_analytical_time, 1e3 * c.semi_analytical_soil.col(j)});
  }
  report.add_charts(std::move(charts));
}

}  // namespace easydyn::soil::report
