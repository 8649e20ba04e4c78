#include "track/track_data.hpp"

#include "easydyn/math/units.hpp"
#include "easydyn/require.hpp"

namespace easydyn::track {

using namespace easydyn::units;

BeamProperties rail_beam(const TrackData& data) {
  BeamProperties beam{data.rails * data.rail.bending_stiffness(), data.rails * data.rail.mass_per_length};
  if (data.theory == RailTheory::timoshenko) {
    beam.shear_stiffness = data.rails * data.rail.shear_stiffness();
    beam.rotary_inertia = data.rails * data.rail.rotary_inertia();
  }
  return beam;
}

void validate(const TrackData& data) {
  const std::string track = data.label();
  require(data.rails >= 1, track, "rails", data.rails, "", ">= 1");
  require_positive(track, "rail bending stiffness EI", data.rail.bending_stiffness(), "N m2");
  require_positive(track, "rail mass per length", data.rail.mass_per_length, "kg/m");
  if (data.theory == RailTheory::timoshenko) {
    require_positive(track, "rail area", data.rail.area, "m2");
    require_positive(track, "rail shear stiffness kappa G A", data.rail.shear_stiffness(), "N");
  }
  require_positive(track, "sleeper spacing", data.sleeper_spacing, "m");
  require_positive(track, "pad stiffness", data.pad_stiffness, "N/m");
  require_not_negative(track, "pad damping", data.pad_damping, "N s/m");
  if (data.slab)
    require_not_negative(track, "sleeper mass", data.sleeper_mass, "kg");
  else
    require_positive(track, "sleeper mass", data.sleeper_mass, "kg");
  require_positive(track, "ballast stiffness", data.ballast_stiffness, "N/m");
  require_not_negative(track, "ballast damping", data.ballast_damping, "N s/m");
  if (const auto& pads = data.under_sleeper_pads) {
    require_positive(track, "under-sleeper pad stiffness", pads->stiffness, "N/m");
    require_not_negative(track, "under-sleeper pad damping", pads->damping, "N s/m");
  }
  if (const auto& ballast = data.ballast_mass) {
    require_positive(track, "ballast mass", ballast->mass, "kg");
    require_positive(track, "stiffness below the ballast", ballast->base_stiffness, "N/m");
    require_not_negative(track, "damping below the ballast", ballast->base_damping, "N s/m");
    require_not_negative(track, "ballast shear stiffness", ballast->shear_stiffness, "N/m");
    require_not_negative(track, "ballast shear damping", ballast->shear_damping, "N s/m");
  }
  if (data.slab) {
    require_positive(track, "slab bending stiffness", data.slab->bending_stiffness, "N m2");
    require_positive(track, "slab mass per length", data.slab->mass_per_length, "kg/m");
  }
  validate(data.foundation, track);
  require_positive(track, "footprint length", data.footprint_length, "m");
  require_positive(track, "footprint width", data.footprint_width, "m");
  require(data.elements_per_bay >= 1, track, "elements per bay", data.elements_per_bay, "", ">= 1");
  require(data.ends.bays >= 0, track, "absorbing bays", data.ends.bays, "", ">= 0");
  require_not_negative(track, "absorbing alpha", data.ends.alpha, "1/s");
  require_not_negative(track, "absorbing beta", data.ends.beta, "s");
}

std::vector<Parameter> parameters(const TrackData& data) {
  const std::string track = data.label();
  const auto row = [&](const char* name, const Sourced& x, const char* unit) {
    return Parameter{track, name, x.value, unit, x.source};
  };
  const std::string rail = data.rail.name + ", " + data.rail.source, ours = "choice of discretisation";
  std::vector<Parameter> table = {
      {track, "rails", double(data.rails), "1", "both rails together"},
      {track, "rail bending stiffness, per rail", data.rail.bending_stiffness(), "N m2", rail},
      {track, "rail mass per length, per rail", data.rail.mass_per_length, "kg/m", rail},
      {track, "Timoshenko rail (1) or Euler-Bernoulli (0)", double(data.theory == RailTheory::timoshenko),
       "1", "choice of theory"},
      row("sleeper spacing", data.sleeper_spacing, "m"),
      row("pad stiffness", data.pad_stiffness, "N/m"),
      row("pad damping", data.pad_damping, "N s/m"),
      row("sleeper mass", data.sleeper_mass, "kg"),
      row("ballast stiffness", data.ballast_stiffness, "N/m"),
      row("ballast damping", data.ballast_damping, "N s/m"),
      row("footprint length", data.footprint_length, "m"),
      row("footprint width", data.footprint_width, "m"),
      {track, "elements per bay", double(data.elements_per_bay), "1", ours},
      {track, "absorbing bays at each end", double(data.ends.bays), "1", ours},
      {track, "absorbing alpha", data.ends.alpha, "1/s", ours},
      {track, "absorbing beta", data.ends.beta, "s", ours},
  };
  if (data.theory == RailTheory::timoshenko) {
    const std::string shear = data.rail.name + ", " + data.rail.shear_source;
    table.push_back(
        {track, "rail shear stiffness kappa G A, per rail", data.rail.shear_stiffness(), "N", shear});
    table.push_back({track, "rail shear factor", data.rail.shear_factor, "1", shear});
    table.push_back({track, "rail rotary inertia, per rail", data.rail.rotary_inertia(), "kg m", rail});
  }
  if (const auto& pads = data.under_sleeper_pads) {
    table.push_back(row("under-sleeper pad stiffness", pads->stiffness, "N/m"));
    table.push_back(row("under-sleeper pad damping", pads->damping, "N s/m"));
  }
  if (const auto& ballast = data.ballast_mass) {
    table.push_back(row("ballast mass", ballast->mass, "kg"));
    table.push_back(row("stiffness below the ballast", ballast->base_stiffness, "N/m"));
    table.push_back(row("damping below the ballast", ballast->base_damping, "N s/m"));
    table.push_back(row("ballast shear stiffness", ballast->shear_stiffness, "N/m"));
    table.push_back(row("ballast shear damping", ballast->shear_damping, "N s/m"));
  }
  if (data.slab) {
    table.push_back(row("slab bending stiffness", data.slab->bending_stiffness, "N m2"));
    table.push_back(row("slab mass per length", data.slab->mass_per_length, "kg/m"));
  }
  for (Parameter& p : parameters(data.foundation, track)) table.push_back(std::move(p));
  if (data.variation)
    table.push_back({track, "supports vary from sleeper to sleeper", 1, "1", data.variation_source});
  return table;
}

TrackData t2000_like_track() {
  const std::string tram = "M-l: Brussels tram class, per rail x 2";
  const std::string fit =
      "C: H_00 and H_01 of the infinite chain fitted on layered ground, Brussels tram class, spacing 0.72 m, "
      "2-50 Hz; rms error 13 %, 14 % of the static H_00";
  TrackData d;
  d.name = "t2000-like";
  d.rail = rail_section("50E2");
  d.sleeper_spacing = {0.72 * m, "M-l: Brussels tram class"};
  d.pad_stiffness = {2 * 90 * MN / m, tram};
  d.pad_damping = {2 * 30 * kN * s / m, tram};
  d.sleeper_mass = {2 * 90 * kg, tram};
  d.ballast_stiffness = {2 * 25 * MN / m, tram};
  d.ballast_damping = {2 * 40 * kN * s / m, tram};
  d.foundation = Clm{.m_f = {605 * kg, fit},
                     .k_f = {52.1 * MN / m, fit},
                     .d_f = {428 * kN * s / m, fit},
                     .k_c = {24.3 * MN / m, fit},
                     .d_c = {-93 * kN * s / m, fit}};
  d.footprint_length = {0.285 * m, "assumed: as a main-line monoblock sleeper"};
  d.footprint_width = {2.5 * m, "assumed: as a main-line monoblock sleeper"};
  return d;
}

TrackData thalys_like_track() {
  const std::string sleeper = "M-h: Brussels-Paris line at Ath, monoblock sleeper";
  const std::string fit =
      "C: H_00 and H_01 of the infinite chain fitted on the layered ground of Ath, spacing 0.6 m, 2-50 Hz; "
      "rms error 20 %, 20 % of the static H_00";
  TrackData d;
  d.name = "thalys-like";
  d.rail = rail_section("60E1");
  d.sleeper_spacing = {0.6 * m, sleeper};
  d.pad_stiffness = {2 * 100 * MN / m, "M-h: Brussels-Paris line at Ath, static, per rail x 2"};
  d.pad_damping = {2 * 15 * kN * s / m, "assumed, per rail x 2"};
  d.sleeper_mass = {300 * kg, sleeper};
  d.ballast_stiffness = {2 * 40 * MN / m, "F: railFE default, per rail x 2"};
  d.ballast_damping = {2 * 47 * kN * s / m, "F: railFE default, per rail x 2"};
  d.foundation = Clm{.m_f = {346 * kg, fit},
                     .k_f = {27.2 * MN / m, fit},
                     .d_f = {281 * kN * s / m, fit},
                     .k_c = {12.9 * MN / m, fit},
                     .d_c = {-53 * kN * s / m, fit}};
  d.footprint_length = {0.285 * m, sleeper};
  d.footprint_width = {2.5 * m, sleeper};
  return d;
}

TrackData zhai_2004_track() {
  const std::string zhai = "F: TTB-2D after Zhai et al. 2004, per rail x 2";
  const std::string recalled = "M-h: Zhai et al. 2004, per rail x 2";
  TrackData d;
  d.name = "Zhai 2004";
  d.rail = rail_section("CN60");
  d.sleeper_spacing = {0.6 * m, "F: TTB-2D after Zhai et al. 2004"};
  d.pad_stiffness = {2 * 65 * MN / m, zhai};
  d.pad_damping = {2 * 75 * kN * s / m, zhai};
  d.sleeper_mass = {2 * 125.5 * kg, zhai};
  d.ballast_stiffness = {2 * 137.75 * MN / m, zhai};
  d.ballast_damping = {2 * 58.8 * kN * s / m, zhai};
  d.ballast_mass = BallastMass{.mass = {2 * 531.4 * kg, zhai},
                               .base_stiffness = {2 * 77.5 * MN / m, recalled},
                               .base_damping = {2 * 31.15 * kN * s / m, recalled},
                               .shear_stiffness = {2 * 78.4 * MN / m, recalled},
                               .shear_damping = {2 * 80 * kN * s / m, recalled}};
  d.footprint_length = {0.285 * m, "assumed: as a main-line monoblock sleeper"};
  d.footprint_width = {2.5 * m, "assumed: as a main-line monoblock sleeper"};
  return d;
}

TrackData railfe_default_track() {
  const std::string railfe = "F: railFE default, per rail x 2";
  TrackData d;
  d.name = "railFE default";
  d.rail = rail_section("60E1");
  d.sleeper_spacing = {0.6 * m, "F: railFE default"};
  d.pad_stiffness = {2 * 200 * MN / m, railfe};
  d.pad_damping = {2 * 28 * kN * s / m, railfe};
  d.sleeper_mass = {2 * 140 * kg, "F: railFE default, B70, per rail x 2"};
  d.ballast_stiffness = {2 * 40 * MN / m, railfe};
  d.ballast_damping = {2 * 47 * kN * s / m, railfe};
  d.footprint_length = {0.285 * m, "assumed: as a main-line monoblock sleeper"};
  d.footprint_width = {2.5 * m, "assumed: as a main-line monoblock sleeper"};
  return d;
}

TrackData lincent_like_track() {
  const std::string lincent = "M-m: Lincent, taken for the whole track";
  TrackData d;
  d.name = "Lincent-like";
  d.rail = rail_section("60E1");
  d.sleeper_spacing = {0.6 * m, "M-m: Lincent"};
  d.pad_stiffness = {153.4 * MN / m, lincent};
  d.pad_damping = {13.5 * kN * s / m, lincent};
  d.sleeper_mass = {300 * kg, "M-m: Lincent"};
  d.ballast_stiffness = {920 * MN / m, lincent};
  d.ballast_damping = {16.5 * kN * s / m, lincent};
  d.footprint_length = {0.285 * m, "assumed: as a main-line monoblock sleeper"};
  d.footprint_width = {2.5 * m, "assumed: as a main-line monoblock sleeper"};
  return d;
}

}  // namespace easydyn::track
