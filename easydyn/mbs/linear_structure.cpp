#include "easydyn/mbs/linear_structure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "easydyn/error.hpp"

namespace easydyn {

void PortShape::add(int coordinate, double N, double dN) {
  if (count == capacity)
    throw ModelError(fmt::format("a port touches at most {} coordinates of a structure", capacity));
  const auto i = static_cast<std::size_t>(count++);
  index[i] = coordinate;
  value[i] = N;
  gradient[i] = dN;
}

LinearStructure::LinearStructure(std::string name, SparseMatrix M, SparseMatrix C, SparseMatrix K)
    : name_(std::move(name)), M_(std::move(M)), C_(std::move(C)), K_(std::move(K)) {
  const char* letters = "MCK";
  const SparseMatrix* matrices[] = {&M_, &C_, &K_};
  for (int i = 0; i < 3; ++i) {
    const SparseMatrix& A = *matrices[i];
    if (A.rows() != M_.rows() || A.cols() != M_.rows())
      throw ModelError(fmt::format("structure \"{}\": {} is {} x {}, must be {} x {} as M", name_, letters[i],
                                   A.rows(), A.cols(), M_.rows(), M_.rows()));
    double largest = 0, asymmetry = 0;
    const SparseMatrix At = A.transpose();
    const SparseMatrix difference = A - At;
    for (int row = 0; row < A.outerSize(); ++row) {
      for (SparseMatrix::InnerIterator it(A, row); it; ++it) {
        if (!std::isfinite(it.value()))
          throw ModelError(fmt::format("structure \"{}\": {}({}, {}) = {}, must be finite", name_, letters[i],
                                       row, it.col(), it.value()));
        largest = std::max(largest, std::abs(it.value()));
        half_bandwidth_ = std::max(half_bandwidth_, std::abs(static_cast<int>(it.col()) - row));
      }
      for (SparseMatrix::InnerIterator it(difference, row); it; ++it)
        asymmetry = std::max(asymmetry, std::abs(it.value()));
    }
    if (asymmetry > 1e-9 * largest)
      throw ModelError(fmt::format("structure \"{}\": {} differs from its transpose by {} (largest entry {})",
                                   name_, letters[i], asymmetry, largest));
  }
}

}  // namespace easydyn
