#pragma once

#include <array>
#include <vector>

namespace easydyn::soil {

/// A rectangle of rows of elements, whole along x: rows[0] <= ey < rows[1] along y, slabs[0] <= ez < slabs[1] along z.
struct ElementBlock {
  std::array<int, 2> rows{}, slabs{};

  bool has(int ey, int ez) const { return rows[0] <= ey && ey < rows[1] && slabs[0] <= ez && ez < slabs[1]; }
  long size() const { return static_cast<long>(rows[1] - rows[0]) * (slabs[1] - slabs[0]); }
};

/// A line of nodes along x: node Y along y, node Z along z of the whole lattice.
struct LinePlace {
  int Y = 0, Z = 0;
  bool operator==(const LinePlace&) const = default;
};

/// A row of elements along x.
struct ElementPlace {
  int ey = 0, ez = 0;
};

/// The rows of elements of a lattice, shared out among ranks in `along_y` x `along_z` blocks as equal as whole rows
/// and slabs allow. Of all such divisions the one whose largest block takes the least time:
///
///   time ~ lines of nodes of its elements + lines that it shares with other ranks
///
/// (a shared line is written, sent, received and summed: about as much memory traffic as the step of a line).
/// Lines of nodes between blocks belong to the lowest of the ranks that share them; a line has up to four sharers.
class Partition {
 public:
  /// @throws ModelError if no division gives every rank an element
  Partition(int rows, int slabs, int degree, int ranks);

  int ranks() const { return along_y_ * along_z_; }
  int along_y() const { return along_y_; }
  int along_z() const { return along_z_; }
  const ElementBlock& block(int rank) const { return blocks_[static_cast<std::size_t>(rank)]; }

  int find_rank(ElementPlace row) const;
  /// Rows of elements that touch the line, by ez, then ey: one, two or four.
  std::vector<ElementPlace> touching(LinePlace line) const;
  /// Ranks that hold the line, ascending.
  std::vector<int> sharers(LinePlace line) const;
  int owner(LinePlace line) const { return sharers(line).front(); }
  /// Lines that the rank shares with others, by Z, then Y.
  std::vector<LinePlace> shared_lines(int rank) const;
  /// Lines that the rank receives in one exchange: a shared line once for each row of other ranks that touches it.
  long received_lines(int rank) const;
  /// Largest share of one rank: elements of its block times nx.
  long largest_block() const;

 private:
  int rows_, slabs_, degree_, along_y_ = 1, along_z_ = 1;
  std::vector<ElementBlock> blocks_;  // rank = place along y + along_y x place along z
};

}  // namespace easydyn::soil
