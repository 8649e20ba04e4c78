#include <fmt/format.h>

#include <algorithm>

#include "easydyn/error.hpp"
#include "soil/layered/rayleigh_modes.hpp"
#include "soil/report/sections.hpp"
#include "soil/report/text.hpp"
#include "soil/site_file.hpp"

namespace easydyn::soil::report {

namespace {

using Eigen::VectorXd;

// What lies within a band, with one sample more on either side.
void limit(const VectorXd& x, double first, double last, Eigen::Index& begin, Eigen::Index& count) {
  begin = 0;
  while (begin + 1 < x.size() && x[begin + 1] < first) ++begin;
  Eigen::Index end = begin;
  while (end < x.size() && x[end] <= last) ++end;
  count = end - begin;
}

// The wave of the track, and where it crosses the fundamental mode.
std::string add_track_wave(visu::Chart& chart, const LayeredGround& layers,
                           const results::ResultReader& track, double highest_frequency) {
  const VectorXd frequency = track.read_vector("/free_wave/frequency"),
                 speed = track.read_vector("/free_wave/phase_speed");
  Eigen::Index begin = 0, count = 0;
  limit(frequency, 0.2, highest_frequency, begin, count);
  if (count < 2) return {};
  chart.series.push_back({"track without ground", frequency.segment(begin, count),
                          speed.segment(begin, count), visu::Stroke::dashed, "#000000"});
  const auto crossing = find_crossing(layers, frequency, speed);
  if (!crossing)
    return " The bending wave of the track, without the ground below it, crosses none of the fundamental "
           "mode.";
  chart.series.push_back({"crossing", VectorXd::Constant(1, crossing->frequency),
                          VectorXd::Constant(1, crossing->speed), visu::Stroke::points, "#d55e00"});
  return fmt::format(
      " The bending wave of the track, without the ground below it, is as fast as the fundamental mode at {} "
      "m/s ({} km/h) and {} Hz: a quick estimate of the critical speed.",
      number_text(crossing->speed, 4), number_text(3.6 * crossing->speed, 3),
      number_text(crossing->frequency, 3));
}

// What a constant load does over its speed.
visu::Chart draw_moving_load(const results::ResultReader& track) {
  const VectorXd speed = 3.6 * track.read_vector("/moving_load/speed"),
                 deflection = track.read_vector("/moving_load/deflection");
  visu::Chart chart{
      .title = "Deflection of the rail under a moving load, track and ground together",
      .x = {"speed", "km/h"},
      .y = {"deflection / that of a slow load", ""},
      .series = {{"largest deflection", speed, deflection / deflection[0], visu::Stroke::line_and_points}},
      .height = 300};
  Eigen::Index top = 0;
  const double largest = deflection.maxCoeff(&top);
  chart.caption =
      top > 0 && top + 1 < speed.size()
          ? fmt::format(
                "Constant load on rail, pads, sleepers and ballast on the layers themselves. The critical "
                "speed is where it is largest: about {} km/h, {} times the deflection of a slow load.",
                number_text(speed[top], 3), number_text(largest / deflection[0], 3))
          : "Constant load on rail, pads, sleepers and ballast on the layers themselves.";
  return chart;
}

}  // namespace

void add_dispersion(visu::Report& report, const results::ResultReader& ground,
                    const results::ResultReader* track) {
  if (!ground.has("/site")) return;
  Site site;
  try {
    site = parse_site(ground.read_text("/site"), ground.path().string() + ":/site");
  } catch (const InputError&) {
    return;  // not a site file of this version: the page can do without
  }
  const LayeredGround layers(site, GroundDamping::none);
  constexpr int samples = 80;
  constexpr std::size_t most_modes = 5;
  std::vector<std::vector<double>> f(most_modes), c(most_modes);
  for (int i = 1; i <= samples; ++i) {
    const double frequency = site.highest_frequency * i / samples;
    const std::vector<double> speeds = compute_rayleigh_speeds(layers, frequency);
    for (std::size_t m = 0; m < std::min(most_modes, speeds.size()); ++m) {
      f[m].push_back(frequency);
      c[m].push_back(speeds[m]);
    }
  }
  visu::Chart chart{.title = "Phase speed of the ground's Rayleigh modes",
                    .x = {"frequency", "Hz"},
                    .y = {"phase speed", "m/s"},
                    .series = {},
                    .height = 300};
  for (std::size_t m = 0; m < most_modes; ++m) {
    if (f[m].size() < 2) continue;
    const auto n = static_cast<Eigen::Index>(f[m].size());
    chart.series.push_back({m == 0 ? "fundamental mode" : fmt::format("mode {}", m + 1),
                            Eigen::VectorXd::Map(f[m].data(), n), Eigen::VectorXd::Map(c[m].data(), n),
                            m == 0 ? visu::Stroke::line_and_points : visu::Stroke::points});
  }
  if (chart.series.empty()) return;
  chart.caption =
      "Of the elastic layers of the site file. A train faster than a mode radiates waves of it, as a boat "
      "does, at the "
      "frequencies where the mode is slower than the train.";
  if (track && track->has("/free_wave/frequency"))
    chart.caption += add_track_wave(chart, layers, *track, site.highest_frequency);
  report.add_subsection("Dispersion of the ground").add_chart(std::move(chart));
  if (track && track->has("/moving_load/speed")) report.add_chart(draw_moving_load(*track));
}

}  // namespace easydyn::soil::report
