#include "soil/mobility_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "easydyn/error.hpp"
#include "easydyn/visu/parameter_json.hpp"
#include "soil/mobility_identity.hpp"
#include "soil/site_file.hpp"

namespace easydyn::soil {
namespace {

using Eigen::Index;

constexpr std::pair<const char*, GroundDamping> dampings[] = {
    {"none", GroundDamping::none},
    {"stiffness", GroundDamping::stiffness_proportional},
    {"constant", GroundDamping::maxwell_body},
    {"constant-q", GroundDamping::constant_q}};

// Of the responses to a horizontal load.
std::string group_of(LoadDirection direction) {
  return direction == LoadDirection::x ? "/load_x" : "/load_y";
}

// What is wrong with the sizes, naming the dataset; empty if nothing is.
std::string find_fault(const Mobility& m) {
  const auto check = [&](const char* name, const Eigen::MatrixXd& values,
                         std::size_t columns) -> std::string {
    if (values.rows() == m.hz.rows() && values.cols() == static_cast<Index>(columns)) return {};
    return fmt::format("\"{}\" has the shape ({} x {}), must be ({} x {})", name, values.rows(),
                       values.cols(), m.hz.rows(), columns);
  };
  for (const std::string& fault :
       {check("/response/x", m.hx, m.places.size()), check("/response/y", m.hy, m.places.size()),
        check("/response/z", m.hz, m.places.size()), check("/neighbour/response", m.mean, m.shifts.size())}) {
    if (!fault.empty()) return fault;
  }
  for (const auto& [direction, h] : m.horizontal) {
    const std::string group = group_of(direction);
    const auto check_of = [&](const char* name, const Eigen::MatrixXd& values, std::size_t columns) {
      return check((group + name).c_str(), values, columns);
    };
    for (const std::string& fault :
         {check_of("/response/x", h.hx, m.places.size()), check_of("/response/y", h.hy, m.places.size()),
          check_of("/response/z", h.hz, m.places.size()), check_of("/neighbour/x", h.mean_x, m.shifts.size()),
          check_of("/neighbour/y", h.mean_y, m.shifts.size()),
          check_of("/neighbour/response", h.mean, m.shifts.size())}) {
      if (!fault.empty()) return fault;
    }
  }
  if (m.hz.rows() < 2 || m.before < 0 || m.before >= m.hz.rows()) {
    return fmt::format("\"/time\" has {} values, {} of them before 0, must have at least 2 and one at 0",
                       m.hz.rows(), m.before);
  }
  if (!(m.step > 0) || !(m.length > 0) || !(m.width > 0) || !(m.highest_frequency > 0)) {
    return fmt::format("step {} s, footprint {} m x {} m, highest frequency {} Hz, must all be > 0", m.step,
                       m.length, m.width, m.highest_frequency);
  }
  return {};
}

std::string find_fault(const StoredMobility& stored) {
  const std::vector<std::string>& methods = stored.shift_methods;
  if (!methods.empty() && methods.size() != stored.mobility.shifts.size())
    return fmt::format("\"/neighbour/method\" has {} values, must have {}, one per footprint", methods.size(),
                       stored.mobility.shifts.size());
  for (const std::string& method : methods)
    if (method != layered_method && method != element_method)
      return fmt::format("\"/neighbour/method\" holds \"{}\", must be \"{}\" or \"{}\"", method,
                         layered_method, element_method);
  return find_fault(stored.mobility);
}

template <std::size_t N>
Eigen::MatrixXd to_matrix(const std::vector<std::array<double, N>>& rows) {
  Eigen::MatrixXd matrix(static_cast<Index>(rows.size()), static_cast<Index>(N));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t c = 0; c < N; ++c) matrix(static_cast<Index>(i), static_cast<Index>(c)) = rows[i][c];
  }
  return matrix;
}

