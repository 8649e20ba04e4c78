#include "examples/passage_program/site_of_run.hpp"

#include <fmt/format.h>

#include "soil/site_file.hpp"

namespace easydyn::examples {

SiteOfRun read_site_of_run(const std::filesystem::path& file, const PassageProgram& program,
                           const std::string& foundation) {
  SiteOfRun run{.file = file,
                .site = soil::read_site(file),
                .foundation = {},
                .rayleigh_speed = 0,
                .crossing = {},
                .response = {}};
  if (foundation != "rigid")
    run.foundation =
        track_on_soil::find_foundation(file, run.site, track_on_soil::footprints_of(program.track));
  run.rayleigh_speed = track_on_soil::compute_upper_rayleigh_speed(run.site);
  run.crossing = track_on_soil::find_mode_crossing(program.track, run.site);
  run.response = track_on_soil::compute_deflection_over_speed(program.track, run.site);
  return run;
}

PassageProgram place_on(const SiteOfRun& site, PassageProgram program) {
  if (site.foundation) {
    track::Clm clm = site.foundation->clm.fit.clm;
    for (Sourced* constant : {&clm.m_f, &clm.k_f, &clm.d_f, &clm.k_c, &clm.d_c})
      constant->source += "; " + site.foundation->origin;
    program.track.foundation = clm;
  }
  program.rayleigh_speed = site.rayleigh_speed;
  program.critical_speed = site.response.critical_speed.value_or(0);
  return program;
}

std::string describe(const SiteOfRun& site) {
  if (!site.foundation)
    return fmt::format("site {}: rigid ground, no foundation", site.file.filename().string());
  const track_on_soil::SiteClm& clm = site.foundation->clm;
  return fmt::format(
      "site {}: foundation {} ({}, {}, {:g}-{:g} Hz, rms error {:.0f} % of H_00, {:.0f} % of H_01)",
      site.file.filename().string(), site.foundation->origin, clm.method, clm.fit.system, clm.lowest,
      clm.highest, 100 * clm.fit.rms_00, 100 * clm.fit.rms_01);
}

std::vector<std::string> warn_of(const SiteOfRun& site) {
  if (site.site.blocks.empty()) return {};
  const std::string blocks =
      fmt::format("{} has {} block{} of other material, which ", site.file.filename().string(),
                  site.site.blocks.size(), site.site.blocks.size() == 1 ? "" : "s");
  if (site.foundation && !site.foundation->clm.knows_blocks())
    return {blocks + "foundation and critical speed do not know: they are those of the layers"};
  return {blocks + "the critical speed does not know: it is that of the layers"};
}

std::vector<Parameter> parameters_of(const SiteOfRun& site) {
  const std::string file = "C: layers of " + site.file.filename().string();
  std::vector<Parameter> table = {
      {"run", "Rayleigh speed of the upper layer", site.rayleigh_speed, "m/s", file}};
  if (site.response.critical_speed)
    table.push_back({"run", "critical speed of track and ground, coupled", *site.response.critical_speed,
                     "m/s", file + ", largest deflection under a moving load"});
  if (site.crossing) {
    table.push_back({"run", "speed at which the waves of track and ground cross", site.crossing->speed, "m/s",
                     file + ", fundamental Rayleigh mode and free bending wave of the track"});
    table.push_back({"run", "frequency at which they cross", site.crossing->frequency, "Hz", file});
  }
  return table;
}

}  // namespace easydyn::examples
