#include "soil/partition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "easydyn/error.hpp"

namespace easydyn::soil {
namespace {

int part_begin(int count, int parts, int part) {
  return static_cast<int>(static_cast<long>(count) * part / parts);
}

/// The first and the last element of an axis that touch a node.
std::array<int, 2> elements_at(int node, int degree, int count) {
  const int e = node / degree;
  return {std::max(0, node % degree == 0 ? e - 1 : e), std::min(e, count - 1)};
}

}  // namespace

Partition::Partition(int rows, int slabs, int degree, int ranks)
    : rows_(rows), slabs_(slabs), degree_(degree) {
  double least = std::numeric_limits<double>::infinity();
  for (int y = 1; y <= ranks; ++y) {
    const int z = ranks / y;
    if (ranks % y != 0 || y > rows || z > slabs) continue;
    const double lines_y = static_cast<double>(degree) * ((rows + y - 1) / y),
                 lines_z = static_cast<double>(degree) * ((slabs + z - 1) / z);
    const double time = lines_y * lines_z + std::min(y - 1, 2) * lines_z + std::min(z - 1, 2) * lines_y;
    if (time < least) {
      least = time;
      along_y_ = y;
      along_z_ = z;
    }
  }
  if (least == std::numeric_limits<double>::infinity())
    throw ModelError(
        fmt::format("lattice: {} ranks, must be a product of at most {} along y and at most {} along z, its "
                    "rows and slabs of elements",
                    ranks, rows, slabs));
  for (int z = 0; z < along_z_; ++z)
    for (int y = 0; y < along_y_; ++y)
      blocks_.push_back({{part_begin(rows, along_y_, y), part_begin(rows, along_y_, y + 1)},
                         {part_begin(slabs, along_z_, z), part_begin(slabs, along_z_, z + 1)}});
}

int Partition::find_rank(ElementPlace row) const {
  // Blocks are equal up to one row: the quotient is right or one too small.
  int y = static_cast<int>(static_cast<long>(row.ey) * along_y_ / rows_);
  int z = static_cast<int>(static_cast<long>(row.ez) * along_z_ / slabs_);
  while (part_begin(rows_, along_y_, y + 1) <= row.ey) ++y;
  while (part_begin(slabs_, along_z_, z + 1) <= row.ez) ++z;
  return z * along_y_ + y;
}

std::vector<ElementPlace> Partition::touching(LinePlace line) const {
  const std::array<int, 2> in_y = elements_at(line.Y, degree_, rows_),
                           in_z = elements_at(line.Z, degree_, slabs_);
  std::vector<ElementPlace> result;
  for (int ez = in_z[0]; ez <= in_z[1]; ++ez)
    for (int ey = in_y[0]; ey <= in_y[1]; ++ey) result.push_back({ey, ez});
  return result;
}

std::vector<int> Partition::sharers(LinePlace line) const {
  std::vector<int> result;
  for (const ElementPlace row : touching(line)) result.push_back(find_rank(row));
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

std::vector<LinePlace> Partition::shared_lines(int rank) const {
  const ElementBlock& b = block(rank);
  const int Y0 = b.rows[0] * degree_, Y1 = b.rows[1] * degree_, Z0 = b.slabs[0] * degree_,
            Z1 = b.slabs[1] * degree_;
  std::vector<LinePlace> lines;
  for (int Z = Z0; Z <= Z1; ++Z) {
    const bool on_z = (Z == Z0 && Z0 > 0) || (Z == Z1 && b.slabs[1] < slabs_);
    for (int Y = Y0; Y <= Y1; ++Y)
      if (on_z || (Y == Y0 && Y0 > 0) || (Y == Y1 && b.rows[1] < rows_)) lines.push_back({Y, Z});
  }
  return lines;
}

long Partition::received_lines(int rank) const {
  long count = 0;
  for (const LinePlace& line : shared_lines(rank))
    for (const ElementPlace row : touching(line)) count += find_rank(row) == rank ? 0 : 1;
  return count;
}

long Partition::largest_block() const {
  long largest = 0;
  for (const ElementBlock& b : blocks_) largest = std::max(largest, b.size());
  return largest;
}

}  // namespace easydyn::soil
