#pragma once

#include <atomic>
#include <functional>
#include <thread>
#include <vector>

namespace easydyn::soil {

/// Threads that wait for work: by spinning for some microseconds, because a time step lasts milliseconds, then
/// asleep, so that a machine busy with other work is not kept from doing it.
class ThreadTeam {
 public:
  explicit ThreadTeam(int size) : size_(size) {
    for (int t = 1; t < size; ++t) threads_.emplace_back([this, t] { serve(t); });
  }
  ~ThreadTeam() {
    work_ = nullptr;
    start_round();
    for (std::thread& thread : threads_) thread.join();
  }
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  int size() const { return size_; }

  /// Calls work(t) for t = 0 .. size - 1 at once and returns when all are done. `work` must not throw.
  void run(const std::function<void(int)>& work) {
    work_ = &work;
    busy_.store(size_ - 1, std::memory_order_relaxed);
    start_round();
    work(0);
    for (int busy = busy_.load(std::memory_order_acquire); busy != 0;) busy = wait_for_change(busy_, busy);
  }

 private:
  void start_round() {
    round_.fetch_add(1, std::memory_order_release);
    round_.notify_all();
  }
  /// The new value of `variable` once it is no longer `old`.
  static int wait_for_change(const std::atomic<int>& variable, int old) {
    for (int spins = 0; spins < 4000; ++spins)
      if (const int value = variable.load(std::memory_order_acquire); value != old) return value;
    variable.wait(old, std::memory_order_acquire);
    return variable.load(std::memory_order_acquire);
  }
  void serve(int t) {
    for (int round = 0;;) {
      round = wait_for_change(round_, round);
      if (!work_) return;
      (*work_)(t);
      if (busy_.fetch_sub(1, std::memory_order_acq_rel) == 1) busy_.notify_one();
    }
  }

  int size_;
  const std::function<void(int)>* work_ = nullptr;
  std::atomic<int> round_{0};  // may wrap around: only its change is looked at
  std::atomic<int> busy_{0};   // threads at work besides the caller's
  std::vector<std::thread> threads_;
};

}  // namespace easydyn::soil
