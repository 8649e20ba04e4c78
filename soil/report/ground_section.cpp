#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "soil/report/receivers.hpp"
#include "soil/report/sections.hpp"
#include "soil/report/text.hpp"

namespace easydyn::soil::report {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using results::ResultReader;

constexpr Index most_curves = 6;

Receivers read_receivers(const ResultReader& ground) {
  std::vector<std::string> groups;
  if (ground.has("/receivers/groups")) groups = ground.read_names("/receivers/groups");
  return {ground.read_matrix("/receivers/position"), ground.read_names("/receivers/names"),
          std::move(groups)};
}

std::vector<Index> chosen(const Receivers& receivers) {
  std::vector<Index> out;
  for (const Index i : spread(Index(receivers.near.size()), most_curves))
    out.push_back(receivers.near[size_t(i)]);
  return out;
}

std::string remark_on_choice(const Receivers& receivers, size_t shown) {
  return Index(shown) < receivers.count() ? fmt::format(" {} of {} receivers.", shown, receivers.count())
                                          : "";
}

void add_velocities(visu::Report& report, const ResultReader& ground, const Receivers& receivers) {
  const VectorXd time = ground.read_vector("/time");
  const MatrixXd x = 1e3 * ground.read_matrix("/velocity/x"), y = 1e3 * ground.read_matrix("/velocity/y"),
                 z = 1e3 * ground.read_matrix("/velocity/z");
  report.add_subsection("Ground velocity at the receivers");
  std::vector<visu::Chart> charts;
  const auto shown = chosen(receivers);
  for (const Index i : shown)
    charts.push_back(
        {.title = fmt::format("Velocity at {}", receivers.label(i)),
         .x = {"time", "s"},
         .y = {"velocity", "mm/s"},
         .series = {{"z, vertical", time, z.col(i)},
                    {"x, along the track", time, x.col(i)},
                    {"y, across", time, y.col(i)}},
         .caption = fmt::format("At {}; the scales differ between receivers.", receivers.place(i)),
         .height = 230});
  report.add_charts(std::move(charts));
  const std::string remark = remark_on_choice(receivers, shown.size());
  if (!remark.empty()) report.add_paragraph("Shown are" + remark);
}

void add_spectra(visu::Report& report, const ResultReader& ground, const Receivers& receivers) {
  VectorXd centre = ground.read_vector("/third_octave/centre");
  MatrixXd rms = ground.read_matrix("/third_octave/rms");
  Index known = centre.size();  // bands above the highest frequency are left out
  while (known > 1 && rms.col(known - 1).array().isNaN().all()) --known;
  centre.conservativeResize(known);
  rms.conservativeResize(rms.rows(), known);
  report.add_subsection("One-third octave spectra");
  visu::Chart chart{.title = "Vertical velocity in one-third octave bands",
                    .x = third_octave_axis(),
                    .y = {"velocity level", "dB re 5·10\u207b\u2078 m/s"},
                    .series = {},
                    .height = 340};
  const auto shown = chosen(receivers);
  for (const Index i : shown)
    chart.series.push_back(
        {receivers.label(i), centre, rms.row(i).transpose().unaryExpr(&compute_level), visu::Stroke::steps});
  chart.caption = fmt::format(
      "Rms of v_z over the whole record in each band, as a level re 5·10\u207b\u2078 m/s. Bands that reach "
      "beyond {} Hz "
      "are not "
      "computed and left out.{}",
      visu::short_number_text(ground.read_number_attribute("highest_frequency")),
      remark_on_choice(receivers, shown.size()));
  report.add_chart(std::move(chart));
}

/// Peak particle velocity against distance, with the 10 dB within which a prediction can be believed.
void add_decay(visu::Report& report, const Receivers& receivers, const MatrixXd& ppv) {
  std::vector<Index> far;  // on the surface; on the axis there is no logarithm of the distance
  for (const Index i : receivers.near)
    if (receivers.distance(i) > 0 && receivers.position(i, 2) == 0 && ppv(i, 3) > 0) far.push_back(i);
  if (far.size() < 2) return;
  const MatrixXd values = 1e3 * ppv(far, Eigen::all);
  const VectorXd distance = receivers.distance(far);
  visu::Chart chart{.title = "Peak particle velocity against distance from the axis of the track",
                    .x = {"distance", "m", visu::Scale::logarithmic},
                    .y = {"PPV", "mm/s", visu::Scale::logarithmic},
                    .series = {},
                    .height = 340};
  const std::vector<const char*> names = {"x, along the track", "y, across", "z, vertical", "resultant"};
  for (const int c : {3, 2, 0, 1})
    if ((values.col(c).array() > 0).any())
      chart.series.push_back({names[size_t(c)], distance, values.col(c),
                              c == 3 ? visu::Stroke::line_and_points : visu::Stroke::points});
  const double factor = std::pow(10, 10.0 / 20);
  chart.bands = {{"resultant ± 10 dB", distance, values.col(3) / factor, values.col(3) * factor}};
  chart.caption =
      "Both axes logarithmic: a power law is a straight line. The grey band is ± 10 dB around the resultant, "
      "the "
      "accuracy that may be claimed for absolute levels.";
  report.add_subsection("Decay with distance").add_chart(std::move(chart));
}

/// Distance of each from the first [m] if they lie on a straight line, in order; else nothing.
VectorXd distances_along(const MatrixXd& position, const std::vector<Index>& members) {
  const Eigen::RowVector3d first = position.row(members.front()), span = position.row(members.back()) - first;
  VectorXd along(Index(members.size()));
  for (Index i = 0; i < along.size(); ++i) {
    const Eigen::RowVector3d from_first = position.row(members[size_t(i)]) - first;
    along(i) = from_first.dot(span) / span.norm();
    const double aside = (from_first - along(i) / span.norm() * span).norm();
    if (!(aside <= 1e-6 * span.norm()) || (i > 0 && !(along(i) > along(i - 1)))) return {};
  }
  return along;
}

/// The indicators along each line of receivers, as curves.
void add_lines(visu::Report& report, const ResultReader& ground, const Receivers& receivers,
               const MatrixXd& ppv) {
  const VectorXd kb = ground.read_vector("/indicators/kb_f_max");
  std::vector<visu::Chart> charts;
  std::string grids;
  for (const std::string& group : receivers.group_names()) {
    const std::vector<Index> members = receivers.members(group);
    if (members.size() < 3) continue;
    const VectorXd along = distances_along(receivers.position, members);
    if (along.size() == 0) {
      grids += fmt::format("{}\"{}\" ({} receivers)", grids.empty() ? "" : ", ", group, members.size());
      continue;
    }
    const auto end = [&](Index i) {
      return fmt::format("({}, {}, {})", visu::short_number_text(receivers.position(i, 0)),
                         visu::short_number_text(receivers.position(i, 1)),
                         visu::short_number_text(receivers.position(i, 2)));
    };
    const MatrixXd values = 1e3 * ppv(members, Eigen::all);
    visu::Chart chart{.title = fmt::format("Indicators along {}", group),
                      .x = {"distance along the line", "m"},
                      .y = {"PPV in mm/s, KB_Fmax", "1", visu::Scale::logarithmic},
                      .series = {},
                      .height = 300};
    const std::vector<const char*> names = {"PPV x", "PPV y", "PPV z", "PPV resultant"};
    for (const int c : {3, 2, 0, 1})
      if ((values.col(c).array() > 0).any()) chart.series.push_back({names[size_t(c)], along, values.col(c)});
    const VectorXd kb_along = kb(members);
    if ((kb_along.array() > 0).any()) chart.series.push_back({"KB_Fmax", along, kb_along});
    chart.caption = fmt::format("{} receivers from {} m to {} m.", members.size(), end(members.front()),
                                end(members.back()));
    charts.push_back(std::move(chart));
  }
  if (charts.empty() && grids.empty()) return;
  report.add_subsection("Lines and grids of receivers");
  if (!charts.empty()) report.add_charts(std::move(charts));
  if (!grids.empty()) report.add_paragraph("Not drawn, but in `vibrations.h5`: " + grids + ".");
}

void add_indicators(visu::Report& report, const ResultReader& ground, const Receivers& receivers,
                    const MatrixXd& ppv) {
  const VectorXd kb = ground.read_vector("/indicators/kb_f_max"), vdb = ground.read_vector("/indicators/vdb");
  const VectorXd centre = ground.read_vector("/third_octave/centre");
  const MatrixXd rms = ground.read_matrix("/third_octave/rms");
  const std::string highest = visu::short_number_text(ground.read_number_attribute("highest_frequency"));
  report.add_subsection("Indicators");
  visu::Table table{
      {"receiver", "distance [m]", "PPV x [mm/s]", "PPV y [mm/s]", "PPV z [mm/s]", "PPV resultant [mm/s]",
       "KB_Fmax", "VdB [dB]", "strongest band [Hz]"},
      {},
      fmt::format("Indicators of the ground vibration, band-limited to {} Hz with a roll-off above",
                  highest)};
  const std::string dash = "\u2013";  // no motion, or no band known
  for (const Index i : receivers.near) {
    Index strongest = 0;
    const double most =
        rms.row(i).unaryExpr([](double v) { return std::isnan(v) ? -1.0 : v; }).maxCoeff(&strongest);
    table.rows.push_back({receivers.label(i), visu::short_number_text(receivers.distance(i), 4),
                          number_text(1e3 * ppv(i, 0)), number_text(1e3 * ppv(i, 1)),
                          number_text(1e3 * ppv(i, 2)), number_text(1e3 * ppv(i, 3)), number_text(kb(i)),
                          std::isfinite(vdb(i)) ? fmt::format("{:.1f}", vdb(i)) : dash,
                          most > 0 ? number_text(centre(strongest)) : dash});
  }
  report.add_table(std::move(table));
  if (Index(receivers.near.size()) < receivers.count())
    report.add_paragraph(fmt::format(
        "Of lines and grids the table has the first and the last receiver only: {} of {} receivers.",
        receivers.near.size(), receivers.count()));
  report.add_paragraph(fmt::format(
      "{} An instrument of a wider band may show more or, for a peak, less. PPV: largest "
      "magnitude of each velocity component and of the vector. KB_Fmax: DIN 45669-1, of the vertical "
      "velocity, "
      "dimensionless. VdB: largest 1 s rms of the vertical velocity as a level re 10⁻⁶ in/s. Strongest band: "
      "one-third "
      "octave "
      "band with the highest rms of v_z.",
      band_text(ground.read_number_attribute("highest_frequency"))));
  report.add_note(
      "Assessment by DIN 4150-2 or a similar standard applies to rooms, not to the free field: coupling to a "
      "building and its floors changes levels by several dB either way. Predictions of absolute levels are "
      "no "
      "better than about 10 dB (Hunt & Hussein): a 15 % change of the soil's wave speed moves them by up to "
      "6 dB, "
      "a 5 m shift of the receiver by more than 5 dB. Compare variants; confirm limits by measurement.");
}

}  // namespace

