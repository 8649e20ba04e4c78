#include "soil/vibrations.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "easydyn/error.hpp"
#include "easydyn/visu/parameter_json.hpp"
#include "soil/frequency_filter.hpp"
#include "soil/third_octave.hpp"

namespace easydyn::soil {
namespace {

// One component of the velocities, or the like: nt x n.
void require_shape(const char* name, const Eigen::MatrixXd& values, Eigen::Index rows, Eigen::Index columns) {
  if (values.rows() != rows || values.cols() != columns) {
    throw ModelError(fmt::format("vibrations: {} is {} x {}, must be {} x {}", name, values.rows(),
                                 values.cols(), rows, columns));
  }
}

// Sizes that agree with the time, the receivers and the footprints.
void check_sizes(const Vibrations& v) {
  const Eigen::Index nt = v.time.size(), nl = v.footprint_x.size();
  const auto nr = static_cast<Eigen::Index>(v.receivers.size());
  require_shape("velocity x", v.vx, nt, nr);
  require_shape("velocity y", v.vy, nt, nr);
  require_shape("velocity z", v.vz, nt, nr);
  require_shape("footprint displacement", v.footprint_displacement, nt, nl);
  require_shape("footprint taper", v.footprint_taper, nl, 1);
  if (v.semi_analytical) {
    const SemiAnalyticalMotion& s = *v.semi_analytical;
    require_shape("semi-analytical velocity x", s.vx, s.time.size(), nr);
    require_shape("semi-analytical velocity y", s.vy, s.time.size(), nr);
    require_shape("semi-analytical velocity z", s.vz, s.time.size(), nr);
    require_shape("semi-analytical footprint displacement", s.footprint_displacement, s.time.size(), nl);
  }
  if (v.indicators.size() != v.receivers.size()) {
    throw ModelError(
        fmt::format("vibrations: indicators of {} receivers, must be {}", v.indicators.size(), nr));
  }
}

void write_indicators(results::ResultFile& file, const Vibrations& v) {
  const auto nr = static_cast<Eigen::Index>(v.receivers.size());
  const Eigen::VectorXd centres = third_octave_centres();
  Eigen::MatrixXd bands(nr, centres.size()), ppv(nr, 4);
  Eigen::VectorXd kb(nr), vdb(nr);
  for (Eigen::Index r = 0; r < nr; ++r) {
    const Indicators& indicators = v.indicators[static_cast<std::size_t>(r)];
    bands.row(r) = indicators.third_octave_rms;
    ppv.row(r) = Eigen::RowVector4d::Map(indicators.ppv.data());
    kb(r) = indicators.kb_f_max;
    vdb(r) = indicators.vdb;
  }
  const std::string limit = fmt::format(", band-limited to {} Hz (rolled off to nothing at {} Hz)",
                                        v.highest_frequency, roll_off * v.highest_frequency);
  file.write_vector("/third_octave/centre", centres,
                    {.units = "Hz",
                     .description = "exact centres of the one-third octave bands, base ten",
                     .frame = "scalar"});
  file.write_matrix(
      "/third_octave/rms", bands,
      {.units = "m/s",
       .description = "rms of v_z in each band over the record; NaN: band beyond the highest frequency",
       .frame = "z up"},
      /*allow_nan=*/true);
  file.write_matrix("/indicators/ppv", ppv,
                    {.units = "m/s",
                     .description = "peak particle velocity of x, y, z and of the resultant" + limit,
                     .frame = "x along the track, y to the left, z up"});
  file.write_vector("/indicators/kb_f_max", kb,
                    {.units = "1", .description = "KB_Fmax (DIN 45669-1) of v_z" + limit, .frame = "z up"});
  file.write_vector("/indicators/vdb", vdb,
                    {.units = "dB",
                     .description = "largest 1 s rms of v_z re 1e-6 in/s (FTA); NaN: no motion" + limit,
                     .frame = "z up"},
                    /*allow_nan=*/true);
}

void read_indicators(const results::ResultReader& reader, Vibrations& v) {
  const Eigen::MatrixXd bands = reader.read_matrix("/third_octave/rms");
  const Eigen::MatrixXd ppv = reader.read_matrix("/indicators/ppv");
  const Eigen::VectorXd kb = reader.read_vector("/indicators/kb_f_max"),
                        vdb = reader.read_vector("/indicators/vdb");
  const auto nr = static_cast<Eigen::Index>(v.receivers.size());
  require_shape("third-octave rms", bands, nr, third_octave_centres().size());
  require_shape("PPV", ppv, nr, 4);
  require_shape("KB_Fmax", kb, nr, 1);
  require_shape("VdB", vdb, nr, 1);
  for (Eigen::Index r = 0; r < nr; ++r) {
    v.indicators.push_back({.ppv = {ppv(r, 0), ppv(r, 1), ppv(r, 2), ppv(r, 3)},
                            .third_octave_rms = bands.row(r),
                            .kb_f_max = kb(r),
                            .vdb = vdb(r)});
  }
}

void write_semi_analytical(results::ResultFile& file, const SemiAnalyticalMotion& s) {
  const std::string axes = "x along the track, y to the left, z up";
  file.write_vector("/semi_analytical/time", s.time,
                    {.units = "s", .description = "time of the semi-analytical motion", .frame = "scalar"});
  const std::pair<const char*, const Eigen::MatrixXd*> components[] = {
      {"x", &s.vx}, {"y", &s.vy}, {"z", &s.vz}};
  for (const auto& [axis, values] : components) {
    file.write_matrix(fmt::format("/semi_analytical/velocity/{}", axis), *values,
                      {.units = "m/s",
                       .description = fmt::format("ground velocity along {}, layered half-space", axis),
                       .frame = axes});
  }
  file.write_matrix("/semi_analytical/footprint_displacement", s.footprint_displacement,
                    {.units = "m",
                     .description = "soil displacement averaged over each footprint, layered half-space",
                     .frame = "downward"});
}

void read_semi_analytical(const results::ResultReader& reader, Vibrations& v) {
  if (!reader.has("/semi_analytical/time")) return;
  v.semi_analytical = {
      .time = reader.read_vector("/semi_analytical/time"),
      .vx = reader.read_matrix("/semi_analytical/velocity/x"),
      .vy = reader.read_matrix("/semi_analytical/velocity/y"),
      .vz = reader.read_matrix("/semi_analytical/velocity/z"),
      .footprint_displacement = reader.read_matrix("/semi_analytical/footprint_displacement")};
}

}  // namespace

void update_indicators(Vibrations& v) {
  const double step = (v.time(v.time.size() - 1) - v.time(0)) / static_cast<double>(v.time.size() - 1);
  v.indicators.clear();
  for (Eigen::Index r = 0; r < v.vz.cols(); ++r) {
    v.indicators.push_back(
        compute_indicators(v.vx.col(r), v.vy.col(r), v.vz.col(r), step, v.highest_frequency));
  }
}

void write_vibrations(const std::filesystem::path& path, const Vibrations& v,
                      const results::Provenance& provenance) {
  check_sizes(v);
  Eigen::MatrixXd position(static_cast<Eigen::Index>(v.receivers.size()), 3);
  std::vector<std::string> names, groups;
  for (const Receiver& receiver : v.receivers) {
    groups.push_back(receiver.group);
    position.row(static_cast<Eigen::Index>(names.size())) = Eigen::RowVector3d::Map(receiver.position.data());
    names.push_back(receiver.name);
  }
  const std::string axes = "x along the track, y to the left, z up";

  results::ResultFile file(path, provenance);
  file.write_attribute("highest_frequency", v.highest_frequency);
  file.write_vector("/time", v.time, {.units = "s", .description = "time", .frame = "scalar"});
  file.write_matrix("/receivers/position", position,
                    {.units = "m", .description = "position of the receivers", .frame = axes});
  file.write_names("/receivers/names", names, "names of the receivers");
  file.write_names("/receivers/groups", groups, "line or grid that each receiver belongs to; empty: none");
  file.write_matrix("/velocity/x", v.vx,
                    {.units = "m/s", .description = "ground velocity along x", .frame = axes});
  file.write_matrix("/velocity/y", v.vy,
                    {.units = "m/s", .description = "ground velocity along y", .frame = axes});
  file.write_matrix("/velocity/z", v.vz,
                    {.units = "m/s", .description = "ground velocity along z", .frame = axes});
  write_indicators(file, v);
  file.write_vector("/footprint/x", v.footprint_x,
                    {.units = "m", .description = "centres of the loaded footprints", .frame = axes});
  file.write_matrix(
      "/footprint/displacement", v.footprint_displacement,
      {.units = "m", .description = "soil displacement averaged over each footprint", .frame = "downward"});
  file.write_vector(
      "/footprint/taper", v.footprint_taper,
      {.units = "1", .description = "factor by which each load was tapered", .frame = "scalar"});
  if (v.semi_analytical) write_semi_analytical(file, *v.semi_analytical);
  file.write_text("/parameters", visu::to_json(v.parameters),
                  "JSON array of {group, name, value, unit, source}");
  if (!v.method.empty()) file.write_text("/method", v.method, "how the motion was computed");
  file.write_text("/site", v.site_text, "the site file, as read");
  file.commit();
}

Vibrations read_vibrations(const std::filesystem::path& path) {
  const results::ResultReader reader(path);
  Vibrations v;
  v.time = reader.read_vector("/time");
  v.vx = reader.read_matrix("/velocity/x");
  v.vy = reader.read_matrix("/velocity/y");
  v.vz = reader.read_matrix("/velocity/z");
  v.footprint_x = reader.read_vector("/footprint/x");
  v.footprint_displacement = reader.read_matrix("/footprint/displacement");
  v.footprint_taper = reader.read_vector("/footprint/taper");
  read_semi_analytical(reader, v);
  v.highest_frequency = reader.read_number_attribute("highest_frequency");
  v.parameters = visu::parameters_from_json(reader.read_text("/parameters"), path.string() + ":/parameters");
  v.site_text = reader.read_text("/site");
  if (reader.has("/method")) v.method = reader.read_text("/method");
  const std::vector<std::string> names = reader.read_names("/receivers/names");
  std::vector<std::string> groups(names.size());  // files of earlier versions have none
  if (reader.has("/receivers/groups")) groups = reader.read_names("/receivers/groups");
  groups.resize(names.size());
  const Eigen::MatrixXd position = reader.read_matrix("/receivers/position");
  try {
    require_shape("receiver position", position, static_cast<Eigen::Index>(names.size()), 3);
    for (Eigen::Index r = 0; r < position.rows(); ++r) {
      v.receivers.push_back({names[static_cast<std::size_t>(r)],
                             {position(r, 0), position(r, 1), position(r, 2)},
                             groups[static_cast<std::size_t>(r)]});
    }
    read_indicators(reader, v);
    check_sizes(v);
  } catch (const ModelError& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
  return v;
}

}  // namespace easydyn::soil
