#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

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
  const Eigen::Vector2d ends(frequency[begin], crossing->frequency);
  chart.series.push_back({fmt::format("crossing at {} m/s", number_text(crossing->speed, 3)), ends,
                          Eigen::Vector2d::Constant(crossing->speed), visu::Stroke::dashed, "#aa3377"});
  return fmt::format(
      " The bending wave of the track, without the ground below it, is as fast as the fundamental mode at {} "
      "m/s ({} km/h) and {} Hz: a quick estimate of the critical speed.",
      number_text(crossing->speed, 4), number_text(3.6 * crossing->speed, 3),
      number_text(crossing->frequency, 3));
}

double interpolate_linearly(const VectorXd& x, const VectorXd& y, double at) {
  Eigen::Index i = 1;
  while (i + 1 < x.size() && x[i] < at) ++i;
  return y[i - 1] + (y[i] - y[i - 1]) * (at - x[i - 1]) / (x[i] - x[i - 1]);
}

// Of the first contact, over the whole record [m/s]; nothing if the file does not hold it.
std::optional<double> read_train_speed(const results::ResultReader& track) {
  if (!track.has("/contact/position") || !track.has("/time")) return {};
  const VectorXd time = track.read_vector("/time");
  const Eigen::MatrixXd position = track.read_matrix("/contact/position");
  if (time.size() < 2 || position.rows() != time.size() || position.cols() == 0) return {};
  return std::abs(position(time.size() - 1, 0) - position(0, 0)) / (time[time.size() - 1] - time[0]);
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
  chart.caption =
      "Constant load on rail, pads, sleepers and ballast on the layers themselves, relative to a slow load.";
  if (track.has("/moving_load/critical_speed"))
    chart.caption += fmt::format(
        " The critical speed of the track on this ground is where the deflection is largest: {} km/h, {} "
        "times "
        "that of a slow load.",
        number_text(3.6 * track.read_vector("/moving_load/critical_speed")[0], 3),
        number_text(deflection.maxCoeff() / deflection[0], 3));
  const std::optional<double> train = read_train_speed(track);
  if (train && 3.6 * *train >= speed[0] && 3.6 * *train <= speed[speed.size() - 1]) {
    const double at = interpolate_linearly(speed, deflection, 3.6 * *train);
    chart.series.push_back({"this train", VectorXd::Constant(1, 3.6 * *train),
                            VectorXd::Constant(1, at / deflection[0]), visu::Stroke::points, "#ee6677"});
    chart.caption += fmt::format(" At the speed of this train, {} km/h, it is {} times.",
                                 number_text(3.6 * *train, 3), number_text(at / deflection[0], 3));
  }
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
  if (const auto train = track ? read_train_speed(*track) : std::nullopt)
    chart.series.push_back({fmt::format("this train, {} m/s", number_text(*train, 3)),
                            Eigen::Vector2d(site.highest_frequency / samples, site.highest_frequency),
                            Eigen::Vector2d::Constant(*train), visu::Stroke::line, "#999999"});
  report.add_subsection("Dispersion of the ground").add_chart(std::move(chart));
  if (track && track->has("/moving_load/speed")) report.add_chart(draw_moving_load(*track));
}

}  // namespace easydyn::soil::report
