#pragma once

#include <array>
#include <vector>

#include "soil/partition.hpp"
#include "soil/ranks.hpp"

namespace easydyn::soil {

/// A rectangle of rows of elements that one thread runs through, row by row. Lines of nodes on its edges that other
/// regions touch, too, get only a part of their force there: it goes to seam slots, numbered over all regions.
struct Region {
  ElementBlock elements;
  bool low_y = false, high_y = false, low_z = false,
       high_z = false;    ///< edges with other elements beyond them
  LinePlace first, last;  ///< lines of nodes
  int first_slot = 0;

  int slots() const;
  /// Slot of a line of this region, -1 if the region alone makes its force.
  int find_slot(LinePlace line) const {
    const int along_z = last.Z - first.Z + 1, along_y = last.Y - first.Y + 1;
    int slot = first_slot;
    if (low_y) {
      if (line.Y == first.Y) return slot + line.Z - first.Z;
      slot += along_z;
    }
    if (high_y) {
      if (line.Y == last.Y) return slot + line.Z - first.Z;
      slot += along_z;
    }
    if (low_z) {
      if (line.Z == first.Z) return slot + line.Y - first.Y;
      slot += along_y;
    }
    if (high_z && line.Z == last.Z) return slot + line.Y - first.Y;
    return -1;
  }
};

/// A line whose force is the sum of several parts, of regions of this rank and of other ranks.
struct SeamLine {
  LinePlace place;
  int parts = 0;              ///< of this rank
  std::array<int, 4> slot{};  ///< theirs, by region
  int shared = -1;            ///< number among the lines shared with other ranks; -1: this rank's alone
  int received = 0;           ///< parts of other ranks
  int received_before =
      0;                   ///< of them, those of lower ranks: sums run by rank, so that all get the same bits
  int first_received = 0;  ///< number of the first among the received lines; they lie one after the other
  bool is_owned = true;    ///< by this rank: the lowest sharer
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
  int shared_lines() const { return shared_; }
  int received_lines() const { return static_cast<int>(graph_.wanted.size()); }
  bool has_shell() const { return shared_ > 0; }
  int most_rows() const { return most_rows_; }  ///< of a region
  HaloGraph graph(std::size_t line_bytes) const;

 private:
  void add_region(Regions& regions, int thread, const ElementBlock& elements);
  void make_seam_lines(const Partition& partition, int rank);

  int degree_, rows_, slabs_, slots_ = 0, shared_ = 0, most_rows_ = 0;
  Regions shell_, core_;
  std::vector<SeamLine> seam_lines_;
  HaloGraph graph_;
};

}  // namespace easydyn::soil
