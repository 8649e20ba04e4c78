#include "easydyn/mbs/flexible_body.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>

#include "easydyn/mbs/system.hpp"
#include "easydyn/require.hpp"

namespace easydyn {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

Matrix3d cross_matrix(const Vector3d& a) {
  return Matrix3d{{0, -a.z(), a.y()}, {a.z(), 0, -a.x()}, {-a.y(), a.x(), 0}};
}

}  // namespace

FlexibleBody::FlexibleBody(System& system, std::string name, const FlexibleModel& model,
                           const ShapeOptions& options, double damping_ratio)
    : name_(std::move(name)), model_(model) {
  const std::string object = "flexible body \"" + name_ + "\"";
  model.check(object);
  require_not_negative(object, "damping ratio", damping_ratio, "");
  shapes_ = compute_shapes(model, options);
  const Index m = shapes_.cols();
  for (Index j = 0; j < m; ++j) coordinates_.push_back(system.coordinate(fmt::format("{}.{}", name_, j)));

  point_shapes_ = model.N * shapes_;
  M_points_shapes_ = model.M * point_shapes_;
  M_ = point_shapes_.transpose() * M_points_shapes_;
  K_ = shapes_.transpose() * (model.K * shapes_);
  K_ = 0.5 * (K_ + K_.transpose()).eval();
  D_ = MatrixXd::Zero(m, m);
  if (m > 0) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> eigen(K_, M_);
    if (eigen.info() != Eigen::Success || !(eigen.eigenvalues()[0] > 1e-12 * eigen.eigenvalues()[m - 1]))
      throw ModelError(
          fmt::format("{}: its shapes contain rigid motion, which the floating frame makes already; clamp "
                      "a node, or six displacements",
                      object));
    // 2 zeta w for each mode of the shapes
    const MatrixXd momentum = M_ * eigen.eigenvectors();
    D_ = momentum * (2 * damping_ratio * eigen.eigenvalues().cwiseMax(0).cwiseSqrt()).asDiagonal() *
         momentum.transpose();
  }

  // Rigid columns (w, v) of the undeformed body give mass and first moment.
  const Index points = model.points.cols(), rows = model.point_rows;
  eta_.resize(static_cast<std::size_t>(m));
  eta_value_ = eta_rate_ = VectorXd::Zero(m);
  u_ = u_rate_ = velocity_ = change_ = P_ = G_ = VectorXd::Zero(points * rows);
  rigid_ = MatrixXd::Zero(points * rows, 6);
  mass_matrix_ = MatrixXd::Zero(6 + m, 6 + m);
  mass_matrix_.bottomRightCorner(m, m) = M_;
  const Eigen::Matrix<double, 6, 6> rigid = compute_mass_matrix().topLeftCorner<6, 6>();
  mass_ = rigid(3, 3);
  first_moment_ = {rigid(4, 2), rigid(5, 0), rigid(3, 1)};  // v-w block: -[s]
  first_moment_of_shapes_ = rigid_.rightCols<3>().transpose() * M_points_shapes_;
}

FlexibleBody& FlexibleBody::operator=(const Frame& floating) {
  if (const MotionTree* const tree = MotionTree::current(); tree && tree->is_in_trial())
    throw ModelError(fmt::format(
        "flexible body \"{}\" is placed inside the equations of a loop: place it after the loop is solved",
        name_));
  frame_ = floating;
  is_placed_ = true;
  for (std::size_t j = 0; j < eta_.size(); ++j) {
    eta_[j] = Expr(coordinates_[j]);
    eta_value_[static_cast<Index>(j)] = eta_[j].value();
    eta_rate_[static_cast<Index>(j)] = eta_[j].rate();
  }
  u_.noalias() = point_shapes_ * eta_value_;
  u_rate_.noalias() = point_shapes_ * eta_rate_;
  return *this;
}

Frame FlexibleBody::node(int i) const {
  if (!is_placed_)
    throw ModelError(fmt::format("flexible body \"{}\" is used before positions() places it", name_));
  if (i < 0 || i >= model_.node_count())
    throw ModelError(
        fmt::format("flexible body \"{}\": node {}, must be 0 to {}", name_, i, model_.node_count() - 1));
  const int rows = model_.node_rows();
  const auto displacement = [&](int row) {
    Expr sum;
    for (std::size_t j = 0; j < eta_.size(); ++j) {
      const double shape = shapes_(i * rows + row, static_cast<Index>(j));
      if (shape != 0) sum += shape * eta_[j];
    }
    return sum;
  };
  const Vector3d p = model_.nodes.col(i);
  const Frame at =
      frame_ * translate(p.x() + displacement(0), p.y() + displacement(1), p.z() + displacement(2));
  if (rows == 3) return at;
  return at * rotate_x(displacement(3)) * rotate_y(displacement(4)) * rotate_z(displacement(5));
}