template <std::size_t N>
std::vector<std::array<double, N>> to_rows(const results::ResultReader& reader, const std::string& name) {
  const Eigen::MatrixXd matrix = reader.read_matrix(name);
  if (matrix.cols() != static_cast<Index>(N)) {
    throw InputError(fmt::format("{}: \"{}\" has the shape ({} x {}), must have {} columns",
                                 reader.path().string(), name, matrix.rows(), matrix.cols(), N));
  }
  std::vector<std::array<double, N>> rows(static_cast<std::size_t>(matrix.rows()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t c = 0; c < N; ++c) rows[i][c] = matrix(static_cast<Index>(i), static_cast<Index>(c));
  }
  return rows;
}

}  // namespace

GroundDamping find_ground_damping(const std::string& name) {
  for (const auto& [known, damping] : dampings) {
    if (name == known) return damping;
  }
  throw InputError(fmt::format("damping = {}, must be none, stiffness, constant or constant-q", name));
}

std::string name_of(GroundDamping damping) {
  for (const auto& [name, known] : dampings) {
    if (damping == known) return name;
  }
  return {};
}

void write_mobility(const std::filesystem::path& path, const StoredMobility& stored,
                    const results::Provenance& provenance) {
  const Mobility& m = stored.mobility;
  if (const std::string fault = find_fault(stored); !fault.empty()) throw ModelError("mobility: " + fault);
  const std::string axes = "x along the track, y to the left, z up";
  const std::string band = fmt::format(
      " under a unit impulse, downward, on the footprint; unchanged up to {} Hz, "
      "nothing from {} Hz",
      1.25 * m.highest_frequency, 1.75 * m.highest_frequency);
  results::ResultFile file(path, provenance);
  file.write_attribute("highest_frequency", m.highest_frequency);
  file.write_attribute("method", stored.method);
  file.write_attribute("damping", name_of(stored.damping));
  const Eigen::VectorXd time = Eigen::VectorXd::NullaryExpr(
      m.hz.rows(), [&](Index i) { return m.step * static_cast<double>(i - m.before); });
  file.write_vector("/time", time,
                    {.units = "s", .description = "time after the impulse", .frame = "scalar"});
  if (stored.window > 0) {
    file.write_vector("/window", Eigen::VectorXd::Constant(1, stored.window),
                      {.units = "s",
                       .description = "length of the responses after the impulse; only those of far "
                                      "footprints go on to the end of /time",
                       .frame = "scalar"});
  }
  file.write_vector("/footprint/size", Eigen::Vector2d(m.length, m.width),
                    {.units = "m", .description = "length along x and width along y", .frame = axes});
  file.write_matrix(
      "/response/offset", to_matrix(m.places),
      {.units = "m",
       .description = "distance of each receiver from the centre of the footprint, |dx|, |dy|, and its z",
       .frame = axes});
  const std::pair<const char*, const Eigen::MatrixXd*> components[] = {
      {"x", &m.hx}, {"y", &m.hy}, {"z", &m.hz}};
  for (const auto& [axis, values] : components) {
    file.write_matrix(fmt::format("/response/{}", axis), *values,
                      {.units = "m/(N s)",
                       .description = fmt::format("displacement along {} for dx, dy >= 0", axis) + band,
                       .frame = axes});
  }
  file.write_matrix("/neighbour/offset", to_matrix(m.shifts),
                    {.units = "m",
                     .description = "distance of each neighbouring footprint from the loaded one, |dx|, |dy|",
                     .frame = axes});
  file.write_matrix("/neighbour/response", m.mean,
                    {.units = "m/(N s)",
                     .description = "mean displacement of a footprint there" + band,
                     .frame = "downward"});
  if (!stored.shift_methods.empty())
    file.write_names("/neighbour/method", stored.shift_methods,
                     "how the response of each neighbouring footprint was computed");
  for (const auto& [direction, h] : m.horizontal) {
    const std::string group = group_of(direction);
    const std::string load = fmt::format(
        " for dx, dy >= 0 under a unit impulse along {} on the footprint; band as /response/x", group.back());
    const std::pair<const char*, const Eigen::MatrixXd*> responses[] = {
        {"x", &h.hx}, {"y", &h.hy}, {"z", &h.hz}};
    for (const auto& [axis, values] : responses) {
      file.write_matrix(fmt::format("{}/response/{}", group, axis), *values,
                        {.units = "m/(N s)",
                         .description = fmt::format("displacement along {}", axis) + load,
                         .frame = axes});
    }
    const std::pair<const char*, const Eigen::MatrixXd*> means[] = {
        {"x", &h.mean_x}, {"y", &h.mean_y}, {"response", &h.mean}};
    for (const auto& [name, values] : means) {
      file.write_matrix(fmt::format("{}/neighbour/{}", group, name), *values,
                        {.units = "m/(N s)",
                         .description = "mean displacement of a footprint there" + load,
                         .frame = values == &h.mean ? "downward" : axes});
    }
  }
  if (!stored.identity.empty())
    file.write_names("/identity", stored.identity, "what the responses depend on, beside their distances");
  file.write_text("/parameters", visu::to_json(stored.parameters),
                  "JSON array of {group, name, value, unit, source}");
  file.write_text("/site", stored.site.text, "the site file, as read");
  file.commit();
}

