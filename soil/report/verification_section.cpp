#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "soil/layered/layered_prediction.hpp"
#include "soil/mobility_identity.hpp"
#include "soil/report/sections.hpp"
#include "soil/report/text.hpp"

namespace easydyn::soil::report {

namespace {

std::string percent(double ratio) {
  return std::isfinite(ratio) ? number_text(100 * ratio, 2) : "\u2013";
}

}  // namespace

void add_verification_section(visu::Report& report, const results::ResultReader& ground) {
  if (!ground.has("/semi_analytical/time")) return;
  const Vibrations v = read_vibrations(ground.path());
  const SemiAnalyticalMotion& s = *v.semi_analytical;
  const std::vector<MotionDifference> differences = compare_with_semi_analytical(v);
  report.add_section("Check: finite elements against the semi-analytical solution");
  report.add_paragraph(
      "The same loads on the same layers, solved a second time without a mesh and without a boundary: a "
      "layered "
      "half-space in the frequency-wavenumber domain, with the same complex moduli, superposed over all "
      "footprints. "
      "What is different is the error of the finite elements: mesh, time step and, at low frequency above "
      "all, the "
      "boundary of the model.");
  visu::Table table{
      {"receiver", "PPV z, finite elements [mm/s]", "PPV z, semi-analytical [mm/s]", "L2 of v_x [%]",
       "L2 of v_y [%]", "L2 of v_z [%]", "L2 of v_z above 2 Hz [%]"},
      {},
      "Difference relative to the semi-analytical velocity of the same component, over the whole record"};
  for (const MotionDifference& d : differences) {
    table.rows.push_back({d.receiver, number_text(1e3 * d.ppv_z[0]), number_text(1e3 * d.ppv_z[1]),
                          percent(d.l2[0]), percent(d.l2[1]), percent(d.l2[2]), percent(d.dynamic_l2_z)});
  }
  report.add_table(std::move(table));
  std::vector<visu::Chart> charts;
  for (std::size_t r = 0; r < differences.size(); ++r) {
    const auto column = static_cast<Eigen::Index>(r);
    charts.push_back(
        {.title = fmt::format("Vertical velocity at {}", v.receivers[r].name),
         .x = {"time", "s"},
         .y = {"velocity", "mm/s"},
         .series = {{"finite elements", v.time, 1e3 * v.vz.col(column)},
                    {"semi-analytical", s.time, 1e3 * s.vz.col(column), visu::Stroke::dashed}},
         .caption = fmt::format("L2 difference {} %, above 2 Hz {} %.", percent(differences[r].l2[2]),
                                percent(differences[r].dynamic_l2_z)),
         .height = 230});
  }
  // The footprint that goes down most.
  Eigen::Index row = 0, most = 0;
  s.footprint_displacement.maxCoeff(&row, &most);
  std::string caption =
      "Mean over the footprint that goes down most. A model that ends is stiffer than the ground under a "
      "slow load.";
  const auto near = std::ranges::find(v.parameters, std::string(near_footprints_row), &Parameter::name);
  if (near != v.parameters.end())
    caption += fmt::format(
        " What loads nearer than {} m do to it, its own first of all, is semi-analytical in both curves.",
        visu::short_number_text(near->value, 3));
  charts.push_back(
      {.title = fmt::format("Footprint at x = {} m", visu::short_number_text(v.footprint_x(most), 4)),
       .x = {"time", "s"},
       .y = {"displacement, downward", "mm"},
       .series = {{"finite elements", v.time, 1e3 * v.footprint_displacement.col(most)},
                  {"semi-analytical", s.time, 1e3 * s.footprint_displacement.col(most),
                   visu::Stroke::dashed}},
       .caption = caption,
       .height = 230});
  report.add_charts(std::move(charts));
}

}  // namespace easydyn::soil::report
