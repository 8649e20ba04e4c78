#pragma once

#include <array>
#include <vector>

#include "soil/partition.hpp"
#include "soil/ranks.hpp"

namespace easydyn::soil {

/// A rectangle of rows of elements that one thread runs through, row by row. Lines of nodes on its edges that other
/// regions touch, too, get only a part of their force there. What each row of elements contributes to them goes to a
/// seam slot of its own; slots are numbered over all regions.
struct Region {
  ElementBlock elements;
  bool low_y = false, high_y = false, low_z = false,
       high_z = false;    ///< edges with other elements beyond them
  LinePlace first, last;  ///< lines of nodes
  int first_slot = 0;

  int slots() const;  ///< two per line of an edge: two rows of the region may touch it
  /// Slot of what a row of elements of this region contributes to a line that it touches, -1 if the line is not on a
  /// seam; `upper`: the row lies above or, along y, behind the line.
  int find_slot(LinePlace line, bool upper_y, bool upper_z) const {
    const int along_z = last.Z - first.Z + 1, along_y = last.Y - first.Y + 1;
    const int second_on_y = upper_z && line.Z > first.Z ? 1 : 0;
    int slot = first_slot;
    if (low_y) {
      if (line.Y == first.Y) return slot + 2 * (line.Z - first.Z) + second_on_y;
      slot += 2 * along_z;
    }
    if (high_y) {
      if (line.Y == last.Y) return slot + 2 * (line.Z - first.Z) + second_on_y;
      slot += 2 * along_z;
    }
    const int second_on_z = upper_y && line.Y > first.Y ? 1 : 0;
    if (low_z) {
      if (line.Z == first.Z) return slot + 2 * (line.Y - first.Y) + second_on_z;
      slot += 2 * along_y;
    }
    if (high_z && line.Z == last.Z) return slot + 2 * (line.Y - first.Y) + second_on_z;
    return -1;
  }
};

/// A line whose force is the sum of parts from several regions or ranks: one part for each row of elements that
/// touches it, in the order in which one region alone would add them up. So the sum has the same bits whatever the
/// numbers of threads and ranks (unless the row has blocks in it, which a region adds after the row's layer).
struct SeamLine {
  LinePlace place;
  int parts = 0;
  std::array<int, 4> slot{};  ///< of a part of this rank; -1: another rank's
  std::array<int, 4>
      exchanged{};       ///< number of a part among those sent or received; -1: of and for this rank alone
  bool is_owned = true;  ///< by this rank: the lowest sharer
};

/// How one rank and its threads go about a step: first the shell of the elements that touch lines shared with other
/// ranks, then, while these lines travel, the core; last of all the seam lines. A rank on its own has no shell.
class RegionPlan {
 public:
  RegionPlan(const Partition& partition, int degree, int rows, int slabs, int rank, int threads);

  using Regions = std::vector<std::vector<Region>>;  // of each thread
  const Regions& shell() const { return shell_; }
  const Regions& core() const { return core_; }
  const std::vector<SeamLine>& seam_lines() const { return seam_lines_; }
  int slots() const { return slots_; }
  int sent_lines() const { return graph_.own; }
  int received_lines() const { return static_cast<int>(graph_.wanted.size()); }
  bool has_shell() const { return graph_.own > 0; }
  int most_rows() const { return most_rows_; }    ///< of a region
  HaloGraph graph(std::size_t line_bytes) const;  ///< of the parts of shared lines

 private:
  void add_region(Regions& regions, int thread, const ElementBlock& elements);
  void make_seam_lines(const Partition& partition, int rank);

  int degree_, rows_, slabs_, slots_ = 0, most_rows_ = 0;
  Regions shell_, core_;
  std::vector<SeamLine> seam_lines_;
  HaloGraph graph_;
};

}  // namespace easydyn::soil
