#pragma once
// Private to soil: threads of the layered half-space.

#include <Eigen/Core>
#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace easydyn::soil {

/// As many as asked for; 0: one per core.
inline int count_threads(int asked) {
  return asked > 0 ? asked : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// Calls work(i) for i = 0 ... count - 1 on some threads, in any order; rethrows the first error.
/// @throws std::system_error if a thread cannot be created, after the others are done
template <class Work>
void for_each_parallel(Eigen::Index count, int threads, const Work& work) {
  std::atomic<Eigen::Index> next{0};
  std::exception_ptr error;
  std::mutex guard;
  const auto serve = [&] {
    try {
      for (Eigen::Index i = next++; i < count; i = next++) work(i);
    } catch (...) {
      const std::lock_guard lock(guard);
      if (!error) error = std::current_exception();
    }
  };
  std::vector<std::jthread> others;  // joined also where one cannot be created
  for (Eigen::Index t = 1; t < std::min<Eigen::Index>(threads, count); ++t) others.emplace_back(serve);
  serve();
  others.clear();
  if (error) std::rethrow_exception(error);
}

/// Calls work(begin, end) for parts of 0 ... count - 1, in any order.
template <class Work>
void for_each_chunk(Eigen::Index count, int threads, const Work& work) {
  const Eigen::Index size = std::clamp<Eigen::Index>(count / (4 * threads), 1, 64);
  for_each_parallel((count + size - 1) / size, threads,
                    [&](Eigen::Index chunk) { work(size * chunk, std::min(size * (chunk + 1), count)); });
}

}  // namespace easydyn::soil
