#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "easydyn/visu/table_json.hpp"
#include "soil/report/sections.hpp"
#include "soil/report/text.hpp"

namespace easydyn::soil::report {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using results::ResultReader;

constexpr Index most_curves = 6;       // that a reader can tell apart in one chart
constexpr std::size_t most_rows = 12;  // of a table that is not folded

constexpr const char* none = "\u2013";

std::vector<std::string> names_at(const ResultReader& file, const std::string& dataset) {
  return file.has(dataset) ? file.read_names(dataset) : std::vector<std::string>{};
}

void add_vehicle(visu::Report& report, const ResultReader& track) {
  if (!track.has("/vehicle/drawing") && !track.has("/vehicle/tables")) return;
  report.add_subsection("Vehicle");
  if (track.has("/vehicle/drawing")) report.add_drawing(track.read_text("/vehicle/drawing"));
  if (!track.has("/vehicle/tables")) return;
  const std::string source = track.path().string() + ":/vehicle/tables";
  for (visu::Table& table : visu::tables_from_json(track.read_text("/vehicle/tables"), source)) {
    table.is_folded = table.rows.size() > most_rows;
    report.add_table(std::move(table));
  }
}

/// The indices of the largest of `values`, at most `count`, largest first.
std::vector<Index> largest_of(const VectorXd& values, Index count) {
  std::vector<Index> order(static_cast<std::size_t>(values.size()));
  std::iota(order.begin(), order.end(), Index(0));
  std::stable_sort(order.begin(), order.end(), [&](Index i, Index j) { return values[i] > values[j]; });
  order.resize(static_cast<std::size_t>(std::min(count, values.size())));
  return order;
}

/// What the wheels felt, over every time step where the file has that.
struct ContactExtremes {
  std::vector<std::string> names;
  bool has_static;                               ///< else the loads at the start stand for the static ones
  VectorXd load, largest, smallest, deviation;   ///< [kN]; load: static one
  VectorXd loss_count, loss_time, longest_loss;  ///< [1], [s], [s]; empty if the file has none

  Index count() const { return load.size(); }
  std::string load_name() const { return has_static ? "static" : "at the start"; }
  bool has_losses() const { return loss_count.size() > 0; }

