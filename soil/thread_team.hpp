#pragma once

#include <atomic>
#include <functional>
#include <thread>
#include <vector>

namespace easydyn::soil {

/// Threads that wait for work by spinning (with yields), because a time step lasts milliseconds.
class ThreadTeam {
 public:
  explicit ThreadTeam(int size) : size_(size) {
    for (int t = 1; t < size; ++t) threads_.emplace_back([this, t] { serve(t); });
  }
  ~ThreadTeam() {
    work_ = nullptr;
    round_.fetch_add(1, std::memory_order_release);
    for (std::thread& thread : threads_) thread.join();
  }
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  int size() const { return size_; }

  /// Calls work(t) for t = 0 .. size - 1 at once and returns when all are done. `work` must not throw.
  void run(const std::function<void(int)>& work) {
    work_ = &work;
    done_.store(0, std::memory_order_relaxed);
    round_.fetch_add(1, std::memory_order_release);
    work(0);
    wait_until([this] { return done_.load(std::memory_order_acquire) == size_ - 1; });
  }

 private:
  template <class Condition>
  static void wait_until(Condition condition) {
    for (int spins = 0; !condition(); ++spins)
      if (spins > 2000) std::this_thread::yield();
  }
  void serve(int t) {
    for (long seen = 0;; ++seen) {
      wait_until([this, seen] { return round_.load(std::memory_order_acquire) != seen; });
      if (!work_) return;
      (*work_)(t);
      done_.fetch_add(1, std::memory_order_acq_rel);
    }
  }

  int size_;
  const std::function<void(int)>* work_ = nullptr;
  std::atomic<long> round_{0};
  std::atomic<int> done_{0};
  std::vector<std::thread> threads_;
};

}  // namespace easydyn::soil
