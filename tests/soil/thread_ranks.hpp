#pragma once

#include <algorithm>
#include <barrier>
#include <cstring>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "soil/ranks.hpp"

namespace easydyn::soil::test {

/// Ranks that are threads of one process: what ranks do to each other, without MPI.
class ThreadRanks {
 public:
  /// Calls work(rank) on `count` threads at once.
  static void run(int count, const std::function<void(Ranks&)>& work) {
    ThreadRanks all(count);
    std::vector<std::thread> threads;
    for (int r = 0; r < count; ++r)
      threads.emplace_back([&all, &work, r] {
        Rank rank(all, r);
        work(rank);
      });
    for (std::thread& thread : threads) thread.join();
  }

 private:
  explicit ThreadRanks(int count) : size_(count), barrier_(count), shown_(count) {}

  // Shows everybody's pointer to everybody, while `look` runs.
  template <class Look>
  void meet(int rank, const void* data, const Look& look) {
    shown_[rank] = data;
    barrier_.arrive_and_wait();
    look();
    barrier_.arrive_and_wait();
  }

  class Exchange : public Halo {
   public:
    Exchange(ThreadRanks& all, int rank, const HaloGraph& graph) : all_(all), rank_(rank), graph_(graph) {}
    void begin(const void* own, void* received) override {
      own_ = own;
      received_ = static_cast<char*>(received);
    }
    void end() override {
      all_.meet(rank_, own_, [&] {
        for (std::size_t i = 0; i < graph_.wanted.size(); ++i)
          std::memcpy(received_ + i * graph_.line_bytes,
                      static_cast<const char*>(all_.shown_[graph_.wanted[i].rank]) +
                          graph_.wanted[i].number * graph_.line_bytes,
                      graph_.line_bytes);
      });
    }
    void make_progress() override {}

   private:
    ThreadRanks& all_;
    int rank_;
    HaloGraph graph_;
    const void* own_ = nullptr;
    char* received_ = nullptr;
  };

  class Rank : public Ranks {
   public:
    Rank(ThreadRanks& all, int rank) : all_(all), rank_(rank) {}
    int rank() const override { return rank_; }
    int size() const override { return all_.size_; }
    int on_this_node() const override { return all_.size_; }
    void sum(double* values, std::size_t count) override {
      combine(values, count, [](double a, double b) { return a + b; });
    }
    void maximise(double* values, std::size_t count) override {
      combine(values, count, [](double a, double b) { return std::max(a, b); });
    }
    void broadcast(void* data, std::size_t bytes, int from) override {
      all_.meet(rank_, data, [&] {
        if (rank_ != from) std::memcpy(data, all_.shown_[from], bytes);
      });
    }
    std::unique_ptr<Halo> make_halo(const HaloGraph& graph) override {
      return std::make_unique<Exchange>(all_, rank_, graph);
    }

   private:
    template <class Operation>
    void combine(double* values, std::size_t count, const Operation& operation) {
      std::vector<double> result(count);
      all_.meet(rank_, values, [&] {
        for (int r = 0; r < all_.size_; ++r) {
          const auto* other = static_cast<const double*>(all_.shown_[r]);
          for (std::size_t i = 0; i < count; ++i)
            result[i] = r == 0 ? other[i] : operation(result[i], other[i]);
        }
      });
      std::copy(result.begin(), result.end(), values);
    }
    ThreadRanks& all_;
    int rank_;
  };

  int size_;
  std::barrier<> barrier_;
  std::vector<const void*> shown_;
};

}  // namespace easydyn::soil::test
