#include "easydyn/mbs/flexible_model.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>

#include "easydyn/require.hpp"

namespace easydyn {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Triplets = std::vector<Eigen::Triplet<double>>;

namespace {

// Rigid motions as columns: displacements of places with 3 or 6 rows each under unit translations and rotations.
MatrixXd rigid_motions(const Eigen::Matrix3Xd& places, int rows) {
  MatrixXd R = MatrixXd::Zero(places.cols() * rows, 6);
  for (Index i = 0; i < places.cols(); ++i) {
    for (Index axis = 0; axis < 3; ++axis) {
      R(i * rows + axis, axis) = 1;
      R.block<3, 1>(i * rows, 3 + axis) = Vector3d::Unit(axis).cross(Vector3d(places.col(i)));
      if (rows == 6) R(i * rows + 3 + axis, 3 + axis) = 1;
    }
  }
  return R;
}

bool is_symmetric(const SparseMatrix& A) {
  return A.rows() == A.cols() && (A - SparseMatrix(A.transpose())).norm() <= 1e-9 * A.norm();
}

}  // namespace

void FlexibleModel::check(const std::string& object) const {
  const Index n = node_count();
  if (n == 0) throw ModelError(fmt::format("{}: no nodes", object));
  if (K.rows() != 3 * n && K.rows() != 6 * n)
    throw ModelError(fmt::format("{}: K is {} x {}, must be {} or {} square for {} nodes", object, K.rows(),
                                 K.cols(), 3 * n, 6 * n, n));
  if (!is_symmetric(K)) throw ModelError(fmt::format("{}: K is not symmetric", object));
  if (point_rows != 3 && point_rows != 6)
    throw ModelError(fmt::format("{}: {} rows per point, must be 3 or 6", object, point_rows));
  if (N.rows() != point_rows * points.cols() || N.cols() != K.rows() || M.rows() != N.rows())
    throw ModelError(fmt::format("{}: {} points with {} rows, N {} x {}, M {} x {}: sizes disagree", object,
                                 points.cols(), point_rows, N.rows(), N.cols(), M.rows(), M.cols()));
  if (!is_symmetric(M)) throw ModelError(fmt::format("{}: M is not symmetric", object));
  if (!nodes.allFinite() || !points.allFinite() || !std::isfinite(K.norm()) || !std::isfinite(M.norm()))
    throw ModelError(fmt::format("{}: nodes, points, M and K must be finite", object));

  const MatrixXd of_nodes = rigid_motions(nodes, node_rows());
  if (K.norm() > 0 && (K * of_nodes).norm() > 1e-6 * K.norm() * of_nodes.norm())
    throw ModelError(
        fmt::format("{}: K resists rigid motion; give it free in space, with the same axes and "
                    "units as the nodes",
                    object));
  const MatrixXd of_points = rigid_motions(points, point_rows);
  if ((N * of_nodes - of_points).norm() > 1e-6 * of_points.norm())
    throw ModelError(fmt::format("{}: N does not carry the points along in rigid motion", object));
  const MatrixXd inertia = of_points.transpose() * (M * of_points);
  const double mass = inertia(0, 0);
  require_positive(object, "mass", mass, "kg");
  if ((inertia.topLeftCorner<3, 3>() - mass * Eigen::Matrix3d::Identity()).norm() > 1e-6 * mass)
    throw ModelError(fmt::format("{}: M weighs {:g}, {:g}, {:g} kg along x, y, z: not that of a free body",
                                 object, mass, inertia(1, 1), inertia(2, 2)));
}

FlexibleModel FlexibleModel::imported(const Eigen::Matrix3Xd& nodes, const SparseMatrix& M,
                                      const SparseMatrix& K) {
  FlexibleModel model;
  model.nodes = model.points = nodes;
  model.M = M;
  model.K = K;
  model.N.resize(K.rows(), K.rows());
  model.N.setIdentity();
  model.point_rows = model.node_rows();
  model.check("imported flexible body");
  return model;
}

BeamData BeamData::rectangle(double length, int elements, double E, double G, double density, double b,
                             double h) {
  const double A = b * h, s = std::min(b, h), l = std::max(b, h), ratio = s / l;
  const double J = l * s * s * s * (1.0 / 3 - 0.21 * ratio * (1 - std::pow(ratio, 4) / 12));
  return {.length = length,
          .elements = elements,
          .mass_per_length = density * A,
          .EA = E * A,
          .EIy = E * b * h * h * h / 12,
          .EIz = E * h * b * b * b / 12,
          .GJ = G * J,
          .gyration_y = h / std::sqrt(12.0),
          .gyration_z = b / std::sqrt(12.0)};
}

FlexibleModel beam_model(const BeamData& data) {
  require_positive("beam", "length", data.length, "m");
  require(data.elements >= 1, "beam", "elements", data.elements, "", ">= 1");
  require_positive("beam", "mass per length", data.mass_per_length, "kg/m");
  require_positive("beam", "EA", data.EA, "N");
  require_positive("beam", "EIy", data.EIy, "N m^2");
  require_positive("beam", "EIz", data.EIz, "N m^2");
  require_positive("beam", "GJ", data.GJ, "N m^2");
  require_positive("beam", "radius of gyration about y", data.gyration_y, "m");
  require_positive("beam", "radius of gyration about z", data.gyration_z, "m");

  constexpr int stations = 4, corners = 4, rows = 6;
  constexpr double place[stations] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                      0.8611363115940526},
                   weight[stations] = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                       0.3478548451374538};
  const int nodes = data.elements + 1, n_points = data.elements * stations * corners;
  const double L = data.length / data.elements;
  FlexibleModel model;
  model.nodes = Eigen::Matrix3Xd::Zero(3, nodes);
  for (int i = 0; i < nodes; ++i) model.nodes(0, i) = i * L;
  model.points = Eigen::Matrix3Xd::Zero(3, n_points);
  Triplets K, N, M;

  for (int e = 0; e < data.elements; ++e) {
    const int a = e * rows, b = a + rows;  // first displacement of the left and of the right node
    const auto stiffness = [&](const std::vector<int>& dofs, const MatrixXd& k) {
      for (std::size_t i = 0; i < dofs.size(); ++i)
        for (std::size_t j = 0; j < dofs.size(); ++j)
          K.emplace_back(dofs[i], dofs[j], k(static_cast<Index>(i), static_cast<Index>(j)));
    };
    const Eigen::Matrix2d bar{{1, -1}, {-1, 1}};
    stiffness({a, b}, data.EA / L * bar);
    stiffness({a + 3, b + 3}, data.GJ / L * bar);
    // v, rotation about z; in the x-z plane w, -rotation about y
    const Eigen::Matrix4d bending{{12, 6 * L, -12, 6 * L},
                                  {6 * L, 4 * L * L, -6 * L, 2 * L * L},
                                  {-12, -6 * L, 12, -6 * L},
                                  {6 * L, 2 * L * L, -6 * L, 4 * L * L}};
    const Eigen::Vector4d sign(1, -1, 1, -1);
    stiffness({a + 1, a + 5, b + 1, b + 5}, data.EIz / (L * L * L) * bending);
    stiffness({a + 2, a + 4, b + 2, b + 4},
              data.EIy / (L * L * L) * sign.asDiagonal() * bending * sign.asDiagonal());

    for (int s = 0; s < stations; ++s) {
      const double t = 0.5 * (1 + place[s]), u = 1 - t;  // along the element, 0 to 1
      const double H[4] = {u * u * (1 + 2 * t), L * t * u * u, t * t * (3 - 2 * t), -L * t * t * u};
      const double dH[4] = {-6 * t * u / L, u * (u - 2 * t), 6 * t * u / L, t * (t - 2 * u)};
      for (int c = 0; c < corners; ++c) {
        const double side = c % 2 ? 1 : -1;
        const double y = c < 2 ? side * std::sqrt(2.0) * data.gyration_z : 0,
                     z = c < 2 ? 0 : side * std::sqrt(2.0) * data.gyration_y;
        const int p = (e * stations + s) * corners + c, row = 3 * p;
        model.points.col(p) << (e + t) * L, y, z;
        // centre line, and the section that turns with it: u_P = u + theta x (0, y, z)
        N.emplace_back(row, a, u);
        N.emplace_back(row, b, t);
        const int v[4] = {a + 1, a + 5, b + 1, b + 5}, w[4] = {a + 2, a + 4, b + 2, b + 4};
        for (int i = 0; i < 4; ++i) {
          N.emplace_back(row, v[i], -y * dH[i]);
          N.emplace_back(row, w[i], -z * dH[i] * sign[i]);
          N.emplace_back(row + 1, v[i], H[i]);
          N.emplace_back(row + 2, w[i], H[i] * sign[i]);
        }
        N.emplace_back(row + 1, a + 3, -z * u);
        N.emplace_back(row + 1, b + 3, -z * t);
        N.emplace_back(row + 2, a + 3, y * u);
        N.emplace_back(row + 2, b + 3, y * t);
        const double mass = 0.5 * weight[s] * data.mass_per_length * L / corners;
        for (int i = 0; i < 3; ++i) M.emplace_back(row + i, row + i, mass);
      }
    }
  }
  const auto assemble = [](Index r, Index c, const Triplets& entries) {
    SparseMatrix A(r, c);
    A.setFromTriplets(entries.begin(), entries.end());
    return A;
  };
  model.K = assemble(nodes * rows, nodes * rows, K);
  model.N = assemble(3 * n_points, nodes * rows, N);
  model.M = assemble(3 * n_points, 3 * n_points, M);
  return model;
}

