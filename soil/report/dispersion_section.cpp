#include <fmt/format.h>

#include <algorithm>

#include "easydyn/error.hpp"
#include "soil/layered/rayleigh_modes.hpp"
#include "soil/report/sections.hpp"
#include "soil/report/text.hpp"
#include "soil/site_file.hpp"

namespace easydyn::soil::report {

void add_dispersion(visu::Report& report, const results::ResultReader& ground) {
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
  report.add_subsection("Dispersion of the ground").add_chart(std::move(chart));
}

}  // namespace easydyn::soil::report
