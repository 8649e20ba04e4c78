#pragma once

#include <Eigen/Core>
#include <cstring>

/// Six-dimensional vectors of rigid-body mechanics, all in world axes and about one common point O that is
/// fixed in space (chosen near the mechanism at each evaluation, so that no digit is lost far from the
/// origin). Reference: R. Featherstone, Rigid Body Dynamics Algorithms, Springer, 2008, ch. 2.
namespace easydyn::spatial {

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // all of this is inline: no calling convention matters
#endif

/// Vector of three components. It is kept as four, the last 0, which processors add and multiply at once.
class Vector {
 public:
  Vector() = default;
  Vector(double x, double y, double z) : v_{x, y, z, 0} {}
  explicit Vector(const Eigen::Vector3d& v) : v_{v[0], v[1], v[2], 0} {}
  /// Three numbers in memory.
  explicit Vector(const double* v) : v_{v[0], v[1], v[2], 0} {}
  operator Eigen::Vector3d() const { return {v_[0], v_[1], v_[2]}; }  // NOLINT: the same vector

  double operator[](int i) const { return v_[i]; }
  /// The matrix with these columns, written in pieces no shorter than those in which a processor copies a matrix:
  /// it would have to wait for shorter ones.
  static void write_columns(const Vector& x, const Vector& y, const Vector& z, Eigen::Matrix3d& R) {
    const Four first = __builtin_shufflevector(x.v_, y.v_, 0, 1, 2, 4),
               second = __builtin_shufflevector(y.v_, z.v_, 1, 2, 4, 5);
    std::memcpy(R.data(), &first, sizeof first);
    std::memcpy(R.data() + 4, &second, sizeof second);
    R(2, 2) = z[2];
  }
  Vector& operator+=(const Vector& b) {
    v_ += b.v_;
    return *this;
  }
  Vector& operator-=(const Vector& b) {
    v_ -= b.v_;
    return *this;
  }
  friend Vector operator+(const Vector& a, const Vector& b) { return Vector(a.v_ + b.v_); }
  friend Vector operator-(const Vector& a, const Vector& b) { return Vector(a.v_ - b.v_); }
  friend Vector operator*(double s, const Vector& a) { return Vector(s * a.v_); }
  friend Vector cross(const Vector& a, const Vector& b) {
    return Vector(a.v_ * b.yzx().v_ - a.yzx().v_ * b.v_).yzx();
  }
  /// a . b + c . d
  friend double dot(const Vector& a, const Vector& b, const Vector& c, const Vector& d) {
    const Four sum = a.v_ * b.v_ + c.v_ * d.v_;
    return sum[0] + sum[1] + sum[2];
  }
  friend double dot(const Vector& a, const Vector& b) {
    const Four product = a.v_ * b.v_;
    return product[0] + product[1] + product[2];
  }

 private:
  using Four = double __attribute__((vector_size(32)));
  explicit Vector(const Four& v) : v_(v) {}
  Vector yzx() const { return Vector(__builtin_shufflevector(v_, v_, 1, 2, 0, 3)); }
  Four v_ = {0, 0, 0, 0};
};

/// Motion: angular velocity w [rad/s] and velocity v [m/s] of the body-fixed point that passes through O.
struct Twist {
  Vector w, v;
  Twist& operator+=(const Twist& b) {
    w += b.w;
    v += b.v;
    return *this;
  }
  friend Twist operator*(double a, const Twist& b) { return {a * b.w, a * b.v}; }
};

/// Force: moment about O [N m] and force [N].
struct Wrench {
  Vector moment, force;
  Wrench& operator+=(const Wrench& b) {
    moment += b.moment;
    force += b.force;
    return *this;
  }
  Wrench& operator-=(const Wrench& b) {
    moment -= b.moment;
    force -= b.force;
    return *this;
  }
};

/// Power of a wrench on a twist.
inline double dot(const Twist& a, const Wrench& f) {
  return dot(a.w, f.moment, a.v, f.force);
}

/// Rate of a motion vector b carried along by the motion a:  a x b.
inline Twist cross(const Twist& a, const Twist& b) {
  return {cross(a.w, b.w), cross(a.w, b.v) + cross(a.v, b.w)};
}

/// Symmetric 3 x 3 matrix, by its columns.
struct Symmetric {
  Vector x, y, z;

  /// R J R^T for a symmetric J.
  static Symmetric rotated(const Eigen::Matrix3d& R, const Eigen::Matrix3d& J) {
    const Vector rx(&R(0, 0)), ry(&R(0, 1)), rz(&R(0, 2));
    const bool is_diagonal = J(1, 0) == 0 && J(2, 0) == 0 && J(2, 1) == 0;
    const Symmetric RJ = is_diagonal ? Symmetric{J(0, 0) * rx, J(1, 1) * ry, J(2, 2) * rz}
                                     : Symmetric{J(0, 0) * rx + J(1, 0) * ry + J(2, 0) * rz,
                                                 J(0, 1) * rx + J(1, 1) * ry + J(2, 1) * rz,
                                                 J(0, 2) * rx + J(1, 2) * ry + J(2, 2) * rz};
    const auto column = [&](int i) { return R(i, 0) * RJ.x + R(i, 1) * RJ.y + R(i, 2) * RJ.z; };
    return {column(0), column(1), column(2)};
  }
  Symmetric& operator+=(const Symmetric& b) {
    x += b.x;
    y += b.y;
    z += b.z;
    return *this;
  }
  friend Vector operator*(const Symmetric& A, const Vector& v) {
    return v[0] * A.x + v[1] * A.y + v[2] * A.z;
  }
};

/// Inertia about O: mass [kg], first moment m c [kg m], rotational inertia about O [kg m^2].
struct Inertia {
  double mass = 0;
  Vector first;
  Symmetric second;

  /// Of a body with inertia J_C (world axes) about its centre of mass at c = p_OC: J_C + m (c.c 1 - c c^T).
  static Inertia of_body(double mass, const Vector& c, const Symmetric& J_C) {
    const Vector mc = mass * c;
    const double square = dot(mc, c);
    return {mass,
            mc,
            {J_C.x + Vector(square, 0, 0) - c[0] * mc, J_C.y + Vector(0, square, 0) - c[1] * mc,
             J_C.z + Vector(0, 0, square) - c[2] * mc}};
  }
  Inertia& operator+=(const Inertia& b) {
    mass += b.mass;
    first += b.first;
    second += b.second;
    return *this;
  }
  /// Momentum of the motion a.
  friend Wrench operator*(const Inertia& I, const Twist& a) {
    return {I.second * a.w + cross(I.first, a.v), I.mass * a.v + cross(a.w, I.first)};
  }
};

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

}  // namespace easydyn::spatial