StoredMobility read_mobility(const std::filesystem::path& path) {
  const results::ResultReader reader(path);
  StoredMobility stored;
  Mobility& m = stored.mobility;
  m.highest_frequency = reader.read_number_attribute("highest_frequency");
  stored.method = reader.read_text_attribute("method");
  stored.damping = find_ground_damping(reader.read_text_attribute("damping"));
  const Eigen::VectorXd time = reader.read_vector("/time"), size = reader.read_vector("/footprint/size");
  if (time.size() < 2 || size.size() != 2) {
    throw InputError(
        fmt::format("{}: \"/time\" has {} values and \"/footprint/size\" {}, must have at least 2 and 2",
                    path.string(), time.size(), size.size()));
  }
  m.step = (time(time.size() - 1) - time(0)) / static_cast<double>(time.size() - 1);
  m.before = static_cast<int>(std::lround(-time(0) / m.step));
  m.length = size(0);
  m.width = size(1);
  m.places = to_rows<3>(reader, "/response/offset");
  m.shifts = to_rows<2>(reader, "/neighbour/offset");
  m.hx = reader.read_matrix("/response/x");
  m.hy = reader.read_matrix("/response/y");
  m.hz = reader.read_matrix("/response/z");
  m.mean = reader.read_matrix("/neighbour/response");
  for (const LoadDirection direction : {LoadDirection::x, LoadDirection::y}) {
    const std::string group = group_of(direction);
    if (!reader.has(group)) continue;
    const auto read = [&](const char* name) { return reader.read_matrix(group + name); };
    m.horizontal[direction] = {read("/response/x"),  read("/response/y"),  read("/response/z"),
                               read("/neighbour/x"), read("/neighbour/y"), read("/neighbour/response")};
  }
  if (m.hz.rows() != time.size()) {
    throw InputError(fmt::format("{}: \"/response/z\" has {} rows, must have {} as \"/time\"", path.string(),
                                 m.hz.rows(), time.size()));
  }
  if (reader.has("/neighbour/method")) stored.shift_methods = reader.read_names("/neighbour/method");
  if (const std::string fault = find_fault(stored); !fault.empty()) {
    throw InputError(fmt::format("{}: {}", path.string(), fault));
  }
  const Eigen::VectorXd window =
      reader.has("/window") ? reader.read_vector("/window") : Eigen::VectorXd::Constant(1, m.window());
  if (window.size() != 1 || !(window(0) > 0) || !(window(0) <= m.window() + 1e-6 * m.step)) {
    throw InputError(
        fmt::format("{}: \"/window\" must be one value, > 0 and at most {} s, the end of \"/time\"",
                    path.string(), m.window()));
  }
  stored.window = window(0);
  if (reader.has("/identity")) stored.identity = reader.read_names("/identity");
  if (reader.has("/parameters")) {
    stored.parameters =
        visu::parameters_from_json(reader.read_text("/parameters"), path.string() + ":/parameters");
  }
  stored.site = parse_site(reader.read_text("/site"), path.string() + ":/site");
  return stored;
}

}  // namespace easydyn::soil
