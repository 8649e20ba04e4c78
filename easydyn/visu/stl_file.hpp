#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace easydyn::visu {

/// Triangles of an STL file, binary or text, for Item::triangles; normals are ignored, colours too.
/// @param scale  factors along x, y, z, none 0: STL files have no unit, often [mm]. Mirroring keeps outsides outside
/// @throws InputError with the file, if it cannot be read, is cut off, holds no triangle or a number that is not finite
std::vector<float> read_stl(const std::filesystem::path& file,
                            const Eigen::Vector3d& scale = Eigen::Vector3d::Ones());

}  // namespace easydyn::visu
