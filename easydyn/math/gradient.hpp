#pragma once

#include <cstddef>
#include <cstdint>

namespace easydyn {

/// Sparse gradient of an expression with respect to the coordinates q: entries (i, df/dq_i), sorted by i.
///
/// Most expressions of a mechanism depend on one to four coordinates: these are stored in place. Longer
/// gradients take a block from a per-thread pool, so that after the first evaluation nothing is allocated.
/// The gradients without and with one entry, which nearly all motions have, are treated in this header.
class Gradient {
 public:
  struct Entry {
    int coordinate;  ///< i
    double value;    ///< df/dq_i
  };
  /// Entries in a row, sorted as those of a gradient.
  struct Entries {
    const Entry* data;
    std::size_t count;
    const Entry* begin() const { return data; }
    const Entry* end() const { return data + count; }
    std::size_t size() const { return count; }
    bool empty() const { return count == 0; }
    const Entry& operator[](std::size_t i) const { return data[i]; }
  };

  Gradient() noexcept {}  // NOLINT: entries beyond the size have no value
  Gradient(const Gradient& other) { append(other); }
  Gradient(Gradient&& other) noexcept { take(other); }
  Gradient& operator=(const Gradient& other) {
    if (this != &other) {
      size_ = 0;
      append(other);
    }
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
  static Gradient unit(int coordinate) { return Gradient(Entry{coordinate, 1.0}); }
  /// a A + b B.
  static Gradient combine(double a, Entries A, double b, Entries B) {
    if (B.empty()) return scale(a, A);
    if (A.empty()) return scale(b, B);
    if (A.size() == 1 && B.size() == 1 && A[0].coordinate == B[0].coordinate)
      return Gradient(Entry{A[0].coordinate, a * A[0].value + b * B[0].value});
    return merge(a, A, b, B);
  }
  /// a A.
  static Gradient scale(double a, Entries A) {
    if (A.empty()) return Gradient();
    if (A.size() == 1) return Gradient(Entry{A[0].coordinate, a * A[0].value});
    return scale_all(a, A);
  }
  /// A without the entries of `count` coordinates from `first` on.
  static Gradient without(Entries A, int first, int count);

  const Entry* begin() const { return is_in_place() ? in_place_ : block_; }
  const Entry* end() const { return begin() + size_; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  operator Entries() const { return {begin(), size_}; }  // NOLINT: a gradient is its entries

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
  static constexpr std::uint32_t in_place_capacity = 4;

  explicit Gradient(Entry only) noexcept : size_(1) { in_place_[0] = only; }
  bool is_in_place() const { return capacity_ == in_place_capacity; }
  Entry* data() { return is_in_place() ? in_place_ : block_; }
  // The content of another; this one is empty.
  void append(const Gradient& other) {
    if (other.size_ == 1)
      data()[size_++] = *other.begin();
    else if (other.size_ > 1)
      append_all(other);
  }
  void take(Gradient& other) noexcept {
    if (other.size_ == 1 && other.is_in_place()) {
      in_place_[0] = other.in_place_[0];
      size_ = 1;
    } else if (other.size_ > 0) {
      take_all(other);
    }
  }
  void release() noexcept {
    if (!is_in_place()) give_back();
    size_ = 0;
  }

  static Gradient merge(double a, Entries A, double b, Entries B);
  static Gradient scale_all(double a, Entries A);
  void append_all(const Gradient& other);
  void take_all(Gradient& other) noexcept;
  void give_back() noexcept;
  void reserve(std::size_t capacity);  ///< discards the content

  union {
    Entry in_place_[in_place_capacity];
    Entry* block_;
  };
  std::uint32_t size_ = 0;
  std::uint32_t capacity_ = in_place_capacity;  // beyond it, the entries are in a block
};

}  // namespace easydyn
