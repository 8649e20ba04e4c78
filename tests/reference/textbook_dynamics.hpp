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
inline Jet exp(const Jet& a) {
  return Jet::chain(a, std::exp(a.f), std::exp(a.f), std::exp(a.f));
}
inline Jet sqrt(const Jet& a) {
  const double r = std::sqrt(a.f);
  return Jet::chain(a, r, 0.5 / r, -0.25 / (r * a.f));
}
inline Jet operator/(const Jet& a, const Jet& b) {
  const double r = 1 / b.f;
  return a * Jet::chain(b, r, -r * r, 2 * r * r * r);
}

/// p(z) that solves g(p, z) = 0, with gradient and Hessian in z: Newton on the values, then g differentiated twice,
///
///   G_p P = -G_z        G_p P_ab = -[1 P]^T H [1 P]_ab
///
/// with the Jacobian (G_p, G_z) and the Hessians H of g in (p, z).
/// @param g  called with p and z as variables of one Taylor arithmetic of size N + m; as many equations as unknowns
template <class Equations>
std::vector<Jet> solve_implicit(const Equations& g, Eigen::VectorXd p, const Eigen::VectorXd& z) {
  const int N = static_cast<int>(p.size()), m = static_cast<int>(z.size());
  const auto equations = [&] {
    std::vector<Jet> P, Z;
    for (int i = 0; i < N; ++i) P.push_back(Jet::variable(N + m, i, p[i]));
    for (int i = 0; i < m; ++i) Z.push_back(Jet::variable(N + m, N + i, z[i]));
    return g(P, Z);
  };
  std::vector<Jet> e;
  Eigen::MatrixXd G(N, N + m);
  for (int iteration = 0; iteration < 30; ++iteration) {
    e = equations();
    Eigen::VectorXd residual(N);
    for (int i = 0; i < N; ++i) {
      residual[i] = e[static_cast<std::size_t>(i)].f;
      G.row(i) = e[static_cast<std::size_t>(i)].g.transpose();
    }
    const Eigen::VectorXd step = G.leftCols(N).fullPivLu().solve(residual);
    if (step.norm() < 1e-15 * (1 + p.norm())) break;
    p -= step;
  }
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(G.leftCols(N));
  const Eigen::MatrixXd P = -lu.solve(G.rightCols(m));
  Eigen::MatrixXd along(N + m, m);
  along << P, Eigen::MatrixXd::Identity(m, m);
  std::vector<Jet> solution;
  for (int k = 0; k < N; ++k) solution.push_back({p[k], P.row(k).transpose(), Eigen::MatrixXd::Zero(m, m)});
  const Eigen::MatrixXd inverse = lu.inverse();
  for (int i = 0; i < N; ++i) {
    const Eigen::MatrixXd curvature = along.transpose() * e[static_cast<std::size_t>(i)].H * along;
    for (int k = 0; k < N; ++k) solution[static_cast<std::size_t>(k)].H -= inverse(k, i) * curvature;
  }
  return solution;
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
  /// Followed by a constant rotation.
  JetPose turned(const Eigen::Matrix3d& C) const {
    JetPose T = *this;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) T.R[i][j] = C(0, j) * R[i][0] + C(1, j) * R[i][1] + C(2, j) * R[i][2];
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
