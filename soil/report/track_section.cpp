#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "soil/report/sections.hpp"
#include "soil/report/text.hpp"

namespace easydyn::soil::report {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using results::ResultReader;

constexpr Index most_curves = 6;  // that a reader can tell apart in one chart

std::vector<std::string> names_at(const ResultReader& file, const std::string& dataset) {
  return file.has(dataset) ? file.read_names(dataset) : std::vector<std::string>{};
}

/// The tenth of a second about the largest contact force, of the wheelset that feels it.
void add_largest_impact(visu::Report& report, const MatrixXd& force, const std::vector<std::string>& names,
                        const VectorXd& time) {
  Index row = 0, wheelset = 0;
  if (force.maxCoeff(&row, &wheelset) < 1.2 * force(0, wheelset)) return;  // smooth: nothing to look into
  const double before = 0.02, length = 0.1;
  std::vector<Index> rows;
  for (Index i = 0; i < time.size(); ++i)
    if (time(i) >= time(row) - before && time(i) <= time(row) - before + length) rows.push_back(i);
  report.add_chart({.title = fmt::format("The largest impact: {}", name_of(names, wheelset, "wheelset")),
                    .x = {"time", "s"},
                    .y = {"contact force", "kN"},
                    .series = {{name_of(names, wheelset, "wheelset"), time(rows), force(rows, wheelset)}},
                    .caption = "The same force in detail."});
}

void add_contact_forces(visu::Report& report, const ResultReader& track, const VectorXd& time) {
  if (!track.has("/contact/force")) return;
  const MatrixXd force = 1e-3 * track.read_matrix("/contact/force");
  const auto names = names_at(track, "/contact/names");
  report.add_subsection("Wheel/rail contact forces");

  // Impacts are shorter than the output step: the extremes are those of every time step, where the file has them.
  const bool has_extremes = track.has("/contact/largest") && track.has("/contact/smallest");
  const VectorXd largest = has_extremes ? VectorXd(1e-3 * track.read_vector("/contact/largest"))
                                        : VectorXd(force.colwise().maxCoeff().transpose());
  const VectorXd smallest = has_extremes ? VectorXd(1e-3 * track.read_vector("/contact/smallest"))
                                         : VectorXd(force.colwise().minCoeff().transpose());
  const std::string sampling = fmt::format(" Sampled every {} ms: peaks between the samples are not drawn{}.",
                                           visu::short_number_text(1e3 * (time(1) - time(0))),
                                           has_extremes ? "; the table has them" : "");

  visu::Chart chart{.title = "Contact force of each wheelset, both rails together",
                    .x = {"time", "s"},
                    .y = {"contact force", "kN"},
                    .series = {}};
  for (const Index w : spread(force.cols(), most_curves))
    chart.series.push_back({name_of(names, w, "wheelset"), time, force.col(w)});
  if (force.cols() > most_curves) {
    chart.bands = {{"all wheelsets", time, force.rowwise().minCoeff(), force.rowwise().maxCoeff()}};
    chart.caption = fmt::format("{} of {} wheelsets; the grey band encloses all. Compression is positive.",
                                chart.series.size(), force.cols());
  } else {
    chart.caption = "Compression is positive; 0 means that the wheel has left the rail.";
  }
  chart.caption += sampling;
  report.add_chart(std::move(chart));
  add_largest_impact(report, force, names, time);

  visu::Table table{{"wheelset", "at the start [kN]", "smallest [kN]", "largest [kN]",
                     "standard deviation [kN]", "largest / start"},
                    {},
                    "Contact forces"};
  for (Index w = 0; w < force.cols(); ++w) {
    const auto f = force.col(w);
    const double deviation = std::sqrt((f.array() - f.mean()).square().mean());
    table.rows.push_back({name_of(names, w, "wheelset"), number_text(f(0)), number_text(smallest(w)),
                          number_text(largest(w)), number_text(deviation), number_text(largest(w) / f(0))});
  }
  report.add_table(std::move(table));
}

/// The sleeper that moves or bears most, of those in the middle half of the track.
Index busiest(const MatrixXd& histories) {
  const Index n = histories.cols(), skip = n / 4;
  Index best = 0;
  histories.middleCols(skip, n - 2 * skip).cwiseAbs().colwise().maxCoeff().maxCoeff(&best);
  return skip + best;
}

void add_deflections(visu::Report& report, const ResultReader& track, const VectorXd& time,
                     const VectorXd& sleepers) {
  if (!track.has("/rail/deflection")) return;
  const MatrixXd rail = 1e3 * track.read_matrix("/rail/deflection");
  const Index at = busiest(rail);
  report.add_subsection("Deflections of the track");

  const std::string foundation = track.has("/foundation/kind")
                                     ? "foundation (" + track.read_text("/foundation/kind") + ")"
                                     : "foundation";
  const std::vector<std::pair<const char*, std::string>> parts = {{"/sleeper/displacement", "sleeper"},
                                                                  {"/foundation/displacement", foundation}};
  Index row = 0;
  rail.col(at).maxCoeff(&row);
  visu::Chart history{.title = fmt::format("At the sleeper at x = {} m, during the passage",
                                           visu::short_number_text(sleepers(at), 4)),
                      .x = {"time", "s"},
                      .y = {"displacement", "mm"},
                      .series = {{"rail", time, rail.col(at)}},
                      .caption =
                          "Downward is positive. Of the sleepers in the middle half of the track, the one "
                          "where the rail moves most."};
  visu::Chart shape{.title = fmt::format("Along the track at t = {} s", number_text(time(row), 4)),
                    .x = {"x", "m"},
                    .y = {"displacement", "mm"},
                    .series = {{"rail", sleepers, rail.row(row)}},
                    .caption = "Downward is positive; when the rail is lowest at that sleeper."};
  for (const auto& [dataset, name] : parts) {
    if (!track.has(dataset)) continue;
    const MatrixXd values = 1e3 * track.read_matrix(dataset);
    history.series.push_back({name, time, values.col(at)});
    shape.series.push_back({name, sleepers, values.row(row)});
  }
  report.add_charts({std::move(history), std::move(shape)});
}

void add_ballast_reactions(visu::Report& report, const ResultReader& track, const VectorXd& time,
                           const VectorXd& sleepers) {
  if (!track.has("/ballast/reaction")) return;
  const MatrixXd reaction = 1e-3 * track.read_matrix("/ballast/reaction");
  report.add_subsection("Ballast reactions: the load on the ground");
  report.add_paragraph(
      "These forces act on the soil in step 2, one per sleeper, compression positive. They come from the "
      "wheel "
      "loads alone: the dead load of the track was in the ground before.");

  const Index n = reaction.cols(), middle = busiest(reaction);
  visu::Chart history{.title = "Ballast reaction of some sleepers",
                      .x = {"time", "s"},
                      .y = {"reaction", "kN"},
                      .series = {}};
  std::vector<Index> chosen = {std::max<Index>(0, middle - n / 5), middle, std::min(n - 1, middle + n / 5)};
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  for (const Index s : chosen)
    history.series.push_back(
        {fmt::format("x = {} m", visu::short_number_text(sleepers(s), 4)), time, reaction.col(s)});
  visu::Chart envelope{.title = "Largest and smallest reaction of every sleeper",
                       .x = {"x", "m"},
                       .y = {"reaction", "kN"},
                       .series = {{"largest", sleepers, reaction.colwise().maxCoeff()},
                                  {"smallest", sleepers, reaction.colwise().minCoeff()}},
                       .caption =
                           "Over the whole run. Differences along the track come from unevenness, defects "
                           "and where the run begins and ends."};
  report.add_charts({std::move(history), std::move(envelope)});
}

// The calmest bodies (those that carry people) and the most shaken ones (on the rail) need scales of their own.
void add_vehicle(visu::Report& report, const ResultReader& track, const VectorXd& time) {
  if (!track.has("/vehicle/acceleration")) return;
  const MatrixXd acceleration = track.read_matrix("/vehicle/acceleration");
  if (acceleration.cols() == 0) return;
  const auto names = names_at(track, "/vehicle/bodies");
  std::vector<Index> by_peak(static_cast<std::size_t>(acceleration.cols()));
  std::iota(by_peak.begin(), by_peak.end(), Index(0));
  const VectorXd peak = acceleration.cwiseAbs().colwise().maxCoeff().transpose();
  std::stable_sort(by_peak.begin(), by_peak.end(), [&](Index i, Index j) { return peak[i] < peak[j]; });

  const std::size_t curves = std::min<std::size_t>(3, by_peak.size());
  const auto chart_of = [&](const std::string& title, std::size_t first) {
    visu::Chart chart{.title = title, .x = {"time", "s"}, .y = {"acceleration", "m/s²"}, .series = {}};
    for (std::size_t i = first; i < first + curves; ++i)
      chart.series.push_back({name_of(names, by_peak[i], "body"), time, acceleration.col(by_peak[i])});
    return chart;
  };
  report.add_subsection("Vehicle");
  std::vector<visu::Chart> charts = {chart_of("Vertical acceleration, calmest bodies", 0)};
  if (by_peak.size() > curves)
    charts.push_back(chart_of("Vertical acceleration, most shaken bodies", by_peak.size() - curves));
  report.add_charts(std::move(charts));
}

void add_energies(visu::Report& report, const ResultReader& track, const VectorXd& time) {
  const std::vector<std::string> parts = {"kinetic", "potential", "dissipated", "supplied"};
  for (const std::string& part : parts)
    if (!track.has("/energy/" + part)) return;
  report.add_subsection("Energy balance");
  visu::Chart chart{.title = "Energies, as changes since the start",
                    .x = {"time", "s"},
                    .y = {"energy", "kJ"},
                    .series = {}};
  VectorXd imbalance = VectorXd::Zero(time.size());
  double largest = 0;
  for (const std::string& part : parts) {
    const VectorXd energy = 1e-3 * track.read_vector("/energy/" + part);
    const VectorXd change = energy.array() - energy(0);
    imbalance += part == "supplied" ? VectorXd(-change) : change;
    largest = std::max(largest, change.cwiseAbs().maxCoeff());
    chart.series.push_back({part, time, change});
  }
  chart.series.push_back(
      {"kinetic + potential + dissipated \u2212 supplied", time, imbalance, visu::Stroke::dashed, "#000000"});
  chart.caption = fmt::format(
      "The dashed sum is zero for an exact solution; here its largest value is {} kJ, {} % of the largest "
      "change.",
      number_text(imbalance.cwiseAbs().maxCoeff(), 2),
      number_text(largest > 0 ? 100 * imbalance.cwiseAbs().maxCoeff() / largest : 0, 2));
  report.add_chart(std::move(chart));
}

}  // namespace

void add_track_section(visu::Report& report, const ResultReader& track) {
  report.add_section("Step 1: vehicle and track");
  const VectorXd time = track.read_vector("/time");
  const VectorXd sleepers = track.has("/sleeper/x") ? track.read_vector("/sleeper/x") : VectorXd();
  add_contact_forces(report, track, time);
  if (sleepers.size() > 0) {
    add_deflections(report, track, time, sleepers);
    add_ballast_reactions(report, track, time, sleepers);
  }
  add_vehicle(report, track, time);
  add_energies(report, track, time);
}

}  // namespace easydyn::soil::report
