#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "easydyn/results/vtu_file.hpp"
#include "soil/lattice.hpp"
#include "soil/partition.hpp"
#include "soil/site.hpp"

namespace easydyn::soil {

/// The output times of a run.
struct OutputTimes {
  double first = 0, step = 0;  ///< [s]
  long count = 0;
};

/// Writes the motion of planes of the ground, time after time, for ParaView:
///
///     surface.pvd               index of the series, renewed with every picture
///     surface/00012.vtu         the picture of output time 12: `velocity` [m/s] and `displacement` [m], z up
///
/// Of several ranks each writes the piece of the ground that it holds, surface/00012.rank3.vtu, and the first one
/// surface/00012.pvtu, which joins them; no rank needs anything from another one.
///
/// The points of a picture are the nodes of the lattice in the undamped ground; across the plane the motion is
/// interpolated with the shape functions. Numbers are in single precision. Half of a symmetric ground is shown.
class SnapshotWriter {
 public:
  /// Component 0, 1, 2 at the node (X, Y, Z).
  using Field = std::function<double(int component, int X, int Y, int Z)>;

  /// Nothing is written yet.
  /// @throws ModelError if a plane lies outside the undamped ground, its step is shorter than that of the output
  ///         or no output time lies between its begin and end
  SnapshotWriter(const std::vector<Snapshot>& snapshots, const Lattice& lattice, const OutputTimes& times);
  SnapshotWriter(const std::vector<Snapshot>& snapshots, const Lattice& lattice, const OutputTimes& times,
                 const Partition& partition, int rank);

  double size() const;              ///< of all files [byte]
  long files() const;               ///< number of pictures
  std::string description() const;  ///< one line per plane: name, points, pictures, time between them

  /// Files go here, into a folder that exists.
  void set_folder(const std::filesystem::path& folder) { folder_ = folder; }
  /// To be called at output time `row` with the displacement and the velocity half a step before ...
  void begin(long row, const Field& displacement, const Field& velocity);
  /// ... and with the velocity half a step after: their mean is written.
  /// @throws InputError if a file cannot be written
  void finish(long row, const Field& velocity);

 private:
  struct Node {
    int X, Y, Z;  // with 0 across the plane
  };
  struct Plane {
    std::string name;
    int axis;
    std::vector<std::pair<int, double>> across;  // node and weight
    std::vector<Node> nodes;
    results::QuadMesh mesh;
    std::size_t points = 0, quads = 0;    // of the whole picture
    std::vector<int> pieces;              // ranks that hold one
    long first = 0, last = 0, every = 1;  // rows
    std::vector<float> displacement, velocity;

    bool has(long row) const { return row >= first && row <= last && (row - first) % every == 0; }
    long pictures() const { return (last - first) / every + 1; }
  };
  void make_plane(const Snapshot& snapshot, const Lattice& lattice);
  bool has_pieces() const { return partition_.ranks() > 1; }
  /// Of all ranks together, seen from the folder.
  std::string picture_name(const Plane& plane, long row) const;
  std::string piece_name(const Plane& plane, long row, int rank) const;
  static void add(const Plane& plane, const Field& field, double factor, std::vector<float>& out);

  OutputTimes times_;
  Partition partition_;
  int rank_;
  std::filesystem::path folder_;
  std::vector<Plane> planes_;
};

}  // namespace easydyn::soil
