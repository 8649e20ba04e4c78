#pragma once

#include <Eigen/Core>
#include <vector>

#include "soil/gll.hpp"
#include "soil/lattice.hpp"
#include "soil/wave_engine.hpp"

namespace easydyn::soil::test {

/// K u written as in the textbook, element by element and quadrature point by quadrature point:
///
///   f_a = sum_q w_q |J| sigma_q grad(phi_a)_q,   sigma = lambda tr(eps) I + 2 mu eps
///
/// @param u  displacement ordered [component][Z][Y][X]
/// @return   f in the same order; free (no springs) outer faces
inline std::vector<double> compute_reference_force(const Lattice& lattice,
                                                   const std::vector<EngineMaterial>& materials,
                                                   const std::vector<double>& u) {
  const GllRule rule(lattice.degree);
  const int N = lattice.degree, n = N + 1;
  const int nX = lattice.nx() * N + 1, nY = lattice.ny() * N + 1, nZ = lattice.nz() * N + 1;
  std::vector<double> f(u.size(), 0.0);
  const auto at = [&](int c, int X, int Y, int Z) {
    return ((static_cast<std::size_t>(c) * nZ + Z) * nY + Y) * nX + X;
  };
  for (int ez = 0; ez < lattice.nz(); ++ez)
    for (int ey = 0; ey < lattice.ny(); ++ey)
      for (int ex = 0; ex < lattice.nx(); ++ex) {
        int material = lattice.layer[ez];
        for (const LatticeBlock& b : lattice.blocks)
          if (b.x[0] <= ex && ex < b.x[1] && b.y[0] <= ey && ey < b.y[1] && b.z[0] <= ez && ez < b.z[1])
            material = b.material;
        if (material < 0) continue;
        const EngineMaterial& m = materials[material];
        const double h[3] = {lattice.x[ex + 1] - lattice.x[ex], lattice.y[ey + 1] - lattice.y[ey],
                             lattice.z[ez + 1] - lattice.z[ez]};
        for (int k = 0; k < n; ++k)
          for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
              const int q[3] = {i, j, k}, first[3] = {ex * N, ey * N, ez * N};
              const auto node = [&](int c, int direction, int a) {  // a-th node on the line through q
                int p[3] = {first[0] + i, first[1] + j, first[2] + k};
                p[direction] = first[direction] + a;
                return at(c, p[0], p[1], p[2]);
              };
              Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();  // (c, d) = d u_c / d x_d
              for (int c = 0; c < 3; ++c)
                for (int d = 0; d < 3; ++d)
                  for (int a = 0; a < n; ++a)
                    gradient(c, d) += rule.derivative(q[d], a) * 2 / h[d] * u[node(c, d, a)];
              const Eigen::Matrix3d strain = (gradient + gradient.transpose()) / 2;
              const Eigen::Matrix3d stress =
                  m.lambda * strain.trace() * Eigen::Matrix3d::Identity() + 2 * m.mu * strain;
              const double volume =
                  rule.weights(i) * rule.weights(j) * rule.weights(k) * h[0] * h[1] * h[2] / 8;
              for (int c = 0; c < 3; ++c)
                for (int d = 0; d < 3; ++d)
                  for (int a = 0; a < n; ++a)
                    f[node(c, d, a)] += volume * stress(c, d) * rule.derivative(q[d], a) * 2 / h[d];
            }
      }
  return f;
}

}  // namespace easydyn::soil::test