MatrixXd compute_shapes(const FlexibleModel& model, const ShapeOptions& options) {
  const int rows = model.node_rows(), size = static_cast<int>(model.K.rows());
  enum Role : char { free, clamped, interface };
  std::vector<Role> role(static_cast<std::size_t>(size), free);
  const auto set = [&](int dof, Role r, const char* what) {
    if (dof < 0 || dof >= size)
      throw ModelError(
          fmt::format("flexible body: {} displacement {}, must be 0 to {}", what, dof, size - 1));
    if (role[static_cast<std::size_t>(dof)] != free && r == interface)
      throw ModelError(fmt::format("flexible body: displacement {} is both clamped and interface", dof));
    role[static_cast<std::size_t>(dof)] = r;
  };
  for (const int node : options.clamped_nodes) {
    if (node < 0 || node >= model.node_count())
      throw ModelError(
          fmt::format("flexible body: clamped node {}, must be 0 to {}", node, model.node_count() - 1));
    for (int i = 0; i < rows; ++i) set(node * rows + i, clamped, "clamped");
  }
  for (const int dof : options.clamped_dofs) set(dof, clamped, "clamped");
  for (const int dof : options.interface_dofs) set(dof, interface, "interface");

  std::vector<int> inner;
  for (int i = 0; i < size; ++i)
    if (role[static_cast<std::size_t>(i)] == free) inner.push_back(i);
  const auto n = static_cast<Index>(inner.size());
  const auto n_interface = static_cast<Index>(options.interface_dofs.size());
  if (options.modes < -1 || options.modes > n)
    throw ModelError(fmt::format("flexible body: {} modes, must be 0 to {} (or -1: all)", options.modes, n));
  const Index n_modes = options.modes < 0 ? n : options.modes;

  const MatrixXd K(model.K), M = MatrixXd(SparseMatrix(model.N.transpose()) * model.M * model.N);
  const MatrixXd K_inner = K(inner, inner), M_inner = M(inner, inner);
  MatrixXd shapes = MatrixXd::Zero(size, n_interface + n_modes);
  if (n == 0) {
    for (Index j = 0; j < n_interface; ++j)
      shapes(options.interface_dofs[static_cast<std::size_t>(j)], j) = 1;
    return shapes;
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> eigen(K_inner, M_inner);
  if (eigen.info() != Eigen::Success)
    throw ModelError("flexible body: its mass matrix is not positive definite");
  if (!(eigen.eigenvalues()[0] > 1e-9 * eigen.eigenvalues()[n - 1] * 1e-3))
    throw ModelError(
        "flexible body: what is clamped does not hold it in its floating frame; clamp a node, or six "
        "displacements");
  // Unit displacement of one interface displacement, the others and the clamped ones held.
  const Eigen::LDLT<MatrixXd> held(K_inner);
  for (Index j = 0; j < n_interface; ++j) {
    const int dof = options.interface_dofs[static_cast<std::size_t>(j)];
    shapes(dof, j) = 1;
    shapes(inner, Eigen::seqN(j, 1)) = -held.solve(K(inner, std::vector<int>{dof}));
  }
  shapes(inner, Eigen::seqN(n_interface, n_modes)) = eigen.eigenvectors().leftCols(n_modes);
  return shapes;
}

}  // namespace easydyn
