#include "soil/report/comparison_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <tuple>

#include "easydyn/error.hpp"
#include "easydyn/visu/parameter_json.hpp"
#include "easydyn/visu/report.hpp"
#include "soil/report/comparison.hpp"
#include "soil/report/receivers.hpp"
#include "soil/report/text.hpp"
#include "soil/third_octave.hpp"
#include "soil/vibrations.hpp"

namespace easydyn::soil {

namespace {

namespace fs = std::filesystem;

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using report::Comparison;
using report::number_text;
using report::Places;
using report::Result;

constexpr Index most_curves = 6;
constexpr std::size_t most_open_rows = 30;
constexpr const char* dash = "\u2013";  // no motion, or not known

// In every figure a result keeps its colour; the palette of the page.
constexpr const char* colours[] = {"#4477aa", "#ee6677", "#228833", "#aa3377",
                                   "#ccbb44", "#66ccee", "#555555"};

std::string find_colour(std::size_t result) {
  return colours[result % std::size(colours)];
}

double compute_change(double value, double reference) {
  return value > 0 && reference > 0 ? 20 * std::log10(value / reference)
                                    : std::numeric_limits<double>::quiet_NaN();
}

/// [dB] to one decimal, always with its sign.
std::string change_text(double change) {
  if (!std::isfinite(change)) return dash;
  const double rounded = std::round(10 * change) / 10;
  return fmt::format("{}{:.1f}", rounded > 0 ? "+" : rounded < 0 ? "\u2212" : "", std::abs(rounded));
}

std::string level_text(double level) {
  return std::isfinite(level) ? number_text(std::round(10 * level) / 10, level < 99.95 ? 3 : 4) : dash;
}

std::string seconds_text(double t) {
  return visu::short_number_text(std::round(1e6 * t) / 1e6 + 0.0, 4);  // a sum of steps that should be 0 is
}

// -- The parts of the page

void add_results(visu::Report& page, const Comparison& c) {
  visu::Table table{{"result", "train and track", "ground", "highest frequency [Hz]", "record [s]",
                     "receivers", "written by"},
                    {},
                    "What is compared"};
  visu::Table origins{{"result", "folder", "command"}, {}, "Folders and commands", true};
  for (const Result& result : c.results()) {
    const Vibrations& v = result.vibrations;
    table.rows.push_back(
        {result.label, result.description.empty() ? dash : result.description,
         v.method.empty() ? dash : v.method, visu::short_number_text(v.highest_frequency),
         fmt::format("{} to {}", seconds_text(v.time(0)), seconds_text(v.time(v.time.size() - 1))),
         fmt::format("{}", v.receivers.size()), fmt::format("{}, {}", result.program, result.created)});
    origins.rows.push_back({result.label, "`" + result.folder.string() + "`", "`" + result.command + "`"});
  }
  page.add_table(std::move(table));
  page.add_table(std::move(origins));

  const Result& first = c.results().front();
  const auto differs = [&](auto value) {
    return std::any_of(c.results().begin(), c.results().end(), [&](const Result& result) {
      return std::abs(value(result) - value(first)) > 1e-3 * value(first);
    });
  };
  if (differs([](const Result& result) { return result.vibrations.highest_frequency; }))
    page.add_note(
        "The highest frequencies differ: PPV, KB_Fmax and VdB hold unlike bands, and their changes are not "
        "the effect of the variant alone. Spectra and insertion losses can be compared, in the bands of "
        "both.");
  if (differs([](const Result& result) { return result.duration(); }))
    page.add_note(fmt::format(
        "The records differ in length. Levels in one-third octave bands are all referred to the {} s of {}: "
        "equal levels mean equal energies of the passages.",
        seconds_text(first.duration()), first.label));
}

void add_key_figures(visu::Report& page, const Comparison& c) {
  const std::vector<Index>& near = c.places().receivers.near;
  std::vector<Index> ends = {near.front()};
  if (near.size() > 1) ends.push_back(near.back());
  std::vector<visu::KeyFigure> figures;
  for (std::size_t n = 1; n < std::min<std::size_t>(c.results().size(), 4); ++n)
    for (const Index place : ends) {
      const std::size_t first = c.places().reference(place);
      if (n == first || !c.places().has(place, n)) continue;
      const double ppv = c.indicators(place, n).ppv[3], reference = c.indicators(place, first).ppv[3];
      figures.push_back(
          {fmt::format("PPV at {}, {}", c.places().receivers.label(place), c.results()[n].label),
           change_text(compute_change(ppv, reference)), "dB",
           fmt::format("resultant, {} mm/s against {} mm/s of {}", number_text(1e3 * ppv),
                       number_text(1e3 * reference), c.results()[first].label)});
    }
  if (!figures.empty()) page.add_key_figures(std::move(figures));
}

/// Peak particle velocity against distance, one curve per result.
void add_decay(visu::Report& page, const Comparison& c) {
  const report::Receivers& receivers = c.places().receivers;
  visu::Chart chart{.title = "Peak particle velocity against distance from the axis of the track",
                    .x = {"distance", "m", visu::Scale::logarithmic},
                    .y = {"PPV, resultant", "mm/s", visu::Scale::logarithmic},
                    .series = {},
                    .caption = "At the receivers of the table that lie on the surface.",
                    .height = 320};
  for (std::size_t n = 0; n < c.results().size(); ++n) {
    std::vector<double> distance, ppv;
    for (const Index place : receivers.near) {
      if (!c.places().has(place, n) || receivers.position(place, 2) != 0) continue;
      const double value = c.indicators(place, n).ppv[3];
      if (!(receivers.distance(place) > 0 && value > 0)) continue;
      distance.push_back(receivers.distance(place));
      ppv.push_back(1e3 * value);
    }
    if (distance.empty() || distance.front() == distance.back()) continue;
    chart.series.push_back({c.results()[n].label, VectorXd::Map(distance.data(), Index(distance.size())),
                            VectorXd::Map(ppv.data(), Index(ppv.size())), visu::Stroke::line_and_points,
                            find_colour(n)});
  }
  if (chart.series.size() > 1) page.add_chart(std::move(chart));
}

void add_indicators(visu::Report& page, const Comparison& c) {
  const report::Receivers& receivers = c.places().receivers;
  page.add_section("Indicators");
  visu::Table changes{{"receiver", "result", "PPV z [mm/s]", "change [dB]", "PPV resultant [mm/s]",
                       "change [dB]", "KB_Fmax", "change [dB]", "VdB [dB]", "change [dB]"},
                      {},
                      "Indicators, and their change from the first result at the receiver"};
  visu::Table others{
      {"receiver", "distance [m]", "result", "PPV x [mm/s]", "PPV y [mm/s]", "strongest band [Hz]"},
      {},
      "Horizontal PPV and strongest one-third octave band",
      true};
  for (const Index place : receivers.near) {
    const std::size_t first = c.places().reference(place);
    const Indicators& r = c.indicators(place, first);
    for (std::size_t n = first; n < c.results().size(); ++n) {
      if (!c.places().has(place, n)) continue;
      const Indicators& i = c.indicators(place, n);
      const auto change = [&](double value, double reference) {
        return n == first ? "" : change_text(compute_change(value, reference));
      };
      changes.rows.push_back({n == first ? receivers.label(place) : "", c.results()[n].label,
                              number_text(1e3 * i.ppv[2]), change(i.ppv[2], r.ppv[2]),
                              number_text(1e3 * i.ppv[3]), change(i.ppv[3], r.ppv[3]),
                              number_text(i.kb_f_max), change(i.kb_f_max, r.kb_f_max), level_text(i.vdb),
                              n == first ? "" : change_text(i.vdb - r.vdb)});
      Index strongest = 0;
      const double most = i.third_octave_rms.unaryExpr([](double v) { return std::isnan(v) ? -1.0 : v; })
                              .maxCoeff(&strongest);
      others.rows.push_back({receivers.label(place), visu::short_number_text(receivers.distance(place), 4),
                             c.results()[n].label, number_text(1e3 * i.ppv[0]), number_text(1e3 * i.ppv[1]),
                             most > 0 ? number_text(third_octave_centres()(strongest)) : dash});
    }
  }
  page.add_table(std::move(changes));
  page.add_paragraph(
      "A change of \u22126 dB is half the value, +6 dB twice, +1 dB 12 % more. PPV: largest magnitude of "
      "the velocity component and of the vector. KB_Fmax: DIN 45669-1, of the vertical velocity, "
      "dimensionless. VdB: largest 1 s rms of the vertical velocity as a level re 10\u207b\u2076 in/s.");
  if (Index(receivers.near.size()) < receivers.count())
    page.add_paragraph(
        fmt::format("Of lines and grids, tables and figures have the first and the last common receiver "
                    "only: {} of {} common receivers.",
                    receivers.near.size(), receivers.count()));
  page.add_table(std::move(others));
  add_decay(page, c);
}

// The same bands in all figures, so that they can be compared by eye.
visu::Axis band_axis(const Comparison& c) {
  visu::Axis axis = report::third_octave_axis();
  const double half_a_band = std::pow(10, 0.05);
  axis.min = c.centres()(0) / half_a_band;
  axis.max = c.centres()(c.centres().size() - 1) * half_a_band;
  return axis;
}

bool is_known(const VectorXd& values) {
  return values.array().isFinite().any();
}

/// 0 dB is in the picture of every loss.
void show_zero(visu::Chart& chart) {
  bool has_gain = false, has_loss = false;
  for (const visu::Series& series : chart.series)
    for (const double loss : series.y) {
      has_loss = has_loss || loss > 0;
      has_gain = has_gain || loss < 0;
    }
  if (!has_gain) chart.y.min = has_loss ? 0 : -1;
  if (!has_loss) chart.y.max = has_gain ? 0 : 1;
}

/// One figure per result but the first: the loss at the receivers.
void add_insertion_losses(visu::Report& page, const Comparison& c) {
  const report::Receivers& receivers = c.places().receivers;
  page.add_section("Insertion loss");
  page.add_paragraph(
      fmt::format("Level of v_z of the first result minus that of the other, in one-third octave bands: "
                  "positive where the other is quieter. Bands in which one of them lies {:.0f} dB or more "
                  "below its strongest band are left out.",
                  report::weakest_level));
  std::vector<visu::Chart> charts;
  std::vector<visu::Table> tables;
  for (std::size_t n = 1; n < c.results().size(); ++n) {
    std::vector<Index> all;
    for (const Index place : receivers.near)
      if (c.places().has(place, 0) && c.places().has(place, n) && is_known(c.insertion_loss(place, n)))
        all.push_back(place);
    if (all.empty()) continue;
    const std::string title =
        fmt::format("Insertion loss, {} against {}", c.results()[n].label, c.results().front().label);
    visu::Chart chart{
        .title = title, .x = band_axis(c), .y = {"insertion loss", "dB"}, .series = {}, .height = 320};
    visu::Table table{{"band centre [Hz]"}, {}, title + " [dB]", true};
    for (const double centre : c.centres()) table.rows.push_back({visu::short_number_text(centre, 3)});
    const std::vector<Index> shown = report::spread(Index(all.size()), most_curves);
    for (const Index k : shown) {
      const Index place = all[size_t(k)];
      const VectorXd loss = c.insertion_loss(place, n);
      chart.series.push_back({receivers.label(place), c.centres(), loss, visu::Stroke::steps});
      table.header.push_back(receivers.label(place));
      for (Index b = 0; b < loss.size(); ++b) table.rows[size_t(b)].push_back(change_text(loss(b)));
    }
    if (shown.size() < all.size())
      chart.caption = fmt::format("{} of {} receivers.", shown.size(), all.size());
    show_zero(chart);
    charts.push_back(std::move(chart));
    tables.push_back(std::move(table));
  }
  if (charts.empty()) {
    page.add_paragraph("The first result shares no receiver that moves with another one.");
    return;
  }
  page.add_charts(std::move(charts));
  for (visu::Table& table : tables) page.add_table(std::move(table));
}

void add_place(visu::Report& page, const Comparison& c, Index place) {
  const report::Receivers& receivers = c.places().receivers;
  const std::string label = receivers.label(place);
  page.add_subsection(label);
  visu::Chart history{.title = fmt::format("Vertical velocity at {}", label),
                      .x = {"time", "s"},
                      .y = {"velocity v_z", "mm/s"},
                      .series = {},
                      .caption = fmt::format("At {}.", receivers.place(place)),
                      .height = 260};
  visu::Chart spectra{.title = fmt::format("One-third octave spectra of v_z at {}", label),
                      .x = band_axis(c),
                      .y = {"velocity level", "dB re 5\u00b710\u207b\u2078 m/s"},
                      .series = {},
                      .height = 280};
  visu::Chart losses{.title = fmt::format("Insertion loss at {}", label),
                     .x = band_axis(c),
                     .y = {"insertion loss", "dB"},
                     .series = {},
                     .height = 280};
  const std::size_t first = c.places().reference(place);
  losses.caption = fmt::format("Against {}{}.", c.results()[first].label,
                               first > 0 ? ", the first result with this receiver" : "");
  for (std::size_t n = first; n < c.results().size(); ++n) {
    if (!c.places().has(place, n)) continue;
    const Result& result = c.results()[n];
    history.series.push_back({result.label, result.vibrations.time, c.velocity(place, n),
                              n == first ? visu::Stroke::line : visu::Stroke::dashed, find_colour(n)});
    if (const VectorXd levels = c.levels(place, n); is_known(levels))
      spectra.series.push_back({result.label, c.centres(), levels, visu::Stroke::steps, find_colour(n)});
    if (n == first) continue;
    if (const VectorXd loss = c.insertion_loss(place, n); is_known(loss))
      losses.series.push_back({result.label, c.centres(), loss, visu::Stroke::steps, find_colour(n)});
  }
  show_zero(losses);
  page.add_chart(std::move(history));
  std::vector<visu::Chart> bands;
  for (visu::Chart* chart : {&spectra, &losses})
    if (!chart->series.empty()) bands.push_back(std::move(*chart));
  if (!bands.empty()) page.add_charts(std::move(bands));
}

/// Parameters of either step that are not the same in all results.
void add_differences(visu::Report& page, const Comparison& c) {
  using Name = std::tuple<std::string, std::string, std::string, int>;  // group, name, unit, how often before
  std::vector<Name> order;
  std::map<Name, std::vector<std::optional<double>>> values;
  for (std::size_t n = 0; n < c.results().size(); ++n) {
    for (const Parameter& p : c.results()[n].parameters) {
      Name name{p.group, p.name, p.unit, 0};
      while (values.contains(name) && values.at(name)[n]) ++std::get<3>(name);
      if (!values.contains(name)) order.push_back(name);
      auto& row = values.try_emplace(name, c.results().size()).first->second;
      row[n] = p.value;
    }
  }
  visu::Table model{{"part", "parameter", "unit"}, {}, "Parameters that differ"};
  for (const Result& result : c.results()) model.header.push_back(result.label);
  visu::Table numerics = model;
  numerics.caption = "Numerical settings that differ";
  numerics.is_folded = true;
  for (const Name& name : order) {
    const auto& row = values.at(name);
    if (std::all_of(row.begin(), row.end(), [&](const auto& value) { return value == row.front(); }))
      continue;
    const auto& [group, parameter, unit, before] = name;
    const bool is_numerical =
        group == "mesh" || group == "boundary" || group.starts_with("impulse responses");
    std::vector<std::string> cells = {group, parameter, unit == "1" ? "" : unit};
    for (const auto& value : row) cells.push_back(value ? visu::short_number_text(*value) : dash);
    (is_numerical ? numerics : model).rows.push_back(std::move(cells));
  }
  page.add_section("What differs between the runs");
  page.add_paragraph(
      model.rows.empty()
          ? "No parameter of train, track or ground differs in the files; loads of other programs are not "
            "in them."
          : "As `vibrations.h5` and, where it is there, `results.h5` hold them; a dash: not in that folder.");
  model.is_folded = model.rows.size() > most_open_rows;
  for (visu::Table* table : {&model, &numerics})
    if (!table->rows.empty()) page.add_table(std::move(*table));
}

void add_limits(visu::Report& page) {
  page.add_section("Limits");
  page.add_list(
      {"Differences between variants that were computed with the same model are more reliable than absolute "
       "levels, which are no better than about 10 dB. Differences between models (finite elements and "
       "semi-analytical) show the error of the models, not an effect of a measure.",
       "Histories are drawn over the time of each file; unlike trains or speeds pass a receiver at unlike "
       "times.",
       "The result is the free field: no building, no foundation of a building, no floors.",
       "The report of each folder (`soil report DIR`) has its parameters with their sources, its limits "
       "and, after --verify, its check against the semi-analytical solution."});
}

}  // namespace

void write_comparison_report(const std::vector<fs::path>& folders, const fs::path& html) {
  if (folders.size() < 2)
    throw InputError(fmt::format("comparison: {} folder, must be at least 2", folders.size()));
  const std::vector<std::string> labels = report::make_labels(folders);
  std::vector<Result> results;
  for (std::size_t n = 0; n < folders.size(); ++n)
    results.push_back(report::read_result(folders[n], labels[n]));
  const Places places = report::find_common_places(results);
  const Comparison comparison(results, places);

  std::string names;
  for (const std::string& label : labels) names += (names.empty() ? "" : " \u00b7 ") + label;
  visu::Report page("Ground vibration: comparison of results", names);
  page.add_section("Results");
  add_key_figures(page, comparison);
  add_results(page, comparison);
  add_indicators(page, comparison);
  add_insertion_losses(page, comparison);
  page.add_section("Receivers");
  for (const Index place : places.receivers.near) add_place(page, comparison, place);
  add_differences(page, comparison);
  add_limits(page);
  page.write(html);
}

}  // namespace easydyn::soil
