#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <vector>

/// Slow textbook reference for the kernel: virtual power summed over bodies, with Jacobians and their rates
/// from second-order Taylor arithmetic on the positions alone. Shares nothing with the kernel's expressions
/// and sweeps.
///
///   M = sum_b m Jv^T Jv + Jw^T I Jw
///   h = sum_b m Jv^T a_bias + Jw^T (I alpha_bias + w x I w)
///
/// The time is one more variable of the Taylor arithmetic, of rate 1 and acceleration 0, behind the n
/// coordinates: velocities and biases take all n + 1, the partial velocities Jv, Jw the coordinates only.
/// Reference: W. Schiehlen, P. Eberhard, Applied Dynamics, Springer, 2014, ch. 5.
namespace reference {

/// Value, gradient and Hessian of a function of n variables.
struct Jet {
  double f = 0;
  Eigen::VectorXd g;
  Eigen::MatrixXd H;

  static Jet constant(int n, double v) { return {v, Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)}; }
  static Jet variable(int n, int i, double v) {
    Jet j = constant(n, v);
    j.g[i] = 1;
    return j;
  }
  static Jet chain(const Jet& a, double f, double f1, double f2) {
    return {f, f1 * a.g, f1 * a.H + f2 * a.g * a.g.transpose()};
  }
};
inline Jet operator+(const Jet& a, const Jet& b) {
  return {a.f + b.f, a.g + b.g, a.H + b.H};
}
inline Jet operator-(const Jet& a, const Jet& b) {
  return {a.f - b.f, a.g - b.g, a.H - b.H};
}
inline Jet operator*(const Jet& a, const Jet& b) {
  return {a.f * b.f, a.f * b.g + b.f * a.g,
          a.f * b.H + b.f * a.H + a.g * b.g.transpose() + b.g * a.g.transpose()};
}
inline Jet operator*(double s, const Jet& a) {
  return {s * a.f, s * a.g, s * a.H};
}
inline Jet sin(const Jet& a) {
  return Jet::chain(a, std::sin(a.f), std::cos(a.f), -std::sin(a.f));
}
inline Jet cos(const Jet& a) {
  return Jet::chain(a, std::cos(a.f), -std::sin(a.f), -std::cos(a.f));
}

/// Pose with Taylor entries: R row by row, p.
struct JetPose {
  Jet R[3][3], p[3];
  static JetPose identity(int n) {
    JetPose T;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) T.R[i][j] = Jet::constant(n, i == j);
      T.p[i] = Jet::constant(n, 0);
    }
    return T;
  }
  /// Followed by a rotation about coordinate axis a (0, 1, 2).
  JetPose rotated(int a, const Jet& angle) const {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    const Jet C = cos(angle), S = sin(angle);
    JetPose T = *this;
    for (int i = 0; i < 3; ++i) {
      T.R[i][b] = R[i][b] * C + R[i][c] * S;
      T.R[i][c] = R[i][c] * C - R[i][b] * S;
    }
    return T;
  }
  JetPose translated(const Jet& x, const Jet& y, const Jet& z) const {
    JetPose T = *this;
    for (int i = 0; i < 3; ++i) T.p[i] = p[i] + R[i][0] * x + R[i][1] * y + R[i][2] * z;
    return T;
  }
};

struct TextbookBody {
  double mass;
  Eigen::Matrix3d J;  // body axes
  JetPose pose;
};

struct TextbookDynamics {
  Eigen::MatrixXd M;
  Eigen::VectorXd h;  // including gravity (0, 0, -g): h - Q
  double kinetic = 0;
};

/// @param bodies  poses as functions of the variables (q, t)
/// @param qd      rates of the coordinates; that of t is 1
inline TextbookDynamics textbook_dynamics(const std::vector<TextbookBody>& bodies, const Eigen::VectorXd& qd,
                                          double g) {
  using Eigen::Matrix3d, Eigen::Vector3d, Eigen::MatrixXd;
  const int n = static_cast<int>(qd.size());
  TextbookDynamics d{MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), 0};
  Eigen::VectorXd rate(n + 1);
  rate << qd, 1;
  const auto vee = [](const Matrix3d& W) { return Vector3d(W(2, 1), W(0, 2), W(1, 0)); };
  for (const TextbookBody& b : bodies) {
    MatrixXd Jv(3, n), Jw(3, n);
    Vector3d v, a_bias;
    Matrix3d R, R_dot, R_ddot;
    for (int i = 0; i < 3; ++i) {
      Jv.row(i) = b.pose.p[i].g.head(n).transpose();
      v[i] = b.pose.p[i].g.dot(rate);
      a_bias[i] = rate.dot(b.pose.p[i].H * rate);
      for (int j = 0; j < 3; ++j) {
        R(i, j) = b.pose.R[i][j].f;
        R_dot(i, j) = b.pose.R[i][j].g.dot(rate);
        R_ddot(i, j) = rate.dot(b.pose.R[i][j].H * rate);
      }
    }
    for (int k = 0; k < n; ++k) {
      Matrix3d dR;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) dR(i, j) = b.pose.R[i][j].g[k];
      Jw.col(k) = vee(dR * R.transpose());
    }
    const Vector3d w = vee(R_dot * R.transpose());
    const Vector3d alpha = vee(R_ddot * R.transpose() + R_dot * R_dot.transpose());
    const Matrix3d I = R * b.J * R.transpose();
    d.M += b.mass * Jv.transpose() * Jv + Jw.transpose() * I * Jw;
    d.h += b.mass * Jv.transpose() * (a_bias + Vector3d(0, 0, g)) +
           Jw.transpose() * (I * alpha + w.cross(I * w));
    d.kinetic += 0.5 * b.mass * v.squaredNorm() + 0.5 * w.dot(I * w);
  }
  return d;
}

}  // namespace reference
