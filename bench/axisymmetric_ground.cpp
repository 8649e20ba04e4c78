#include "bench/axisymmetric_ground.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "soil/gll.hpp"
#include "soil/layered/gauss_rule.hpp"

namespace easydyn::soil {

namespace {

constexpr double pi = std::numbers::pi;
constexpr int n = AxisymmetricGround::points;

// Gauss-Lobatto-Jacobi points of the weight 1 + s: the ends and the zeros of the Jacobi polynomial P_3^(1,2), which is
// proportional to 21 s^3 - 7 s^2 - 7 s + 1 (orthogonal to 1, s, s^2 with the weight (1 - s) (1 + s)^2).
std::array<double, n> compute_axis_points() {
  std::array<double, n> s{-1, -0.5, 0.1, 0.7, 1};
  for (int i = 1; i < n - 1; ++i)
    for (int k = 0; k < 50; ++k)
      s[i] -= (((21 * s[i] - 7) * s[i] - 7) * s[i] + 1) / ((63 * s[i] - 14) * s[i] - 7);
  return s;
}

}  // namespace

std::array<double, n> AxisymmetricGround::compute_shape(const Line& line, double x,
                                                        std::array<double, n>* slope) {
  std::array<double, n> shape{};
  for (int a = 0; a < n; ++a) {
    double value = 1, sum = 0;
    for (int b = 0; b < n; ++b) {
      if (b == a) continue;
      value *= (x - line.x[b]) / (line.x[a] - line.x[b]);
      double term = 1 / (line.x[a] - line.x[b]);
      for (int c = 0; c < n; ++c)
        if (c != a && c != b) term *= (x - line.x[c]) / (line.x[a] - line.x[c]);
      sum += term;
    }
    shape[a] = value;
    if (slope) (*slope)[a] = sum;
  }
  return shape;
}

AxisymmetricGround::Line AxisymmetricGround::make_line(double low, double high, bool at_axis, bool along_r) {
  Line line;
  line.at_axis = at_axis;
  const GllRule rule(degree);
  std::array<double, n> s{};
  if (at_axis)
    s = compute_axis_points();
  else
    for (int i = 0; i < n; ++i) s[i] = rule.points(i);
  for (int i = 0; i < n; ++i) line.x[i] = low + (high - low) * (1 + s[i]) / 2;
  line.x[0] = low;
  line.x[degree] = high;
  for (int i = 0; i < n; ++i) {
    std::array<double, n> slope{};
    compute_shape(line, line.x[i], &slope);
    for (int a = 0; a < n; ++a) line.derivative[i][a] = slope[a];
    line.weight[i] = rule.weights(i) * (high - low) / 2 * (along_r ? line.x[i] : 1.0);
  }
  if (at_axis) {  // exact integrals of the shapes times r
    line.weight.fill(0);
    const GaussRule gauss(n);
    for (int q = 0; q < n; ++q) {
      const double r = high * (1 + gauss.points(q)) / 2;
      const auto shape = compute_shape(line, r, nullptr);
      for (int i = 0; i < n; ++i) line.weight[i] += gauss.weights(q) * high / 2 * r * shape[i];
    }
  }
  return line;
}

double AxisymmetricGround::radius_of(int I) const {
  const int e = std::min(I / degree, static_cast<int>(columns_.size()) - 1);
  return columns_[e].x[I - e * degree];
}

double AxisymmetricGround::depth_of(int J) const {
  const int e = std::min(J / degree, static_cast<int>(rows_.size()) - 1);
  return rows_[e].x[J - e * degree];
}

double AxisymmetricGround::damping_r(double r) const {
  const double length = outer_r_ - inner_r_, x = (r - inner_r_) / length;
  return x > 0 ? boundary_.strength * boundary_.speed / length * std::pow(x, boundary_.power) : 0.0;
}

double AxisymmetricGround::damping_z(double z) const {
  const double length = outer_z_ - inner_z_, x = (-z - inner_z_) / length;
  return x > 0 ? boundary_.strength * boundary_.speed / length * std::pow(x, boundary_.power) : 0.0;
}

AxisymmetricGround::Stretch AxisymmetricGround::compute_stretch(double r, double z) const {
  Stretch stretch;
  const double share = boundary_.multiaxial, along_r = damping_r(r), along_z = damping_z(z);
  stretch.r = along_r + share * along_z;
  stretch.z = along_z + share * along_r;
  // r~ = int s_r dr
  stretch.hoop = share * along_z;
  if (r > inner_r_) stretch.hoop += along_r * (r - inner_r_) / ((boundary_.power + 1) * r);
  return stretch;
}

AxisymmetricGround::AxisymmetricGround(const Lattice& lattice, const std::vector<Layer>& layers,
                                       const AxisymmetricBoundary& boundary, double radius)
    : boundary_(boundary) {
  for (int e = 0; e < lattice.nx(); ++e)
    columns_.push_back(make_line(lattice.x[e], lattice.x[e + 1], e == 0, true));
  for (int e = 0; e < lattice.nz(); ++e) {
    Row row;
    static_cast<Line&>(row) = make_line(lattice.z[e], lattice.z[e + 1], false, false);
    const Layer& layer = layers[lattice.layer[e]];
    row.lambda = layer.lame_lambda();
    row.mu = layer.shear_modulus();
    row.density = layer.density;
    rows_.push_back(row);
  }
  nI_ = degree * lattice.nx() + 1;
  nJ_ = degree * lattice.nz() + 1;
  inner_r_ = lattice.interior_x()[1];
  outer_r_ = lattice.x.back();
  inner_z_ = -lattice.interior_z()[0];
  outer_z_ = -lattice.z.front();

  const auto zero = Eigen::VectorXd::Zero(nodes());
  mass_ = load_ = c0_ = c1_ = zero;
  for (auto* pair : {&damping_, &spring_, &u_, &v_, &f_}) pair->fill(zero);
  b_.fill(zero);
  for (auto& states : psi_state_) states.fill(zero);

  const int nx = lattice.nx(), nz = lattice.nz();
  layer_element_.assign(static_cast<std::size_t>(nx) * nz, -1);
  const bool has_memory =
      boundary_.layer == AbsorbingLayer::pml || boundary_.layer == AbsorbingLayer::matched_sponge;
  for (int ez = 0; ez < nz; ++ez)
    for (int ex = 0; ex < nx; ++ex) {
      const bool absorbs = ex >= nx - lattice.sponge_x[1] || ez < lattice.sponge_z[0];
      layer_elements_ += absorbs ? 1 : 0;
      if (absorbs && has_memory) {
        layer_element_[ez * nx + ex] = static_cast<int>(layer_points_.size());
        layer_points_.resize(layer_points_.size() + n * n);
      }
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
          mass_[index(ex * degree + i, ez * degree + j)] +=
              2 * pi * columns_[ex].weight[i] * rows_[ez].weight[j] * rows_[ez].density;
    }

  // Uniform traction over the disc.
  const GaussRule gauss(n);
  for (int ex = 0; ex < nx; ++ex) {
    const double low = lattice.x[ex], high = std::min(lattice.x[ex + 1], radius);
    for (int q = 0; q < n && low < high; ++q) {
      const double r = low + (high - low) * (1 + gauss.points(q)) / 2;
      const auto shape = compute_shape(columns_[ex], r, nullptr);
      for (int i = 0; i < n; ++i)
        load_[index(ex * degree + i, nJ_ - 1)] +=
            gauss.weights(q) * (high - low) / 2 * r * shape[i] * 2 / (radius * radius);
    }
  }

  // Mass terms of the layers: (i w)^2 s_r s_z r~ / r, or (i w)^2 s, in powers of 1 / q, q = i w + alpha.
  const double alpha = boundary_.alpha;
  for (int J = 0; J < nJ_; ++J)
    for (int I = 0; I < nI_; ++I) {
      const double r = radius_of(I), z = depth_of(J);
      const std::size_t p = index(I, J);
      if (boundary_.layer == AbsorbingLayer::sponge) c1_[p] = damping_r(r) + damping_z(z);
      if (!has_memory) continue;
      const double along_r = damping_r(r), along_z = damping_z(z);
      double first, second = 0, third = 0;
      if (boundary_.layer == AbsorbingLayer::pml) {
        const Stretch s = compute_stretch(r, z);
        first = s.r + s.z + s.hoop;
        second = s.r * s.z + s.r * s.hoop + s.z * s.hoop;
        third = s.r * s.z * s.hoop;
      } else {
        first = damping_r(r) + damping_z(z);
      }
      c1_[p] = first;
      c0_[p] = second - alpha * first;
      b_[0][p] = alpha * alpha * first - 2 * alpha * second + third;
      b_[1][p] = alpha * alpha * second - 2 * alpha * third;
      b_[2][p] = alpha * alpha * third;
      // times 1 + loss / (i w)
      const double loss = boundary_.loss * (along_r + along_z);
      c1_[p] += loss;
      c0_[p] += loss * first;
      b_[0][p] += loss * (second - alpha * first);
      b_[1][p] += loss * (third - alpha * second);
      b_[2][p] -= loss * alpha * third;
    }
  add_dashpots_and_springs();
  if (boundary_.far_field == FarField::infinite_elements) make_infinite_elements();
}

void AxisymmetricGround::add_dashpots_and_springs() {
  const auto add = [&](std::size_t p, double area, const Row& row, int normal, double distance) {
    const double cp = std::sqrt((row.lambda + 2 * row.mu) / row.density),
                 cs = std::sqrt(row.mu / row.density), nu = row.lambda / (2 * (row.lambda + row.mu));
    if (boundary_.dashpots) {
      damping_[normal][p] += area * row.density * cp;
      damping_[1 - normal][p] += area * row.density * cs;
    }
    if (boundary_.far_field == FarField::springs) {
      spring_[normal][p] += area * 6 * row.mu / ((3 - 2 * nu) * distance);
      spring_[1 - normal][p] += area * row.mu / distance;
    }
  };
  for (std::size_t e = 0; e < rows_.size(); ++e)
    for (int j = 0; j < n; ++j)
      add(index(nI_ - 1, static_cast<int>(e) * degree + j), 2 * pi * outer_r_ * rows_[e].weight[j], rows_[e],
          0, outer_r_);
  for (std::size_t e = 0; e < columns_.size(); ++e)
    for (int i = 0; i < n; ++i)
      add(index(static_cast<int>(e) * degree + i, 0), 2 * pi * columns_[e].weight[i], rows_.front(), 1,
          outer_z_);
}

// With x = rho X(eta), X = (R, Z) the outer face, f = rho^-k phi(eta) and j = R Z' - Z R':
//   f,r = -rho^(-k-1) (k phi Z' + phi' Z) / j,  f,z = rho^(-k-1) (k phi R' + phi' R) / j,  f / r = rho^(-k-1) phi / R,
//   r dr dz = rho^2 R |j| drho deta,  and so the integral of rho^(-k-1) rho^(-l-1) rho^2 from 1 on is 1 / (k + l - 1).
void AxisymmetricGround::make_infinite_elements() {
  for (int I = 0; I < nI_ - 1; ++I) far_nodes_.push_back(index(I, 0));
  for (int J = 0; J < nJ_; ++J) far_nodes_.push_back(index(nI_ - 1, J));
  const int count = static_cast<int>(far_nodes_.size()), terms = boundary_.terms, size = 2 * count;
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(terms * size, terms * size);
  const GaussRule gauss(2 * n);

  const auto add_face = [&](const Line& line, const Row& row, bool is_bottom, int first) {
    Eigen::Matrix4d D = Eigen::Matrix4d::Zero();  // stresses r, z, hoop, rz
    D.topLeftCorner<3, 3>().setConstant(row.lambda);
    D.diagonal() << row.lambda + 2 * row.mu, row.lambda + 2 * row.mu, row.lambda + 2 * row.mu, row.mu;
    const double length = line.x[degree] - line.x[0];
    for (int q = 0; q < 2 * n; ++q) {
      const double eta = line.x[0] + length * (1 + gauss.points(q)) / 2;
      std::array<double, n> slope{};
      const auto shape = compute_shape(line, eta, &slope);
      const double R = is_bottom ? eta : outer_r_, Z = is_bottom ? -outer_z_ : eta;
      const double dR = is_bottom ? 1 : 0, dZ = is_bottom ? 0 : 1;
      const double j = R * dZ - Z * dR, weight = 2 * pi * gauss.weights(q) * length / 2 * R * std::abs(j);
      Eigen::MatrixXd B = Eigen::MatrixXd::Zero(4, 2 * n * terms);
      for (int k = 1; k <= terms; ++k)
        for (int a = 0; a < n; ++a) {
          const double fr = -(k * shape[a] * dZ + slope[a] * Z) / j,
                       fz = (k * shape[a] * dR + slope[a] * R) / j;
          const int column = 2 * ((k - 1) * n + a);
          B.col(column) << fr, 0, shape[a] / R, fz;
          B.col(column + 1) << 0, fz, 0, fr;
        }
      for (int k = 0; k < terms; ++k)
        for (int l = 0; l < terms; ++l) {
          const Eigen::MatrixXd block = B.middleCols(2 * n * k, 2 * n).transpose() * D *
                                        B.middleCols(2 * n * l, 2 * n) * (weight / (k + l + 1));
          K.block(size * k + 2 * first, size * l + 2 * first, 2 * n, 2 * n) += block;
        }
    }
  };
  for (std::size_t e = 0; e < columns_.size(); ++e)
    add_face(columns_[e], rows_.front(), true, static_cast<int>(e) * degree);
  for (std::size_t e = 0; e < rows_.size(); ++e)
    add_face(rows_[e], rows_[e], false, nI_ - 1 + static_cast<int>(e) * degree);
  K.row(0).setZero();  // u_r = 0 on the axis
  K.col(0).setZero();

  // Unknowns: the displacement of the face, sum_k q_k, and q_k, k > 1, which no force acts on.
  Eigen::MatrixXd T = Eigen::MatrixXd::Identity(terms * size, terms * size);
  for (int k = 1; k < terms; ++k) {
    T.block(0, k * size, size, size) = -Eigen::MatrixXd::Identity(size, size);
    K(k * size, k * size) = 1;  // held
  }
  far_stiffness_ = (T.transpose() * K * T).eval();
  if (terms > 1) {
    const int inner = (terms - 1) * size;
    far_stiffness_ = (far_stiffness_.topLeftCorner(size, size) -
                      far_stiffness_.topRightCorner(size, inner) *
                          far_stiffness_.bottomRightCorner(inner, inner)
                              .partialPivLu()
                              .solve(far_stiffness_.bottomLeftCorner(inner, size)))
                         .eval();
  }
  far_u_.resize(size);
}

void AxisymmetricGround::set_time_step(double dt) {
  dt_ = dt;
  const auto make = [&](double d, double rate) {
    return Filter{d, (1 - rate * dt / 2) / (1 + rate * dt / 2), dt / 2 / (1 + rate * dt / 2)};
  };
  const int nx = static_cast<int>(columns_.size());
  for (std::size_t e = 0; e < layer_element_.size(); ++e) {
    if (layer_element_[e] < 0) continue;
    const Line& column = columns_[e % nx];
    const Row& row = rows_[e / nx];
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        LayerPoint& point = layer_points_[layer_element_[e] + j * n + i];
        const double r = column.x[i], z = row.x[j], alpha = boundary_.alpha;
        const Stretch s = compute_stretch(r, z);
        const std::array<double, 3> d{
            boundary_.layer == AbsorbingLayer::pml ? s.r : damping_r(r) + damping_z(z), s.z, s.hoop};
        for (int k = 0; k < 3; ++k) {
          point.divide[k] = make(d[k], alpha + d[k]);
          point.multiply[k] = make(d[k], alpha);
        }
      }
  }
}

