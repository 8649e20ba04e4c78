#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace easydyn::results {

/// Points in space and the quadrilaterals between them.
struct QuadMesh {
  std::vector<float> points;        ///< x, y, z of each [m]
  std::vector<std::int32_t> quads;  ///< four points each, in order around it

  std::size_t point_count() const { return points.size() / 3; }
  std::size_t quad_count() const { return quads.size() / 4; }
};

/// A vector at each point of a mesh.
struct PointVectors {
  std::string name;           ///< e.g. "velocity"
  std::vector<float> values;  ///< x, y, z of each
};

/// Writes a VTK XML unstructured grid: mesh, vectors at its points and the time, which ParaView shows. Numbers are
/// appended in base64, not compressed, so that the file is well-formed XML (VTK file formats, kitware.com). It
/// appears complete or not at all.
/// @throws ModelError if sizes do not fit or a value is not finite, InputError if the file cannot be written
void write_vtu(const std::filesystem::path& path, const QuadMesh& mesh,
               const std::vector<PointVectors>& vectors, double time);

/// Size of such a file [byte], within 1 kB.
double compute_vtu_size(std::size_t points, std::size_t quads, std::size_t vectors);

/// Writes the index of one picture in pieces, a file `.pvtu`: files written by write_vtu(), as seen from its folder, and
/// the names of their vectors. It appears complete or not at all. @throws InputError if the file cannot be written
void write_pvtu(const std::filesystem::path& path, const std::vector<std::string>& pieces,
                const std::vector<std::string>& vectors);

/// A file of a series and its time [s]; the file as seen from the folder of the index.
struct PvdEntry {
  double time = 0;
  std::string file;
};

/// Writes the index of a series, a file `.pvd` that ParaView opens as one animation. It appears complete or not
/// at all. @throws InputError if the file cannot be written
void write_pvd(const std::filesystem::path& path, const std::vector<PvdEntry>& entries);

}  // namespace easydyn::results
