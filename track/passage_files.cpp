#include "track/passage_files.hpp"

#include <fmt/format.h>

#include <cmath>

#include "easydyn/error.hpp"
#include "easydyn/require.hpp"
#include "easydyn/results/channels.hpp"
#include "easydyn/results/result_file.hpp"
#include "easydyn/visu/json.hpp"
#include "easydyn/visu/parameter_json.hpp"
#include "easydyn/visu/table_json.hpp"

namespace easydyn::track {

namespace {

namespace json = visu::json;

std::string to_json(const std::vector<SummaryFigure>& summary) {
  json::Value::Array list;
  for (const SummaryFigure& f : summary)
    list.push_back(json::object({{"name", f.name}, {"value", f.value}, {"unit", f.unit}}));
  return json::Value(std::move(list)).text();
}

void write_fit(results::ResultFile& file, const ClmFit& fit) {
  const std::string folder = "/foundation/fit/", phase = "time factor exp(i w t)";
  file.write_vector(folder + "frequency", fit.frequency, {"Hz", "frequencies of the fit", "scalar"});
  const auto write = [&](const char* name, const Eigen::VectorXcd& H, const char* meaning) {
    Eigen::MatrixXd parts(H.size(), 2);
    parts << H.real(), H.imag();
    file.write_matrix(folder + name, parts, {"m/N", std::string(meaning) + ": real, imaginary part", phase});
  };
  write("ground_00", fit.ground_00, "compliance of the ground under a footprint");
  write("ground_01", fit.ground_01, "compliance of the ground at the next footprint");
  write("model_00", fit.model_00, "compliance of the foundation under its force");
  write("model_01", fit.model_01, "compliance of the foundation at its neighbour");
  const json::Value::Array bounds(fit.bounds.begin(), fit.bounds.end());
  file.write_text(folder + "quality",
                  json::object({{"system", fit.system},
                                {"source", fit.clm.k_f.source},
                                {"rms_00", fit.rms_00},
                                {"rms_01", fit.rms_01},
                                {"stiffness_margin", fit.stiffness_margin},
                                {"damping_margin", fit.damping_margin},
                                {"mass", fit.clm.m_f.value},
                                {"left_out", fit.left_out},
                                {"bounds", json::Value(bounds)}})
                      .text(),
                  "JSON: how well the foundation follows the ground");
}

}  // namespace

ProfileSamples sample_profile(const Profile& profile, double wheel_radius, double first_x, double last_x,
                              double spacing) {
  const std::string object = "samples of a rail profile";
  require_finite(object, "first x", first_x, "m");
  require(std::isfinite(last_x) && last_x > first_x, object, "last x", last_x, "m",
          fmt::format("> {:g} m, the first x", first_x));
  require_positive(object, "spacing", spacing, "m");
  const auto n = static_cast<Eigen::Index>(std::ceil((last_x - first_x) / spacing - 1e-9)) + 1;
  ProfileSamples samples{Eigen::VectorXd::LinSpaced(n, first_x, last_x), Eigen::VectorXd(n), wheel_radius};
  for (Eigen::Index i = 0; i < n; ++i) samples.height[i] = profile.at(samples.x[i], wheel_radius).r;
  return samples;
}

void write_passage(const std::filesystem::path& path, const Passage& p, const PassageReport& report,
                   const results::Provenance& provenance) {
  const Eigen::VectorXd& loads = report.static_loads;
  if (loads.size() > 0 && loads.size() != static_cast<Eigen::Index>(p.contact_names.size()))
    throw ModelError(fmt::format("report of a passage: {} static loads for {} contacts", loads.size(),
                                 p.contact_names.size()));
  results::ResultFile file(path, provenance);
  file.write_vector("/time", p.time, {"s", "output time, uniform step", "time"});

  file.write_names("/contact/names", p.contact_names, "wheel/rail contacts");
  file.write_matrix("/contact/force", p.contact_force,
                    {"N", "wheel/rail contact force", "compression positive"});
  file.write_matrix("/contact/position", p.contact_position,
                    {"m", "position of the contact", "x along the track"});

  if (loads.size() > 0)
    file.write_vector("/contact/static", loads, {"N", "static load of each contact", "compression positive"});
  file.write_vector("/contact/largest", p.largest_contact_force,
                    {"N", "largest contact force, over every time step", "compression positive"});
  file.write_vector("/contact/smallest", p.smallest_contact_force,
                    {"N", "smallest contact force, over every time step", "compression positive"});

  file.write_vector("/contact/loss_count", p.contact_losses.cast<double>(),
                    {"1", "how often each wheel has left the rail", "count"});
  file.write_vector("/contact/loss_time", p.contact_loss_time,
                    {"s", "time without contact, over every time step", "sum"});
  file.write_vector("/contact/longest_loss", p.longest_contact_loss,
                    {"s", "longest time without contact, over every time step", "duration"});

  const std::string down = "downward";
  file.write_vector("/sleeper/x", p.sleeper_x,
                    {"m", "position of the recorded sleepers", "x along the track"});
  file.write_matrix("/rail/deflection", p.rail_deflection, {"m", "rail above each sleeper", down});
  file.write_matrix("/sleeper/displacement", p.sleeper_displacement, {"m", "sleeper", down});
  if (p.foundation_displacement.size() > 0)
    file.write_matrix("/foundation/displacement", p.foundation_displacement,
                      {"m", "foundation u_f below each sleeper", down});
  file.write_matrix("/ballast/reaction", p.ballast_reaction, {"N", "force of the ballast on the soil", down});

  file.write_names("/vehicle/names", p.coordinate_names, "coordinates of the vehicle");
  file.write_matrix("/vehicle/position", p.coordinates,
                    {"m, rad", "coordinates of the vehicle", "heave upward, pitch nose down"});
  file.write_names("/vehicle/bodies", p.body_names, "bodies of the vehicle");
  file.write_matrix("/vehicle/acceleration", p.body_acceleration,
                    {"m/s2", "vertical acceleration of the centre of mass", "z up"});

  file.write_vector("/energy/kinetic", p.kinetic_energy,
                    {"J", "kinetic energy, vehicle and track", "scalar"});
  file.write_vector("/energy/potential", p.potential_energy,
                    {"J", "potential energy: weight, suspensions, contacts, track", "scalar"});
  file.write_vector("/energy/dissipated", p.dissipated_energy, {"J", "heat since the start", "scalar"});
  file.write_vector("/energy/supplied", p.supplied_energy,
                    {"J", "work of the drive since the start", "scalar"});

  file.write_text("/foundation/kind", p.foundation, "what the ballast rests on");
  if (report.foundation_fit) write_fit(file, *report.foundation_fit);
  if (report.free_wave) {
    file.write_vector(
        "/free_wave/frequency", report.free_wave->frequency,
        {"Hz", "frequencies of the bending wave of the track without its foundation", "scalar"});
    file.write_vector("/free_wave/phase_speed", report.free_wave->phase_speed,
                      {"m/s", "phase speed of that wave", "scalar"});
  }
  if (report.load_speed.size() > 0) {
    file.write_vector("/moving_load/speed", report.load_speed,
                      {"m/s", "speed of a constant load on the track on its ground", "scalar"});
    file.write_vector("/moving_load/deflection", report.load_deflection,
                      {"m/N", "largest deflection of the rail per unit load", down});
    if (report.critical_speed > 0)
      file.write_vector("/moving_load/critical_speed", Eigen::VectorXd::Constant(1, report.critical_speed),
                        {"m/s", "speed at which that deflection is largest", "scalar"});
  }
  file.write_text("/description", report.description, "what was run, one sentence");
  file.write_text("/parameters", visu::to_json(report.parameters), "JSON: group, name, value, unit, source");
  file.write_text("/summary", to_json(report.summary), "JSON: name, value, unit");
  if (!p.warnings.empty())
    file.write_names("/warnings", p.warnings, "where a result leaves the range of the model");
  if (report.scene) file.write_text("/scene", visu::to_json(*report.scene), "JSON of the animated scene");
  if (!report.drawing.empty()) file.write_text("/vehicle/drawing", report.drawing, "SVG: side elevation");
  if (!report.tables.empty())
    file.write_text("/vehicle/tables", visu::to_json(report.tables), "JSON: title, header, rows");
  if (report.profile) {
    file.write_vector("/profile/x", report.profile->x,
                      {"m", "where the rail profile is given", "x along the track"});
    file.write_vector("/profile/height", report.profile->height,
                      {"m",
                       fmt::format("height of the centre of a wheel of radius {:g} m over the unloaded rail",
                                   report.profile->wheel_radius),
                       "upward"});
  }
  file.commit();
}

void write_passage_channels(const std::filesystem::path& path, const Passage& p, double x) {
  results::ChannelTable table;
  table.time = p.time;
  for (std::size_t w = 0; w < p.contact_names.size(); ++w)
    table.add("contact force, " + p.contact_names[w], "N", p.contact_force.col(static_cast<Eigen::Index>(w)));

  Eigen::Index nearest = 0;
  (p.sleeper_x.array() - x).abs().minCoeff(&nearest);
  const std::string at = fmt::format(", x = {:.2f} m", p.sleeper_x[nearest]);
  table.add("rail deflection" + at, "m", p.rail_deflection.col(nearest));
  table.add("sleeper displacement" + at, "m", p.sleeper_displacement.col(nearest));
  if (p.foundation_displacement.size() > 0)
    table.add("foundation displacement" + at, "m", p.foundation_displacement.col(nearest));
  table.add("ballast reaction" + at, "N", p.ballast_reaction.col(nearest));
  for (std::size_t b = 0; b < p.body_names.size(); ++b)
    table.add("vertical acceleration, " + p.body_names[b], "m/s2",
              p.body_acceleration.col(static_cast<Eigen::Index>(b)));
  results::write_channels(path, table);
}

}  // namespace easydyn::track
