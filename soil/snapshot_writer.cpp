#include "soil/snapshot_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "easydyn/error.hpp"
#include "soil/gll.hpp"
#include "soil/surface_interpolation.hpp"

namespace easydyn::soil {
namespace {

struct Axis {
  int first, last;                // nodes of the undamped range
  std::array<double, 2> range;    // [m]
  std::vector<double> positions;  // of all nodes
};

Axis make_axis(const std::vector<double>& lines, const std::array<int, 2>& sponge, int degree) {
  const GllRule rule(degree);
  Axis axis;
  const int elements = static_cast<int>(lines.size()) - 1;
  axis.first = sponge[0] * degree;
  axis.last = (elements - sponge[1]) * degree;
  axis.range = {lines[static_cast<std::size_t>(sponge[0])],
                lines[static_cast<std::size_t>(elements - sponge[1])]};
  for (int e = 0; e < elements; ++e) {
    const double a = lines[static_cast<std::size_t>(e)], b = lines[static_cast<std::size_t>(e) + 1];
    for (int i = 0; i < degree; ++i) axis.positions.push_back((a + b) / 2 + (b - a) / 2 * rule.points(i));
  }
  axis.positions.push_back(lines.back());
  return axis;
}

/// Nodes of an axis, first <= node <= last.
struct NodeRange {
  int first, last;
};

/// Nodes of the undamped range of an axis that lie between two element boundaries.
NodeRange nodes_between(const Axis& axis, const std::array<int, 2>& elements, int degree) {
  return {std::max(axis.first, elements[0] * degree), std::min(axis.last, elements[1] * degree)};
}

}  // namespace

SnapshotWriter::SnapshotWriter(const std::vector<Snapshot>& snapshots, const Lattice& lattice,
                               const OutputTimes& times)
    : SnapshotWriter(snapshots, lattice, times, Partition(lattice.ny(), lattice.nz(), lattice.degree, 1), 0) {
}

SnapshotWriter::SnapshotWriter(const std::vector<Snapshot>& snapshots, const Lattice& lattice,
                               const OutputTimes& times, const Partition& partition, int rank)
    : times_(times), partition_(partition), rank_(rank) {
  for (const Snapshot& snapshot : snapshots) {
    if (!(snapshot.step >= times.step * (1 - 1e-9)))
      throw ModelError(fmt::format("snapshot \"{}\": step = {} s, must be >= {:.6g} s, the output step",
                                   snapshot.name, snapshot.step, times.step));
    make_plane(snapshot, lattice);
    Plane& plane = planes_.back();
    const double most = static_cast<double>(times.count - 1);
    plane.every = static_cast<long>(std::lround(std::min(snapshot.step / times.step, most + 1)));
    const auto row_of = [&](double t) { return std::clamp((t - times.first) / times.step, -1.0, most + 1); };
    plane.first = std::max(0L, static_cast<long>(std::ceil(row_of(snapshot.begin) - 1e-6)));
    plane.last = std::min(times.count - 1, static_cast<long>(std::floor(row_of(snapshot.end) + 1e-6)));
    if (plane.first > plane.last)
      throw ModelError(fmt::format(
          "snapshot \"{}\": no output time between begin = {} s and end = {} s, must overlap {:.6g}..{:.6g} "
          "s",
          snapshot.name, snapshot.begin, snapshot.end, times.first, times.first + most * times.step));
  }
}

void SnapshotWriter::make_plane(const Snapshot& snapshot, const Lattice& lattice) {
  const int degree = lattice.degree;
  const std::array<Axis, 3> axes = {make_axis(lattice.x, lattice.sponge_x, degree),
                                    make_axis(lattice.y, lattice.sponge_y, degree),
                                    make_axis(lattice.z, lattice.sponge_z, degree)};
  const Axis& normal = axes[static_cast<std::size_t>(snapshot.axis)];
  if (!(snapshot.place >= normal.range[0] - 1e-9 && snapshot.place <= normal.range[1] + 1e-9))
    throw ModelError(
        fmt::format("snapshot \"{}\": {} = {} m, must be in {:.6g}..{:.6g} m, the undamped ground (a "
                    "receiver farther out or "
                    "a larger margin widens it)",
                    snapshot.name, "xyz"[snapshot.axis], snapshot.place, normal.range[0], normal.range[1]));

  Plane plane;
  plane.name = snapshot.name;
  plane.axis = snapshot.axis;
  // Weights across the plane: those of a receiver on a node of the plane.
  std::array<double, 3> corner = {axes[0].range[0], axes[1].range[0], axes[2].range[0]};
  corner[static_cast<std::size_t>(snapshot.axis)] = snapshot.place;
  for (const NodeWeight& n : compute_receiver_weights(lattice, {snapshot.name, corner}).nodes)
    plane.across.push_back({std::array{n.X, n.Y, n.Z}[static_cast<std::size_t>(snapshot.axis)], n.weight});

  const int first_axis = snapshot.axis == 0 ? 1 : 0, second_axis = snapshot.axis == 2 ? 1 : 2;
  const Axis &a = axes[static_cast<std::size_t>(first_axis)],
             &b = axes[static_cast<std::size_t>(second_axis)];
  plane.points =
      static_cast<std::size_t>(a.last - a.first + 1) * static_cast<std::size_t>(b.last - b.first + 1);
  plane.quads = static_cast<std::size_t>(a.last - a.first) * static_cast<std::size_t>(b.last - b.first);
  // The element across the plane that holds all nodes across it.
  const std::array<int, 3> counts = {lattice.nx(), lattice.ny(), lattice.nz()};
  const int element =
      std::min(plane.across.front().first / degree, counts[static_cast<std::size_t>(snapshot.axis)] - 1);
  for (int rank = 0; rank < partition_.ranks(); ++rank) {
    const ElementBlock& block = partition_.block(rank);
    const std::array<std::array<int, 2>, 3> elements = {{{0, lattice.nx()}, block.rows, block.slabs}};
    const auto& [low, high] = elements[static_cast<std::size_t>(snapshot.axis)];
    const NodeRange i = nodes_between(a, elements[static_cast<std::size_t>(first_axis)], degree),
                    j = nodes_between(b, elements[static_cast<std::size_t>(second_axis)], degree);
    if (element < low || element >= high || i.first >= i.last || j.first >= j.last) continue;
    plane.pieces.push_back(rank);
    if (rank != rank_) continue;
    const int count = i.last - i.first + 1;
    for (int q = j.first; q <= j.last; ++q)
      for (int p = i.first; p <= i.last; ++p) {
        std::array<int, 3> node{};
        std::array<double, 3> position{};
        node[static_cast<std::size_t>(first_axis)] = p;
        node[static_cast<std::size_t>(second_axis)] = q;
        position[static_cast<std::size_t>(snapshot.axis)] = snapshot.place;
        position[static_cast<std::size_t>(first_axis)] = a.positions[static_cast<std::size_t>(p)];
        position[static_cast<std::size_t>(second_axis)] = b.positions[static_cast<std::size_t>(q)];
        plane.nodes.push_back({node[0], node[1], node[2]});
        for (const double x : position) plane.mesh.points.push_back(static_cast<float>(x));
        if (p == i.last || q == j.last) continue;
        const int corner_point = (q - j.first) * count + p - i.first;
        for (const int point :
             {corner_point, corner_point + 1, corner_point + count + 1, corner_point + count})
          plane.mesh.quads.push_back(point);
      }
  }
  plane.displacement.assign(plane.mesh.points.size(), 0);
  plane.velocity.assign(plane.mesh.points.size(), 0);
  planes_.push_back(std::move(plane));
}

std::string SnapshotWriter::picture_name(const Plane& plane, long row) const {
  return fmt::format("{}/{:05d}.{}", plane.name, row, has_pieces() ? "pvtu" : "vtu");
}

std::string SnapshotWriter::piece_name(const Plane& plane, long row, int rank) const {
  return has_pieces() ? fmt::format("{}/{:05d}.rank{}.vtu", plane.name, row, rank) : picture_name(plane, row);
}

double SnapshotWriter::size() const {
  double bytes = 0;
  for (const Plane& plane : planes_) {
    const auto pictures = static_cast<double>(plane.pictures());
    const double line_of_index = 60 + static_cast<double>(plane.name.size());
    bytes += pictures * (results::compute_vtu_size(plane.points, plane.quads, 2) + line_of_index);
  }
  return bytes;
}

long SnapshotWriter::files() const {
  long count = 0;
  for (const Plane& plane : planes_) count += plane.pictures();
  return count;
}

std::string SnapshotWriter::description() const {
  std::string text;
  for (const Plane& plane : planes_)
    text += fmt::format("{}\"{}\": {} points, {} pictures, one every {:.4g} ms", text.empty() ? "" : "\n",
                        plane.name, plane.points, plane.pictures(),
                        1e3 * times_.step * static_cast<double>(plane.every));
  return text;
}

void SnapshotWriter::add(const Plane& plane, const Field& field, double factor, std::vector<float>& out) {
  for (std::size_t n = 0; n < plane.nodes.size(); ++n) {
    Node node = plane.nodes[n];
    int& across = plane.axis == 0 ? node.X : plane.axis == 1 ? node.Y : node.Z;
    for (int c = 0; c < 3; ++c) {
      double sum = 0;
      for (const auto& [index, weight] : plane.across) {
        across = index;
        sum += weight * field(c, node.X, node.Y, node.Z);
      }
      float& value = out[3 * n + static_cast<std::size_t>(c)];
      value += static_cast<float>(factor * sum);
    }
  }
}

void SnapshotWriter::begin(long row, const Field& displacement, const Field& velocity) {
  for (Plane& plane : planes_) {
    if (!plane.has(row)) continue;
    std::fill(plane.displacement.begin(), plane.displacement.end(), 0.0f);
    std::fill(plane.velocity.begin(), plane.velocity.end(), 0.0f);
    add(plane, displacement, 1, plane.displacement);
    add(plane, velocity, 0.5, plane.velocity);
  }
}

void SnapshotWriter::finish(long row, const Field& velocity) {
  const auto time_of = [&](long r) { return times_.first + times_.step * static_cast<double>(r); };
  for (Plane& plane : planes_) {
    if (!plane.has(row)) continue;
    add(plane, velocity, 0.5, plane.velocity);
    std::error_code error;
    std::filesystem::create_directories(folder_ / plane.name, error);
    const std::vector<results::PointVectors> vectors = {{"velocity", plane.velocity},
                                                        {"displacement", plane.displacement}};
    if (!plane.nodes.empty())
      results::write_vtu(folder_ / piece_name(plane, row, rank_), plane.mesh, vectors, time_of(row));
    if (rank_ > 0) continue;
    if (has_pieces()) {
      std::vector<std::string> pieces;  // beside the index
      for (const int rank : plane.pieces)
        pieces.push_back(std::filesystem::path(piece_name(plane, row, rank)).filename().string());
      results::write_pvtu(folder_ / picture_name(plane, row), pieces, {"velocity", "displacement"});
    }
    std::vector<results::PvdEntry> entries;  // also those before a restart
    for (long r = plane.first; r <= row; r += plane.every)
      entries.push_back({time_of(r), picture_name(plane, r)});
    results::write_pvd(folder_ / (plane.name + ".pvd"), entries);
  }
}

}  // namespace easydyn::soil