template <bool with_memory>
void AxisymmetricGround::add_element_force(int ex, int ez) {
  const Line& column = columns_[ex];
  const Row& row = rows_[ez];
  const int I = ex * degree, J = ez * degree;
  double u[2][n][n], f[2][n][n] = {};  // [component][j][i]
  for (int c = 0; c < 2; ++c)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) u[c][j][i] = u_[c][index(I + i, J + j)];
  const int first = layer_element_[ez * columns_.size() + ex];
  const bool is_layer = with_memory && first >= 0;
  const auto divide = [](const Filter& filter, double& state, double x) {
    const double psi = filter.g * x + state;
    state = filter.a * psi + filter.g * x;
    return x - filter.d * psi;
  };
  const auto multiply = [](const Filter& filter, double& state, double x) {
    const double psi = filter.g * x + state;
    state = filter.a * psi + filter.g * x;
    return x + filter.d * psi;
  };

  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      double r_r = 0, r_z = 0, z_r = 0, z_z = 0;
      for (int a = 0; a < n; ++a) {
        r_r += column.derivative[i][a] * u[0][j][a];
        z_r += column.derivative[i][a] * u[1][j][a];
        r_z += row.derivative[j][a] * u[0][a][i];
        z_z += row.derivative[j][a] * u[1][a][i];
      }
      const bool on_axis = column.at_axis && i == 0;
      double hoop = on_axis ? r_r : u[0][j][i] / column.x[i];
      LayerPoint* point = is_layer ? &layer_points_[first + j * n + i] : nullptr;
      const bool is_pml = point && boundary_.layer == AbsorbingLayer::pml;
      if (is_pml) {
        const auto& [along_r, along_z, around] = point->divide;
        r_r = divide(along_r, point->state[0], r_r);
        z_r = divide(along_r, point->state[1], z_r);
        r_z = divide(along_z, point->state[2], r_z);
        z_z = divide(along_z, point->state[3], z_z);
        hoop = divide(around, point->state[4], hoop);
      }
      const double trace = row.lambda * (r_r + z_z + hoop);
      double s_r = trace + 2 * row.mu * r_r, s_z = trace + 2 * row.mu * z_z, s_h = trace + 2 * row.mu * hoop,
             s_rz = row.mu * (r_z + z_r), s_zr = s_rz;  // s_rz works on v_r,z, s_zr on v_z,r
      if (is_pml) {
        const auto& [along_r, along_z, around] = point->multiply;
        s_r = multiply(around, point->state[6], multiply(along_z, point->state[5], s_r));
        s_zr = multiply(around, point->state[8], multiply(along_z, point->state[7], s_zr));
        s_z = multiply(around, point->state[10], multiply(along_r, point->state[9], s_z));
        s_rz = multiply(around, point->state[12], multiply(along_r, point->state[11], s_rz));
        s_h = multiply(along_z, point->state[14], multiply(along_r, point->state[13], s_h));
      } else if (point) {
        s_r = divide(point->divide[0], point->state[0], s_r);
        s_z = divide(point->divide[0], point->state[1], s_z);
        s_h = divide(point->divide[0], point->state[2], s_h);
        s_rz = s_zr = divide(point->divide[0], point->state[3], s_rz);
      }
      const double weight = 2 * pi * column.weight[i] * row.weight[j];
      for (int a = 0; a < n; ++a) {
        f[0][j][a] += weight * column.derivative[i][a] * (on_axis ? s_r + s_h : s_r);
        f[1][j][a] += weight * column.derivative[i][a] * s_zr;
        f[0][a][i] += weight * row.derivative[j][a] * s_rz;
        f[1][a][i] += weight * row.derivative[j][a] * s_z;
      }
      if (!on_axis) f[0][j][i] += weight * s_h / column.x[i];
    }
  for (int c = 0; c < 2; ++c)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) f_[c][index(I + i, J + j)] += f[c][j][i];
}

