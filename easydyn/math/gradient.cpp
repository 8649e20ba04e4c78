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

Gradient Gradient::unit(int coordinate) {
  Gradient g;
  g.data_[0] = {coordinate, 1.0};
  g.size_ = 1;
  return g;
}

Gradient Gradient::scale(double a, const Gradient& A) {
  Gradient g;
  g.reserve(A.size_);
  for (std::size_t i = 0; i < A.size_; ++i) g.data_[i] = {A.data_[i].coordinate, a * A.data_[i].value};
  g.size_ = A.size_;
  return g;
}

Gradient Gradient::without(const Gradient& A, int first, int count) {
  Gradient g;
  g.reserve(A.size_);
  for (const Entry& e : A)
    if (e.coordinate < first || e.coordinate >= first + count) g.data_[g.size_++] = e;
  return g;
}

Gradient Gradient::combine(double a, const Gradient& A, double b, const Gradient& B) {
  if (B.empty()) return scale(a, A);
  if (A.empty()) return scale(b, B);
  Gradient g;
  g.reserve(A.size_ + B.size_);
  const Entry *i = A.begin(), *j = B.begin();
  Entry* out = g.data_;
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
  g.size_ = static_cast<std::size_t>(out - g.data_);
  return g;
}

void Gradient::assign(const Gradient& other) {
  reserve(other.size_);
  std::copy(other.begin(), other.end(), data_);
  size_ = other.size_;
}

void Gradient::take(Gradient& other) noexcept {
  if (other.capacity_ > inline_capacity) {
    data_ = other.data_;
    capacity_ = other.capacity_;
    size_ = other.size_;
    other.data_ = other.inline_;
    other.capacity_ = inline_capacity;
  } else {
    std::copy(other.begin(), other.end(), data_);
    size_ = other.size_;
  }
  other.size_ = 0;
}

void Gradient::reserve(std::size_t capacity) {
  size_ = 0;
  if (capacity <= capacity_) return;
  release();
  capacity_ = std::bit_ceil(capacity);
  data_ = pool().take(capacity_);
}

void Gradient::release() noexcept {
  if (capacity_ > inline_capacity) pool().give_back(data_, capacity_);
  data_ = inline_;
  capacity_ = inline_capacity;
  size_ = 0;
}

}  // namespace easydyn
