#pragma once

#include <cstddef>

namespace easydyn {

/// Sparse gradient of an expression with respect to the coordinates q: entries (i, df/dq_i), sorted by i.
///
/// Most expressions of a mechanism depend on one to four coordinates: these are stored in place. Longer
/// gradients take a block from a per-thread pool, so that after the first evaluation nothing is allocated.
class Gradient {
 public:
  struct Entry {
    int coordinate;  ///< i
    double value;    ///< df/dq_i
  };

  Gradient() noexcept : data_(inline_) {}
  Gradient(const Gradient& other) : Gradient() { assign(other); }
  Gradient(Gradient&& other) noexcept : Gradient() { take(other); }
  Gradient& operator=(const Gradient& other) {
    if (this != &other) assign(other);
    return *this;
  }
  Gradient& operator=(Gradient&& other) noexcept {
    if (this != &other) {
      release();
      take(other);
    }
    return *this;
  }
  ~Gradient() { release(); }

  /// The gradient of q_i itself.
  static Gradient unit(int coordinate);
  /// a A + b B.
  static Gradient combine(double a, const Gradient& A, double b, const Gradient& B);
  /// a A.
  static Gradient scale(double a, const Gradient& A);
  /// A without the entries of `count` coordinates from `first` on.
  static Gradient without(const Gradient& A, int first, int count);

  const Entry* begin() const { return data_; }
  const Entry* end() const { return data_ + size_; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

  /// df/dq_i, 0 where there is no entry.
  double operator[](int coordinate) const {
    for (const Entry& e : *this)
      if (e.coordinate == coordinate) return e.value;
    return 0;
  }

  /// sum_i (df/dq_i) x_i for a vector x indexed by coordinate.
  template <class Vector>
  double dot(const Vector& x) const {
    double sum = 0;
    for (const Entry& e : *this) sum += e.value * x[e.coordinate];
    return sum;
  }

 private:
  static constexpr std::size_t inline_capacity = 4;

  void assign(const Gradient& other);
  void take(Gradient& other) noexcept;
  void reserve(std::size_t capacity);  ///< discards the content
  void release() noexcept;

  Entry inline_[inline_capacity];  // declared first: data_ points into it
  Entry* data_;
  std::size_t size_ = 0;
  std::size_t capacity_ = inline_capacity;
};

}  // namespace easydyn
