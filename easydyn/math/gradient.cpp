#include "easydyn/math/gradient.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <vector>

namespace easydyn {

namespace {

// Blocks of 2^k entries that gradients have given back, per thread.
class BlockPool {
 public:
  Gradient::Entry* take(std::size_t capacity) {
    auto& shelf = shelf_of(capacity);
    if (shelf.empty()) return new Gradient::Entry[capacity];
    Gradient::Entry* block = shelf.back();
    shelf.pop_back();
    return block;
  }
  void give_back(Gradient::Entry* block, std::size_t capacity) noexcept {
    auto& shelf = shelf_of(capacity);
    try {
      shelf.push_back(block);
    } catch (...) {
      delete[] block;
    }
  }
  ~BlockPool() {
    for (auto& shelf : shelves_)
      for (Gradient::Entry* block : shelf) delete[] block;
  }

 private:
  using Shelf = std::vector<Gradient::Entry*>;
  Shelf& shelf_of(std::size_t capacity) { return shelves_[std::countr_zero(capacity) & 31]; }
  std::array<Shelf, 32> shelves_;
};

BlockPool& pool() {
  thread_local BlockPool the_pool;
  return the_pool;
}

}  // namespace

Gradient Gradient::scale_all(double a, Entries A) {
  Gradient g;
  g.reserve(A.size());
  Entry* out = g.data();
  for (const Entry& e : A) *out++ = {e.coordinate, a * e.value};
  g.size_ = static_cast<std::uint32_t>(A.size());
  return g;
}

Gradient Gradient::without(Entries A, int first, int count) {
  Gradient g;
  g.reserve(A.size());
  for (const Entry& e : A)
    if (e.coordinate < first || e.coordinate >= first + count) g.data()[g.size_++] = e;
  return g;
}

Gradient Gradient::merge(double a, Entries A, double b, Entries B) {
  Gradient g;
  g.reserve(A.size() + B.size());
  const Entry *i = A.begin(), *j = B.begin();
  Entry* out = g.data();
  while (i != A.end() || j != B.end()) {
    if (j == B.end() || (i != A.end() && i->coordinate < j->coordinate)) {
      *out++ = {i->coordinate, a * i->value};
      ++i;
    } else if (i == A.end() || j->coordinate < i->coordinate) {
      *out++ = {j->coordinate, b * j->value};
      ++j;
    } else {
      *out++ = {i->coordinate, a * i->value + b * j->value};
      ++i;
      ++j;
    }
  }
  g.size_ = static_cast<std::uint32_t>(out - g.data());
  return g;
}

void Gradient::append_all(const Gradient& other) {
  reserve(other.size_);
  std::copy(other.begin(), other.end(), data());
  size_ = other.size_;
}

void Gradient::take_all(Gradient& other) noexcept {
  if (other.is_in_place()) {
    std::copy(other.begin(), other.end(), in_place_);
  } else {
    block_ = other.block_;
    capacity_ = other.capacity_;
    other.capacity_ = in_place_capacity;
  }
  size_ = other.size_;
  other.size_ = 0;
}

void Gradient::reserve(std::size_t capacity) {
  size_ = 0;
  if (capacity <= capacity_) return;
  release();
  capacity = std::bit_ceil(capacity);
  block_ = pool().take(capacity);
  capacity_ = static_cast<std::uint32_t>(capacity);
}

void Gradient::give_back() noexcept {
  pool().give_back(block_, capacity_);
  capacity_ = in_place_capacity;
}

}  // namespace easydyn
