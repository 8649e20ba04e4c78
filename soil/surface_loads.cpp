#include "soil/surface_loads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "easydyn/error.hpp"
#include "soil/load_history.hpp"

namespace easydyn::soil {
namespace {

// What is wrong with the loads, naming the dataset; empty if nothing is.
std::string find_fault(const SurfaceLoads& loads) {
  const Eigen::VectorXd& time = loads.time;
  if (time.size() < 2) {
    return fmt::format("\"/time\" has {} values, must have at least 2", time.size());
  }
  if (loads.footprints.empty()) {
    return "\"/position\" has no footprint, must have at least 1";
  }
  if (loads.force.rows() != time.size() ||
      loads.force.cols() != static_cast<Eigen::Index>(loads.footprints.size())) {
    return fmt::format(
        "\"/force\" has the shape ({} x {}), must be ({} x {}): one row per time, one column per footprint",
        loads.force.rows(), loads.force.cols(), time.size(), loads.footprints.size());
  }
  // One step for all, up to the rounding of the times.
  const double step = (time(time.size() - 1) - time(0)) / static_cast<double>(time.size() - 1);
  if (!(step > 0)) {
    return fmt::format("\"/time\" goes from {} s to {} s, must increase", time(0), time(time.size() - 1));
  }
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    if (!(std::abs(time(i) - time(0) - step * static_cast<double>(i)) < 1e-3 * step)) {
      return fmt::format("\"/time\": value ({}) is {} s, must be {} s (uniform step)", i, time(i),
                         time(0) + step * static_cast<double>(i));
    }
  }
  for (std::size_t j = 0; j < loads.footprints.size(); ++j) {
    const Footprint& footprint = loads.footprints[j];
    if (!std::isfinite(footprint.x) || !std::isfinite(footprint.y)) {
      return fmt::format("\"/position\": row {} is ({}, {}) m, must be finite", j, footprint.x, footprint.y);
    }
    if (!footprint.is_point() && (!(footprint.length > 0) || !(footprint.width > 0) ||
                                  !std::isfinite(footprint.length) || !std::isfinite(footprint.width))) {
      return fmt::format("\"/size\": row {} is {} m x {} m, must be > 0 (or both 0: a point)", j,
                         footprint.length, footprint.width);
    }
  }
  for (Eigen::Index i = 0; i < loads.force.rows(); ++i) {
    for (Eigen::Index j = 0; j < loads.force.cols(); ++j) {
      if (!std::isfinite(loads.force(i, j))) {
        return fmt::format("\"/force\": value ({}, {}) is {} N, must be finite", i, j, loads.force(i, j));
      }
    }
  }
  return {};
}

const std::vector<std::string> direction_names{"x", "y", "down"};

}  // namespace

void write_surface_loads(const std::filesystem::path& path, const SurfaceLoads& loads,
                         const results::Provenance& provenance) {
  if (const std::string fault = find_fault(loads); !fault.empty()) {
    throw ModelError("surface loads: " + fault);
  }
  const auto count = static_cast<Eigen::Index>(loads.footprints.size());
  Eigen::MatrixXd position(count, 2), size(count, 2);
  for (Eigen::Index j = 0; j < count; ++j) {
    const Footprint& footprint = loads.footprints[static_cast<std::size_t>(j)];
    position.row(j) << footprint.x, footprint.y;
    size.row(j) << footprint.length, footprint.width;
  }
  std::vector<std::string> directions;
  bool has_horizontal = false;
  for (const Footprint& footprint : loads.footprints) {
    directions.push_back(direction_names[static_cast<std::size_t>(footprint.direction)]);
    has_horizontal = has_horizontal || footprint.direction != LoadDirection::down;
  }
  results::ResultFile file(path, provenance);
  file.write_vector("/time", loads.time, {.units = "s", .description = "time", .frame = "scalar"});
  file.write_matrix("/force", loads.force,
                    {.units = "N",
                     .description = "force on each footprint",
                     .frame = has_horizontal ? "positive along /direction" : "positive downward"});
  file.write_matrix("/position", position,
                    {.units = "m",
                     .description = "x, y of the centre of each footprint",
                     .frame = "x along the track, y to the left"});
  file.write_matrix("/size", size,
                    {.units = "m",
                     .description = "length along x and width along y of each footprint",
                     .frame = "x along the track, y to the left"});
  if (has_horizontal) {
    file.write_names("/direction", directions, "direction of the force on each footprint: x, y or down");
  }
  file.commit();
}

