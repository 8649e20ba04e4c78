#pragma once

#include <cstddef>
#include <cstring>
#include <new>
#include <vector>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace easydyn::soil {

/// Width of the vector registers that the compiler may use.
#if defined(__AVX512F__)
inline constexpr int simd_bytes = 64;
#elif defined(__AVX__)
inline constexpr int simd_bytes = 32;
#else
inline constexpr int simd_bytes = 16;
#endif

/// As many numbers of type T as fit a vector register (vector extension of GCC and Clang), with + - * /
/// between packs and with scalars.
template <class T>
struct Pack {
  static constexpr int lanes = simd_bytes / static_cast<int>(sizeof(T));
  typedef T type __attribute__((vector_size(simd_bytes)));
};
template <class T>
using pack = typename Pack<T>::type;

/// Load from and store to any address (alignment of T).
template <class T>
inline __attribute__((always_inline)) pack<T> load_pack(const T* from) {
  pack<T> value;
  std::memcpy(&value, from, sizeof value);
  return value;
}
template <class T>
inline __attribute__((always_inline)) void store_pack(T* to, pack<T> value) {
  std::memcpy(to, &value, sizeof value);
}

/// While it lives, this thread treats subnormal numbers as zero: ahead of a wave front the field fades
/// through them, and arithmetic on them is a hundred times slower.
class FlushSubnormals {
 public:
#if defined(__SSE__)
  FlushSubnormals() : before_(_mm_getcsr()) {
    _mm_setcsr(before_ | 0x8040u);
  }
  ~FlushSubnormals() {
    _mm_setcsr(before_);
  }
#else
  FlushSubnormals() = default;
  ~FlushSubnormals() {}
#endif
  FlushSubnormals(const FlushSubnormals&) = delete;
  FlushSubnormals& operator=(const FlushSubnormals&) = delete;

 private:
  unsigned before_ = 0;
};

/// Allocator for arrays that start on a cache line.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new (n * sizeof(T), std::align_val_t{64})); }
  void deallocate(T* p, std::size_t) { ::operator delete (p, std::align_val_t{64}); }
  bool operator==(const CacheLineAllocator&) const { return true; }
};
template <class T>
using AlignedVector = std::vector<T, CacheLineAllocator<T>>;

}  // namespace easydyn::soil
