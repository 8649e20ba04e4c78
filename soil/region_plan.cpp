#include "soil/region_plan.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

namespace easydyn::soil {
namespace {

int part_begin(std::array<int, 2> range, int parts, int part) {
  return range[0] + static_cast<int>(static_cast<long>(range[1] - range[0]) * part / parts);
}

}  // namespace

int Region::slots() const {
  const int along_z = last.Z - first.Z + 1, along_y = last.Y - first.Y + 1;
  return 2 *
         ((low_y ? along_z : 0) + (high_y ? along_z : 0) + (low_z ? along_y : 0) + (high_z ? along_y : 0));
}

RegionPlan::RegionPlan(const Partition& partition, int degree, int rows, int slabs, int rank, int threads)
    : degree_(degree), rows_(rows), slabs_(slabs), shell_(threads), core_(threads) {
  const ElementBlock block = partition.block(rank);
  ElementBlock left = block;  // what is not yet in a region
  const auto add_shared_out = [&](const ElementBlock& elements, std::array<int, 2> ElementBlock::*along) {
    for (int t = 0; t < threads; ++t) {
      ElementBlock part = elements;
      part.*along = {part_begin(elements.*along, threads, t), part_begin(elements.*along, threads, t + 1)};
      add_region(shell_, t, part);
    }
  };
  // Columns and slabs of elements next to other ranks.
  const auto peel = [&](std::array<int, 2> ElementBlock::*across, std::array<int, 2> ElementBlock::*along,
                        int count) {
    for (const bool high : {false, true}) {
      if (high ? (block.*across)[1] == count : (block.*across)[0] == 0) continue;
      if ((left.*across)[0] == (left.*across)[1]) continue;
      ElementBlock layer = left;
      int& edge = high ? (left.*across)[1] : (left.*across)[0];
      edge += high ? -1 : 1;
      (layer.*across)[high ? 0 : 1] = edge;
      add_shared_out(layer, along);
    }
  };
  peel(&ElementBlock::rows, &ElementBlock::slabs, rows);
  peel(&ElementBlock::slabs, &ElementBlock::rows, slabs);
  for (int t = 0; t < threads; ++t)
    add_region(core_, t,
               {{part_begin(left.rows, threads, t), part_begin(left.rows, threads, t + 1)}, left.slabs});
  make_seam_lines(partition, rank);
}

void RegionPlan::add_region(Regions& regions, int thread, const ElementBlock& elements) {
  if (elements.size() == 0) return;
  Region region;
  region.elements = elements;
  region.low_y = elements.rows[0] > 0;
  region.high_y = elements.rows[1] < rows_;
  region.low_z = elements.slabs[0] > 0;
  region.high_z = elements.slabs[1] < slabs_;
  region.first = {elements.rows[0] * degree_, elements.slabs[0] * degree_};
  region.last = {elements.rows[1] * degree_, elements.slabs[1] * degree_};
  region.first_slot = slots_;
  slots_ += region.slots();
  most_rows_ = std::max(most_rows_, elements.rows[1] - elements.rows[0]);
  regions[static_cast<std::size_t>(thread)].push_back(region);
}

void RegionPlan::make_seam_lines(const Partition& partition, int rank) {
  const auto key = [](LinePlace line) { return std::pair(line.Z, line.Y); };
  std::map<std::pair<int, int>, SeamLine> lines;
  // Parts that a rank sends: those of its rows to its shared lines, numbered in this order.
  using PartNumbers = std::map<std::array<int, 4>, int>;
  const auto number_parts = [&](int sender) {
    PartNumbers numbers;
    int number = 0;
    for (const LinePlace& line : partition.shared_lines(sender))
      for (const ElementPlace& row : partition.touching(line))
        if (partition.find_rank(row) == sender) numbers[{line.Y, line.Z, row.ey, row.ez}] = number++;
    return numbers;
  };
  std::map<int, PartNumbers> numbers_of;  // of the ranks that take part
  const auto find_number = [&](int sender, LinePlace line, ElementPlace row) {
    auto& numbers = numbers_of[sender];
    if (numbers.empty()) numbers = number_parts(sender);
    return numbers.at({line.Y, line.Z, row.ey, row.ez});
  };
  const auto find_region = [&](ElementPlace row) -> const Region& {
    for (const Regions* const regions : {&shell_, &core_})
      for (const auto& of_thread : *regions)
        for (const Region& region : of_thread)
          if (region.elements.has(row.ey, row.ez)) return region;
    throw std::logic_error("a row of elements in no region");
  };
  const auto add_line = [&](LinePlace place) {
    if (lines.contains(key(place))) return;
    SeamLine line;
    line.place = place;
    const std::vector<int> sharers = partition.sharers(place);
    line.is_owned = sharers.front() == rank;
    for (const ElementPlace& row : partition.touching(place)) {
      const auto part = static_cast<std::size_t>(line.parts++);
      const int from = partition.find_rank(row);
      line.slot[part] = line.exchanged[part] = -1;
      if (from == rank)
        line.slot[part] =
            find_region(row).find_slot(place, row.ey * degree_ == place.Y, row.ez * degree_ == place.Z);
      if (from != rank) {
        line.exchanged[part] = received_lines();
        graph_.wanted.push_back({from, find_number(from, place, row)});
      } else if (sharers.size() > 1) {
        line.exchanged[part] = find_number(rank, place, row);
        ++graph_.own;
      }
    }
    lines[key(place)] = line;
  };
  for (const Regions* const regions : {&shell_, &core_})
    for (const auto& of_thread : *regions)
      for (const Region& region : of_thread) {
        for (int Z = region.first.Z; Z <= region.last.Z; ++Z) {
          if (region.low_y) add_line({region.first.Y, Z});
          if (region.high_y) add_line({region.last.Y, Z});
        }
        for (int Y = region.first.Y; Y <= region.last.Y; ++Y) {
          if (region.low_z) add_line({Y, region.first.Z});
          if (region.high_z) add_line({Y, region.last.Z});
        }
      }
  for (const auto& [unused, line] : lines) seam_lines_.push_back(line);
}

HaloGraph RegionPlan::graph(std::size_t line_bytes) const {
  HaloGraph graph = graph_;
  graph.line_bytes = line_bytes;
  return graph;
}

}  // namespace easydyn::soil