void AxisymmetricGround::compute_force(bool with_memory) {
  for (int c = 0; c < 2; ++c) f_[c] = spring_[c].cwiseProduct(u_[c]);
  for (int ez = 0; ez < static_cast<int>(rows_.size()); ++ez)
    for (int ex = 0; ex < static_cast<int>(columns_.size()); ++ex)
      if (with_memory)
        add_element_force<true>(ex, ez);
      else
        add_element_force<false>(ex, ez);
  if (far_nodes_.empty()) return;
  for (std::size_t p = 0; p < far_nodes_.size(); ++p)
    for (int c = 0; c < 2; ++c) far_u_[2 * p + c] = u_[c][far_nodes_[p]];
  far_f_.noalias() = far_stiffness_ * far_u_;
  for (std::size_t p = 0; p < far_nodes_.size(); ++p)
    for (int c = 0; c < 2; ++c) f_[c][far_nodes_[p]] += far_f_[2 * p + c];
}

double AxisymmetricGround::compute_stable_step() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  double eigenvalue = 0;
  for (auto& u : u_)
    for (double& value : u) value = uniform(random);
  for (int iteration = 0; iteration < 100; ++iteration) {
    for (int J = 0; J < nJ_; ++J) u_[0][index(0, J)] = 0;
    const double norm = std::sqrt(u_[0].cwiseAbs2().dot(mass_) + u_[1].cwiseAbs2().dot(mass_));
    for (auto& u : u_) u /= norm;
    compute_force(false);
    eigenvalue = u_[0].dot(f_[0]) + u_[1].dot(f_[1]);
    for (int c = 0; c < 2; ++c) u_[c] = f_[c].cwiseQuotient(mass_);
  }
  for (auto& u : u_) u.setZero();
  return 2 / std::sqrt(eigenvalue);
}