void add_ground_section(visu::Report& report, const ResultReader& ground, const ResultReader* track) {
  const Receivers receivers = read_receivers(ground);
  report.add_section("Step 2: ground vibration");
  if (receivers.count() == 0) {
    report.add_paragraph("No receivers were given.");
    return;
  }
  const MatrixXd ppv = ground.read_matrix("/indicators/ppv");
  add_velocities(report, ground, receivers);
  add_spectra(report, ground, receivers);
  add_decay(report, receivers, ppv);
  add_lines(report, ground, receivers, ppv);
  add_indicators(report, ground, receivers, ppv);
  add_dispersion(report, ground, track);
}

std::vector<visu::KeyFigure> ground_key_figures(const ResultReader& ground) {
  const Receivers receivers = read_receivers(ground);
  if (receivers.count() == 0) return {};
  const MatrixXd ppv = ground.read_matrix("/indicators/ppv");
  const VectorXd kb = ground.read_vector("/indicators/kb_f_max");
  const std::string band =
      fmt::format("up to {} Hz", visu::short_number_text(ground.read_number_attribute("highest_frequency")));
  std::vector<visu::KeyFigure> figures;
  const auto add = [&](Index i) {
    figures.push_back({fmt::format("PPV at {}", receivers.label(i)), number_text(1e3 * ppv(i, 3)), "mm/s",
                       "resultant, " + band});
    figures.push_back(
        {fmt::format("KB_Fmax at {}", receivers.label(i)), number_text(kb(i)), "", "vertical, " + band});
  };
  add(receivers.near.front());
  if (receivers.count() > 1) add(receivers.near.back());
  return figures;
}

}  // namespace easydyn::soil::report
