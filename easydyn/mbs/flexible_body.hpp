#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "easydyn/mbs/coordinate.hpp"
#include "easydyn/mbs/flexible_model.hpp"
#include "easydyn/mbs/frame.hpp"
#include "easydyn/mbs/motion_tree.hpp"

namespace easydyn {

/// A linear-elastic body that moves as far as it likes: small displacements in a floating frame F,
///
///   p_0P = p_0F + R_0F (p_P + N Phi eta)        d = Phi eta, shapes Phi, coordinates eta
///
///     FlexibleBody& blade = flexible_body("blade", beam_model(steel), {.clamped_nodes = {0}, .modes = 3}, 0.01);
///     void positions() override {
///       blade = rotate_y(a);                      // the floating frame; node 0 stays at its place in it
///       tip = blade.node(10);                     // a frame for bodies, springs, loops
///     }
///
/// The shape coordinates eta are declared with the body. Inertia forces are those of T = v^T M v / 2 over all material
/// points, exact for any motion of F (all gyroscopic and centrifugal terms); elastic and damping forces
/// K_r eta + D_r eta. act by themselves, with their energies, and so does gravity().
/// Limits: strains and rotations within F are small; no stiffening by centrifugal or axial forces (turn well below
/// the first bending frequency, or divide the body).
/// Reference: A. A. Shabana, Dynamics of Multibody Systems, 4th ed., Cambridge, 2013, ch. 5.
/// Made by `System::flexible_body`, placed in positions().
class FlexibleBody : public DeformableInertia {
 public:
  FlexibleBody(const FlexibleBody&) = delete;
  FlexibleBody& operator=(const Frame& floating);
  FlexibleBody& operator=(const Motion& motion) { return *this = Frame(motion); }

  const std::string& name() const { return name_; }
  double mass() const { return mass_; }  ///< [kg]
  const Frame& frame() const { return frame_; }
  /// The frame that moves with node i, its axes turned by the node's rotations (in three rows: as the floating ones). In
  /// positions(), after the body is placed. @throws ModelError if there is no such node
  Frame node(int i) const;

  int shape_count() const { return static_cast<int>(shapes_.cols()); }
  const Coordinate& coordinate(int j) const { return coordinates_[static_cast<std::size_t>(j)]; }  ///< eta_j
  const Eigen::MatrixXd& shapes() const { return shapes_; }  ///< Phi: displacements x shapes
  /// Displacements d of all nodes, at the last evaluation.
  Eigen::VectorXd displacements() const { return shapes_ * eta_value_; }

  // ---- for the sweeps ----
  int motion() const override { return frame_.motion_index(); }
  const Eigen::Vector3d& origin() const override { return frame_.origin(); }
  std::span<const Expr> shape_coordinates() const override { return eta_; }
  spatial::Wrench compute_inertia_force(const FrameMotion& motion, const Eigen::VectorXd& accelerations,
                                        Eigen::VectorXd& shape_forces) override;
  const Eigen::MatrixXd& compute_mass_matrix() override;
  double kinetic_energy(const FrameMotion& motion) override;

 private:
  friend class System;
  FlexibleBody(System& system, std::string name, const FlexibleModel& model, const ShapeOptions& options,
               double damping_ratio);
  void apply_elastic_forces(EnergyAccounts& accounts) const;
  void apply_weight(const Eigen::Vector3d& field, EnergyAccounts& accounts) const;
  void compute_velocity(const FrameMotion& motion);

  std::string name_;
  FlexibleModel model_;
  Eigen::MatrixXd shapes_, point_shapes_;  // Phi, N Phi
  Eigen::MatrixXd M_points_shapes_;        // M N Phi
  Eigen::MatrixXd M_, K_, D_;              // of the shape coordinates
  double mass_ = 0;
  Eigen::Vector3d first_moment_;            // undeformed, about the origin of F [kg m]
  Eigen::MatrixXd first_moment_of_shapes_;  // 3 x shapes
  std::vector<Coordinate> coordinates_;
  Frame frame_;
  bool is_placed_ = false;

  // In the present evaluation, in the axes of F:
  std::vector<Expr> eta_;
  Eigen::VectorXd eta_value_, eta_rate_;
  Eigen::VectorXd u_, u_rate_;         // of the material points, row by row
  Eigen::VectorXd velocity_, change_;  // V and its rate
  Eigen::VectorXd P_, G_;              // M V and M V.
  Eigen::MatrixXd rigid_, M_rigid_, mass_matrix_;
};

}  // namespace easydyn
