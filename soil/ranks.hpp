#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace easydyn::soil {

/// Exchange of blocks of bytes ("lines") between ranks: each rank has lines of its own, numbered from 0, and
/// receives copies of some lines of others, in the order of `wanted`.
struct HaloGraph {
  struct Line {
    int rank = 0, number = 0;  ///< number among that rank's own lines
  };
  std::size_t line_bytes = 0;
  int own = 0;
  std::vector<Line> wanted;
};

/// One kind of exchange, made once and used in every step.
class Halo {
 public:
  virtual ~Halo() = default;
  /// Starts to send `own` lines and to receive the wanted ones into `received`; neither may be touched before end().
  virtual void begin(const void* own, void* received) = 0;
  virtual void end() = 0;
  /// Gives what is on its way a chance to move on while this rank computes.
  virtual void make_progress() = 0;
};

/// The ranks of a run: processes that each hold a part of the ground. All functions but the plain numbers are to be
/// called by all ranks in the same order; results are the same bits on every rank.
class Ranks {
 public:
  virtual ~Ranks() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  virtual int on_this_node() const = 0;  ///< ranks that share this machine's cores and memory

  virtual void sum(double* values, std::size_t count) = 0;       ///< of all ranks, in place
  virtual void maximise(double* values, std::size_t count) = 0;  ///< over all ranks, in place
  virtual void broadcast(void* data, std::size_t bytes, int from) = 0;
  virtual std::unique_ptr<Halo> make_halo(const HaloGraph& graph) = 0;
};

}  // namespace easydyn::soil