SurfaceLoads read_surface_loads(const std::filesystem::path& path) {
  const results::ResultReader reader(path);
  SurfaceLoads loads;
  loads.time = reader.read_vector("/time");
  loads.force = reader.read_matrix("/force");
  const Eigen::MatrixXd position = reader.read_matrix("/position");
  const Eigen::MatrixXd size = reader.read_matrix("/size");
  if (position.cols() != 2) {
    throw InputError(fmt::format("{}: \"/position\" has the shape ({} x {}), must have 2 columns: x, y",
                                 path.string(), position.rows(), position.cols()));
  }
  if (size.cols() != 2 || size.rows() != position.rows()) {
    throw InputError(fmt::format("{}: \"/size\" has the shape ({} x {}), must be ({} x 2): length, width",
                                 path.string(), size.rows(), size.cols(), position.rows()));
  }
  for (Eigen::Index j = 0; j < position.rows(); ++j) {
    loads.footprints.push_back({position(j, 0), position(j, 1), size(j, 0), size(j, 1), LoadDirection::down});
  }
  if (reader.has("/direction")) {
    const std::vector<std::string> directions = reader.read_names("/direction");
    if (directions.size() != loads.footprints.size()) {
      throw InputError(fmt::format("{}: \"/direction\" has {} texts, must have {}: one per footprint",
                                   path.string(), directions.size(), loads.footprints.size()));
    }
    for (std::size_t j = 0; j < directions.size(); ++j) {
      const auto name = std::find(direction_names.begin(), direction_names.end(), directions[j]);
      if (name == direction_names.end()) {
        throw InputError(
            fmt::format("{}: \"/direction\": text {} is \"{}\", must be \"x\", \"y\" or \"down\"",
                        path.string(), j, directions[j]));
      }
      loads.footprints[j].direction = static_cast<LoadDirection>(name - direction_names.begin());
    }
  }
  if (const std::string fault = find_fault(loads); !fault.empty()) {
    throw InputError(fmt::format("{}: {}", path.string(), fault));
  }
  return loads;
}

SurfaceLoads join_surface_loads(const std::vector<SurfaceLoads>& sources, double preload_time) {
  if (sources.empty()) throw ModelError("surface loads: no source, must be at least 1");
  if (sources.size() == 1) return sources.front();
  double begin = std::numeric_limits<double>::infinity(), end = -begin, step = begin;
  Eigen::Index count = 0;
  std::vector<LoadHistory> histories;
  for (const SurfaceLoads& source : sources) {
    const LoadHistory& history = histories.emplace_back(source, preload_time);
    begin = std::min(begin, history.first_time());
    end = std::max(end, history.last_time());
    step = std::min(
        step, (history.last_time() - history.first_time()) / static_cast<double>(source.time.size() - 1));
    count += source.force.cols();
  }
  const auto samples = static_cast<Eigen::Index>(std::ceil((end - begin) / step - 1e-6)) + 1;
  SurfaceLoads joined;
  joined.time = begin + step * Eigen::ArrayXd::LinSpaced(samples, 0, static_cast<double>(samples - 1));
  joined.force.resize(samples, count);
  Eigen::Index first = 0;
  Eigen::VectorXd forces;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    for (Footprint footprint : sources[s].footprints) {
      footprint.source = static_cast<int>(s);
      joined.footprints.push_back(footprint);
    }
    const Eigen::Index columns = sources[s].force.cols();
    for (Eigen::Index i = 0; i < samples; ++i) {
      histories[s].update_forces(joined.time(i), forces);
      joined.force.row(i).segment(first, columns) = forces;
    }
    first += columns;
  }
  return joined;
}

SurfaceLoads read_surface_loads(const std::vector<std::filesystem::path>& paths, double preload_time) {
  std::vector<SurfaceLoads> sources;
  for (const std::filesystem::path& path : paths) sources.push_back(read_surface_loads(path));
  return join_surface_loads(sources, preload_time);
}

}  // namespace easydyn::soil