  visu::Table table(const std::vector<Index>& wheelsets, const std::string& caption) const {
    visu::Table table{{"wheelset", load_name() + " [kN]", "smallest [kN]", "largest [kN]",
                       "standard deviation [kN]", "largest / " + load_name()},
                      {},
                      caption};
    if (has_losses())
      table.header.insert(table.header.end(), {"losses of contact", "longest [ms]", "in total [ms]"});
    for (const Index w : wheelsets) {
      std::vector<std::string> row = {name_of(names, w, "wheelset"), number_text(load(w)),
                                      number_text(smallest(w)),      number_text(largest(w)),
                                      number_text(deviation(w)),     number_text(largest(w) / load(w))};
      if (has_losses()) {
        const bool has_lost = loss_count(w) > 0;
        row.push_back(fmt::format("{:.0f}", loss_count(w)));
        row.push_back(has_lost ? number_text(1e3 * longest_loss(w)) : none);
        row.push_back(has_lost ? number_text(1e3 * loss_time(w)) : none);
      }
      table.rows.push_back(std::move(row));
    }
    return table;
  }
};

/// The tenth of a second about the largest contact force, of the wheelset that feels it.
void add_largest_force(visu::Report& report, const MatrixXd& force, const ContactExtremes& e,
                       const VectorXd& time) {
  Index row = 0, wheelset = 0;
  if (force.maxCoeff(&row, &wheelset) < 1.2 * e.load(wheelset)) return;  // smooth: nothing to look into
  const double before = 0.02, length = 0.1;
  std::vector<Index> rows;
  for (Index i = 0; i < time.size(); ++i)
    if (time(i) >= time(row) - before && time(i) <= time(row) - before + length) rows.push_back(i);
  const std::string name = name_of(e.names, wheelset, "wheelset");
  report.add_chart({.title = "The largest contact force: " + name,
                    .x = {"time", "s"},
                    .y = {"contact force", "kN"},
                    .series = {{name, time(rows), force(rows, wheelset)}},
                    .caption = "The same force in detail."});
}

ContactExtremes read_extremes(const ResultReader& track, const MatrixXd& force) {
  ContactExtremes e;
  e.names = names_at(track, "/contact/names");
  e.has_static = track.has("/contact/static");
  e.load = e.has_static ? VectorXd(1e-3 * track.read_vector("/contact/static"))
                        : VectorXd(force.row(0).transpose());
  e.deviation =
      (force.rowwise() - force.colwise().mean()).array().square().colwise().mean().sqrt().transpose();
  const bool has_extremes = track.has("/contact/largest") && track.has("/contact/smallest");
  e.largest = has_extremes ? VectorXd(1e-3 * track.read_vector("/contact/largest"))
                           : VectorXd(force.colwise().maxCoeff().transpose());
  e.smallest = has_extremes ? VectorXd(1e-3 * track.read_vector("/contact/smallest"))
                            : VectorXd(force.colwise().minCoeff().transpose());
  if (track.has("/contact/loss_count") && track.has("/contact/loss_time") &&
      track.has("/contact/longest_loss")) {
    e.loss_count = track.read_vector("/contact/loss_count");
    e.loss_time = track.read_vector("/contact/loss_time");
    e.longest_loss = track.read_vector("/contact/longest_loss");
  }
  return e;
}

std::string losses_text(const ContactExtremes& e) {
  if (!e.has_losses()) return "";
  const auto wheels = (e.loss_count.array() > 0).count();
  if (wheels == 0) return "No wheel left the rail.";
  Index worst = 0;
  const double longest = e.longest_loss.maxCoeff(&worst);
  return fmt::format("{} of {} wheelsets left the rail, {:.0f} times in all, longest {} ms ({}).", wheels,
                     e.count(), e.loss_count.sum(), number_text(1e3 * longest),
                     name_of(e.names, worst, "wheelset"));
}

/// Every wheelset of a long train at a glance, and the worst ones by name.
void add_long_train(visu::Report& report, const ContactExtremes& e, const std::vector<Index>& worst) {
  const VectorXd number = VectorXd::LinSpaced(e.count(), 1, static_cast<double>(e.count()));
  report.add_chart({.title = "Contact force along the train, both rails together",
                    .x = {"wheelset, in the order of the table", ""},
                    .y = {"contact force", "kN"},
                    .series = {{e.load_name(), number, e.load, visu::Stroke::line_and_points},
                               {"largest", number, e.largest, visu::Stroke::points},
                               {"smallest", number, e.smallest, visu::Stroke::points}},
                    .caption = "Extremes over the whole run."});
  report.add_table(e.table(worst, "The wheelsets with the largest dynamic load factor"));
  if (e.has_losses() && e.loss_time.maxCoeff() > 0) {
    std::vector<Index> lost = largest_of(e.loss_time, most_curves);
    std::erase_if(lost, [&](Index w) { return e.loss_count(w) == 0; });
    report.add_table(e.table(lost, "The wheelsets that were longest without contact"));
  }
}

void add_contact_forces(visu::Report& report, const ResultReader& track, const VectorXd& time) {
  if (!track.has("/contact/force")) return;
  const MatrixXd force = 1e-3 * track.read_matrix("/contact/force");
  const ContactExtremes e = read_extremes(track, force);
  report.add_subsection("Wheel/rail contact forces");
  if (e.has_losses()) report.add_paragraph(losses_text(e));

  // Impacts are shorter than the output step: the extremes are those of every time step, where the file has them.
  const std::string sampling = fmt::format(" Sampled every {} ms: peaks between the samples are not drawn{}.",
                                           visu::short_number_text(1e3 * (time(1) - time(0))),
                                           track.has("/contact/largest") ? "; the table has them" : "");
  const bool is_long = e.count() > most_curves;
  const std::vector<Index> worst = largest_of(e.largest.cwiseQuotient(e.load), most_curves);

  visu::Chart chart{.title = "Contact force of each wheelset, both rails together",
                    .x = {"time", "s"},
                    .y = {"contact force", "kN"},
                    .series = {}};
  if (is_long) {
    chart.title = "Contact forces over time, both rails together";
    chart.bands = {{"all wheelsets", time, force.rowwise().minCoeff(), force.rowwise().maxCoeff()}};
    for (const Index w : {worst[0], worst[1]})
      chart.series.push_back({name_of(e.names, w, "wheelset"), time, force.col(w)});
    chart.caption = fmt::format(
        "The grey band encloses all {} wheelsets; drawn are the two with the largest dynamic load factor. "
        "Compression is positive; 0 means that the wheel has left the rail.",
        e.count());
  } else {
    for (Index w = 0; w < e.count(); ++w)
      chart.series.push_back({name_of(e.names, w, "wheelset"), time, force.col(w)});
    chart.caption = "Compression is positive; 0 means that the wheel has left the rail.";
  }
  chart.caption += sampling;
  report.add_chart(std::move(chart));
  add_largest_force(report, force, e, time);

  if (is_long) add_long_train(report, e, worst);
  visu::Table all =
      e.table(spread(e.count(), e.count()), is_long ? "Contact forces of every wheelset" : "Contact forces");
  all.is_folded = all.rows.size() > most_rows;
  report.add_table(std::move(all));
}

/// The rail under the train, and what the wheelset with the largest dynamic load makes of it.
void add_profile(visu::Report& report, const ResultReader& track) {
  if (!track.has("/profile/x") || !track.has("/profile/height")) return;
  const VectorXd x = track.read_vector("/profile/x"), height = 1e3 * track.read_vector("/profile/height");
  const double mean = height.mean(), deviation = std::sqrt((height.array() - mean).square().mean());
  report.add_subsection("Rail profile");
  visu::Chart profile{.title = "Vertical profile of the unloaded rail",
                      .x = {"x", "m"},
                      .y = {"height", "mm"},
                      .series = {{"profile", x, height}},
                      .caption = fmt::format(
                          "Upward is positive: {}. From {} to {} mm, standard deviation {} mm.",
                          track.read_meaning("/profile/height").description, number_text(height.minCoeff()),
                          number_text(height.maxCoeff()), number_text(deviation))};
  if (!track.has("/contact/force") || !track.has("/contact/position")) {
    report.add_chart(std::move(profile));
    return;
  }
  const MatrixXd force = 1e-3 * track.read_matrix("/contact/force");
  const MatrixXd position = track.read_matrix("/contact/position");
  const ContactExtremes e = read_extremes(track, force);
  const Index w = largest_of(e.largest.cwiseQuotient(e.load), 1).front();
  std::vector<Index> rows;  // over the profile; a train that stands or turns back has no force over x
  for (Index i = 0; i < position.rows(); ++i)
    if (position(i, w) >= x(0) && position(i, w) <= x(x.size() - 1) &&
        (rows.empty() || position(i, w) > position(rows.back(), w)))
      rows.push_back(i);
  if (rows.size() < 2) {
    report.add_chart(std::move(profile));
    return;
  }
  const std::string name = name_of(e.names, w, "wheelset");
  const VectorXd place = position(rows, w), felt = force(rows, w);
  report.add_chart(std::move(profile));
  report.add_chart({.title = "Contact force where it acts: " + name,
                    .x = {"x", "m", visu::Scale::linear, x(0), x(x.size() - 1)},
                    .y = {"contact force", "kN"},
                    .series = {{name, place, felt}},
                    .caption = "The wheelset with the largest dynamic load factor, over the same rail."});
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
void add_accelerations(visu::Report& report, const ResultReader& track, const VectorXd& time) {
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
  report.add_subsection("Accelerations of the vehicle");
  std::vector<visu::Chart> charts = {chart_of("Vertical acceleration, calmest bodies", 0)};
  if (by_peak.size() > curves)
    charts.push_back(chart_of("Vertical acceleration, most shaken bodies", by_peak.size() - curves));
  report.add_charts(std::move(charts));

  visu::Table table{{"body", "largest [m/s²]", "rms [m/s²]"}, {}, "Vertical accelerations of every body"};
  for (Index b = 0; b < acceleration.cols(); ++b)
    table.rows.push_back({name_of(names, b, "body"), number_text(peak(b)),
                          number_text(std::sqrt(acceleration.col(b).array().square().mean()))});
  table.is_folded = table.rows.size() > most_rows;
  report.add_table(std::move(table));
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
  add_vehicle(report, track);
  add_profile(report, track);
  add_contact_forces(report, track, time);
  if (sleepers.size() > 0) {
    add_deflections(report, track, time, sleepers);
    add_ballast_reactions(report, track, time, sleepers);
  }
  add_accelerations(report, track, time);
  add_energies(report, track, time);
}

}  // namespace easydyn::soil::report
