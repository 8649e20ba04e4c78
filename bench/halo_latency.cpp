// Time of one exchange between neighbouring ranks, by size: mpirun -n 2 build/bench/bin/halo_latency
//
// The ranks form a ring; each sends as many lines to the next one as it receives from the one before.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "soil/parallel_run.hpp"

int main() {
  using namespace easydyn::soil;
  const ParallelRun parallel;
  Ranks* const ranks = parallel.ranks();
  if (!ranks) {
    fmt::print(stderr, "halo_latency: needs at least two ranks: mpirun -n 2 halo_latency\n");
    return 2;
  }
  fmt::print("{:>8} {:>12} {:>14}   ({} ranks; median of 300)\n", "lines", "bytes", "exchange [us]",
             ranks->size());
  for (const int lines : {1, 10, 100, 1000}) {
    HaloGraph graph;
    graph.line_bytes = 3 * 4 * 48 * sizeof(float);  // degree 4, 47 elements along x, single precision
    graph.own = lines;
    const int before = (ranks->rank() + ranks->size() - 1) % ranks->size();
    for (int line = 0; line < lines; ++line) graph.wanted.push_back({before, line});
    std::vector<char> own(graph.line_bytes * lines, 1), received(own.size(), 0);
    const std::unique_ptr<Halo> halo = ranks->make_halo(graph);
    std::vector<double> seconds;
    for (int repeat = 0; repeat < 300; ++repeat) {
      const auto begin = std::chrono::steady_clock::now();
      halo->begin(own.data(), received.data());
      halo->end();
      seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    std::nth_element(seconds.begin(), seconds.begin() + 150, seconds.end());
    fmt::print("{:>8} {:>12} {:>14.1f}\n", lines, own.size(), 1e6 * seconds[150]);
  }
  return 0;
}
