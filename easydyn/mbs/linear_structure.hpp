#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <string>

namespace easydyn {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Where a linear structure is touched: the row N of shape functions at a place, and its derivative with
/// respect to the place (per metre), on a few of the structure's coordinates.
struct PortShape {
  static constexpr int capacity = 8;
  int count = 0;
  std::array<int, capacity> index{};        ///< coordinate within the structure
  std::array<double, capacity> value{};     ///< N
  std::array<double, capacity> gradient{};  ///< N' = dN/dx [1/m]

  /// @throws ModelError beyond `capacity` entries
  void add(int coordinate, double N, double dN = 0);
};

/// What a structure does at a port: displacement N q, velocity N qd of the material point, slope N' q.
/// A contact that moves along the structure at speed v sees the velocity `velocity + v * slope`.
struct PortMotion {
  double displacement = 0, velocity = 0, slope = 0;
};

/// A block of coordinates with constant matrices, M s.. + C s. + K s = sum_l N_l^T F_l : a track, a bridge.
///
/// The rest of the system touches it through ports only (`System::touch`), so that implicit integrators keep
/// one factorisation of the block per step size and treat the few port forces as unknowns.
/// Number the coordinates so that the bandwidth is small: cost and memory are proportional to it.
class LinearStructure {
 public:
  /// @param M, C, K  n x n, symmetric, finite [N s^2/m, N s/m, N/m or rotational equivalents]
  /// @throws ModelError if the sizes disagree or a matrix is not symmetric (1e-9 relative) or not finite
  LinearStructure(std::string name, SparseMatrix M, SparseMatrix C, SparseMatrix K);

  const std::string& name() const { return name_; }
  int size() const { return static_cast<int>(M_.rows()); }
  const SparseMatrix& M() const { return M_; }
  const SparseMatrix& C() const { return C_; }
  const SparseMatrix& K() const { return K_; }
  /// Largest |i - j| with a nonzero in M, C or K.
  int half_bandwidth() const { return half_bandwidth_; }

 private:
  std::string name_;
  SparseMatrix M_, C_, K_;
  int half_bandwidth_ = 0;
};

}  // namespace easydyn