// V = v + w x (p + u) + u. and w + theta. , in the axes of F.
void FlexibleBody::compute_velocity(const FrameMotion& motion) {
  const Matrix3d R_F0 = frame_.rotation().transpose();
  const Vector3d w = R_F0 * motion.w, v = R_F0 * motion.v;
  velocity_ = u_rate_;
  for (Index i = 0, row = 0; i < model_.points.cols(); ++i, row += model_.point_rows) {
    velocity_.segment<3>(row) += v + w.cross(model_.points.col(i) + u_.segment<3>(row));
    if (model_.point_rows == 6) velocity_.segment<3>(row + 3) += w;
  }
}

// Lagrange's equations of T = V^T M V / 2 in the quasi-velocities (w, v, eta.), with P = M V, G = M V. :
//   force   sum F_i                        F_i = G_i + w x P_i
//   moment  sum r_i x F_i + V_i x P_i      and G + w x P of the rotations
//   shapes  Phi^T F
spatial::Wrench FlexibleBody::compute_inertia_force(const FrameMotion& motion, const VectorXd& accelerations,
                                                    VectorXd& shape_forces) {
  const Matrix3d& R = frame_.rotation();
  const Vector3d w = R.transpose() * motion.w, w_dot = R.transpose() * motion.w_dot,
                 v_dot = R.transpose() * (motion.v_dot - motion.w.cross(motion.v));
  compute_velocity(motion);
  change_.noalias() = point_shapes_ * accelerations;
  const Index rows = model_.point_rows;
  for (Index i = 0, row = 0; i < model_.points.cols(); ++i, row += rows) {
    const Vector3d r = model_.points.col(i) + u_.segment<3>(row);
    change_.segment<3>(row) += v_dot + w_dot.cross(r) + w.cross(u_rate_.segment<3>(row));
    if (rows == 6) change_.segment<3>(row + 3) += w_dot;
  }
  P_.noalias() = model_.M * velocity_;
  G_.noalias() = model_.M * change_;

  Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
  for (Index i = 0, row = 0; i < model_.points.cols(); ++i, row += rows) {
    const Vector3d r = model_.points.col(i) + u_.segment<3>(row), P = P_.segment<3>(row);
    G_.segment<3>(row) += w.cross(P);
    const Vector3d F = G_.segment<3>(row);
    force += F;
    moment += r.cross(F) + velocity_.segment<3>(row).cross(P);
    if (rows == 6) moment += G_.segment<3>(row + 3) + w.cross(P_.segment<3>(row + 3));
  }
  shape_forces.noalias() = point_shapes_.transpose() * G_;
  return {spatial::Vector(R * moment), spatial::Vector(R * force)};
}

const MatrixXd& FlexibleBody::compute_mass_matrix() {
  const Matrix3d& R = frame_.rotation();
  const Index m = shapes_.cols(), rows = model_.point_rows;
  for (Index i = 0, row = 0; i < model_.points.cols(); ++i, row += rows) {
    rigid_.block<3, 3>(row, 0) = -cross_matrix(model_.points.col(i) + u_.segment<3>(row));
    rigid_.block<3, 3>(row, 3).setIdentity();
    if (rows == 6) rigid_.block<3, 3>(row + 3, 0).setIdentity();
  }
  M_rigid_.noalias() = model_.M * rigid_;
  Eigen::Matrix<double, 6, 6> to_world = Eigen::Matrix<double, 6, 6>::Zero();
  to_world.topLeftCorner<3, 3>() = to_world.bottomRightCorner<3, 3>() = R;
  mass_matrix_.topLeftCorner<6, 6>() = to_world * (rigid_.transpose() * M_rigid_) * to_world.transpose();
  mass_matrix_.topRightCorner(6, m) = to_world * (rigid_.transpose() * M_points_shapes_);
  mass_matrix_.bottomLeftCorner(m, 6) = mass_matrix_.topRightCorner(6, m).transpose();
  return mass_matrix_;
}

double FlexibleBody::kinetic_energy(const FrameMotion& motion) {
  compute_velocity(motion);
  return 0.5 * velocity_.dot(model_.M * velocity_);
}

void FlexibleBody::apply_elastic_forces(EnergyAccounts& accounts) const {
  const VectorXd elastic = K_ * eta_value_, damping = D_ * eta_rate_;
  for (std::size_t j = 0; j < coordinates_.size(); ++j)
    coordinates_[j].add_force(-elastic[static_cast<Index>(j)] - damping[static_cast<Index>(j)]);
  accounts.potential += 0.5 * eta_value_.dot(elastic);
  accounts.dissipated += eta_rate_.dot(damping);
}

// Potential -g . (m p_0F + R s), first moment s = s_0 + S eta; its forces follow.
void FlexibleBody::apply_weight(const Vector3d& field, EnergyAccounts& accounts) const {
  const Vector3d s = frame_.rotation() * (first_moment_ + first_moment_of_shapes_ * eta_value_);
  frame_.add_force(mass_ * field, frame_.origin());
  frame_.add_moment(s.cross(field));
  const VectorXd on_shapes = first_moment_of_shapes_.transpose() * (frame_.rotation().transpose() * field);
  for (std::size_t j = 0; j < coordinates_.size(); ++j)
    coordinates_[j].add_force(on_shapes[static_cast<Index>(j)]);
  accounts.potential -= field.dot(mass_ * frame_.origin() + s);
}

}  // namespace easydyn
