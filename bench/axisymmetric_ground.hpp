#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <vector>

#include "soil/lattice.hpp"

namespace easydyn::soil {

/// What stands in the added elements at the edge of an AxisymmetricGround. s = 1 + d / (i w + alpha), d [1/s] >= 0
/// rising from zero at their inner edge.
enum class AbsorbingLayer {
  none,            ///< plain elements
  sponge,          ///< mass times 1 + d / (i w), that of the wave engine
  matched_sponge,  ///< mass times s, moduli over s: passive, no reflection at normal incidence
  pml  ///< perfectly matched layer: coordinates stretched by s_r(r) and s_z(z), in the weak form of Z. Xie, D. Komatitsch,
       ///< R. Martin, R. Matzen, Geophys. J. Int. 198, 2014, doi:10.1093/gji/ggu219; multiaxial if
       ///< `multiaxial` > 0 (K. C. Meza-Fajardo, A. S. Papageorgiou, Bull. Seism. Soc. Am. 98(4), 2008,
       ///< doi:10.1785/0120070223)
};

/// What stands on the outer faces and carries the far field of a static load.
enum class FarField {
  none,
  springs,           ///< 6 mu / ((3 - 2 nu) R) and mu / R per area, those of the wave engine
  infinite_elements  ///< on rays from the middle of the load through the outer face, x = rho X: u = sum_k q_k / rho^k
};

struct AxisymmetricBoundary {
  AbsorbingLayer layer = AbsorbingLayer::sponge;
  double strength = 12;   ///< d at the outer edge = strength x speed / length
  double speed = 0;       ///< [m/s]
  double power = 2;       ///< of the distance with which d rises
  double alpha = 0;       ///< [1/s] of s
  double multiaxial = 0;  ///< share of d of each axis that stretches the other one, 0..1
  double loss = 0;        ///< of a perfectly matched layer: mass-proportional damping over d, 0..1
  bool dashpots = true;   ///< rho c_p (normal) and rho c_s (tangential) per area
  FarField far_field = FarField::springs;
  int terms = 1;  ///< of the infinite elements; those beyond the first are condensed statically
};

/// Elastic waves in layers under a vertical load on a disc: the equations and the elements of the wave engine in (r, z), u_r
/// and u_z about the axis r = 0. Degree 4, Gauss-Lobatto-Legendre points, in the elements at the axis
/// Gauss-Lobatto-Jacobi points (weight 1 + s) along r, diagonal mass, leapfrog, double precision:
///
///   M (v+ - v-) / dt + C (v+ + v-) / 2 = F(t) p - K u,  u+ = u + dt v+
///
/// It is there to compare boundaries (boundary_study.cpp), in seconds instead of hours. Memory variables of the
/// absorbing layers follow the trapezoidal rule.
class AxisymmetricGround {
 public:
  static constexpr int degree = 4, points = degree + 1;

  /// @param lattice  of a quarter model: its x lines are used along r; degree 4
  /// @param radius   [m] of the loaded disc
  AxisymmetricGround(const Lattice& lattice, const std::vector<Layer>& layers,
                     const AxisymmetricBoundary& boundary, double radius);

  /// Largest stable step [s] of the plain elements and the far field, by power iteration.
  double compute_stable_step();
  void set_time_step(double dt);
  void advance(double force);  ///< [N] downward, at the beginning of the step

  /// v_r, v_z [m/s] half a step before the end of the last step, at the surface.
  std::array<double, 2> velocity(double r) const;
  std::array<double, 2> displacement(double r) const;  ///< u_r, u_z [m] at the end of it
  double largest_velocity() const;                     ///< [m/s] of any node
  double kinetic_energy() const;                       ///< [J]
  long nodes() const { return static_cast<long>(nI_) * nJ_; }
  long layer_elements() const { return layer_elements_; }  ///< those of the absorbing layer
  long elements() const { return static_cast<long>(columns_.size()) * static_cast<long>(rows_.size()); }

 private:
  using Table = std::array<std::array<double, points>, points>;
  struct Line {                            // elements along one axis
    std::array<double, points> x, weight;  // weight: integral of r dr, or of dz
    Table derivative;                      // (i, a): of shape a at point i
    bool at_axis = false;
  };
  struct Row : Line {
    double lambda, mu, density;
  };
  struct Stretch {  // at one point: damping of s_r, s_z and of r~ / r
    double r = 0, z = 0, hoop = 0;
  };
  /// y = x / s or y = s x: state c, psi = g x + c, c <- a psi + g x.
  struct Filter {
    double d = 0, a = 0, g = 0;
  };
  struct LayerPoint {
    std::array<Filter, 3> divide, multiply;  // r, z, hoop
    std::array<double, 15> state{};
  };

  static Line make_line(double low, double high, bool at_axis, bool along_r);
  static std::array<double, points> compute_shape(const Line& line, double x,
                                                  std::array<double, points>* slope);
  std::size_t index(int I, int J) const { return static_cast<std::size_t>(J) * nI_ + I; }
  double radius_of(int I) const;
  double depth_of(int J) const;
  double damping_r(double r) const;
  double damping_z(double z) const;
  Stretch compute_stretch(double r, double z) const;
  void add_dashpots_and_springs();
  void make_infinite_elements();
  template <bool with_memory>
  void add_element_force(int ex, int ez);
  void compute_force(bool with_memory);
  std::array<double, 2> interpolate(const std::array<Eigen::VectorXd, 2>& field, double r) const;

  AxisymmetricBoundary boundary_;
  std::vector<Line> columns_;
  std::vector<Row> rows_;
  int nI_, nJ_;
  long layer_elements_ = 0;
  double inner_r_, outer_r_, inner_z_, outer_z_;
  std::vector<int> layer_element_;  // per element: first of its points in layer_points_, -1: plain
  std::vector<LayerPoint> layer_points_;
  Eigen::VectorXd mass_, load_;                      // integrals include 2 pi
  std::array<Eigen::VectorXd, 2> damping_, spring_;  // per component [N s/m], [N/m]
  std::array<Eigen::VectorXd, 2> u_, v_, f_;
  // Mass terms of the layers: M (c1 u. + c0 u + sum_k b_k psi_k), psi_1 = u / (i w + alpha), psi_k = psi_(k-1) / (..)
  Eigen::VectorXd c0_, c1_;
  std::array<Eigen::VectorXd, 3> b_;
  std::array<std::array<Eigen::VectorXd, 3>, 2> psi_state_;
  std::vector<std::size_t> far_nodes_;
  Eigen::MatrixXd far_stiffness_;
  Eigen::VectorXd far_u_, far_f_;
  double dt_ = 0;
};

}  // namespace easydyn::soil