void AxisymmetricGround::advance(double force) {
  compute_force(true);
  f_[1] += force * load_;  // downward
  const bool has_memory = !layer_points_.empty();
  const double a = (1 - boundary_.alpha * dt_ / 2) / (1 + boundary_.alpha * dt_ / 2),
               g = dt_ / 2 / (1 + boundary_.alpha * dt_ / 2);
  for (int c = 0; c < 2; ++c) {
    for (Eigen::Index p = 0; p < mass_.size(); ++p) {
      double acceleration = -f_[c][p] / mass_[p];
      if (has_memory && c1_[p] > 0) {
        acceleration -= c0_[p] * u_[c][p];
        double x = u_[c][p];
        for (int k = 0; k < 3; ++k) {
          double& state = psi_state_[c][k][p];
          const double psi = g * x + state;
          state = a * psi + g * x;
          acceleration -= b_[k][p] * psi;
          x = psi;
        }
      }
      const double half = dt_ / 2 * (c1_[p] + damping_[c][p] / mass_[p]);
      v_[c][p] = ((1 - half) * v_[c][p] + dt_ * acceleration) / (1 + half);
    }
    if (c == 0)
      for (int J = 0; J < nJ_; ++J) v_[0][index(0, J)] = 0;
    u_[c] += dt_ * v_[c];
  }
}

std::array<double, 2> AxisymmetricGround::interpolate(const std::array<Eigen::VectorXd, 2>& field,
                                                      double r) const {
  std::size_t e = 0;
  while (e + 1 < columns_.size() && columns_[e].x[degree] < r) ++e;
  const auto shape = compute_shape(columns_[e], r, nullptr);
  std::array<double, 2> value{};
  for (int c = 0; c < 2; ++c)
    for (int i = 0; i < n; ++i)
      value[c] += shape[i] * field[c][index(static_cast<int>(e) * degree + i, nJ_ - 1)];
  return value;
}

std::array<double, 2> AxisymmetricGround::velocity(double r) const {
  return interpolate(v_, r);
}

std::array<double, 2> AxisymmetricGround::displacement(double r) const {
  return interpolate(u_, r);
}

double AxisymmetricGround::largest_velocity() const {
  return std::max(v_[0].cwiseAbs().maxCoeff(), v_[1].cwiseAbs().maxCoeff());
}

double AxisymmetricGround::kinetic_energy() const {
  return (v_[0].cwiseAbs2().dot(mass_) + v_[1].cwiseAbs2().dot(mass_)) / 2;
}

}  // namespace easydyn::soil
