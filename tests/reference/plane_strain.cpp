#include "tests/reference/plane_strain.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace easydyn::reference {

namespace {

using Matrix8 = std::array<std::array<double, 8>, 8>;

/// Stiffness of a square element; nodes (0, 0), (1, 0), (0, 1), (1, 1) of (y, z), components y, z alternating. It does not
/// depend on the size.
Matrix8 make_stiffness(double lambda, double mu) {
  Matrix8 K{};
  const double g = 0.5 / std::sqrt(3.0);
  for (const double a : {0.5 - g, 0.5 + g})
    for (const double b : {0.5 - g, 0.5 + g}) {
      const double dy[4] = {-(1 - b), 1 - b, -b, b}, dz[4] = {-(1 - a), -a, 1 - a, a};
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
          K[2 * i][2 * j] += ((lambda + 2 * mu) * dy[i] * dy[j] + mu * dz[i] * dz[j]) / 4;
          K[2 * i][2 * j + 1] += (lambda * dy[i] * dz[j] + mu * dz[i] * dy[j]) / 4;
          K[2 * i + 1][2 * j] += (lambda * dz[i] * dy[j] + mu * dy[i] * dz[j]) / 4;
          K[2 * i + 1][2 * j + 1] += ((lambda + 2 * mu) * dz[i] * dz[j] + mu * dy[i] * dy[j]) / 4;
        }
    }
  return K;
}

}  // namespace

PlaneStrainGround::PlaneStrainGround(double h, double reach, double depth,
                                     const std::function<Material(double y, double z)>& material)
    : h_(h), ny_(static_cast<int>(std::ceil(reach / h))), nz_(static_cast<int>(std::ceil(depth / h))) {
  kind_.resize(static_cast<std::size_t>(ny_) * nz_);
  mass_.assign(static_cast<std::size_t>(ny_ + 1) * (nz_ + 1), 0.0);
  for (int j = 0; j < nz_; ++j)
    for (int i = 0; i < ny_; ++i) {
      const Material m = material((i + 0.5) * h, (j + 0.5 - nz_) * h);
      int& kind = kind_[static_cast<std::size_t>(j) * ny_ + i];
      kind = -1;
      if (!(m.density > 0)) continue;
      const auto same = std::find_if(kinds_.begin(), kinds_.end(), [&](const Material& k) {
        return k.density == m.density && k.cs == m.cs && k.cp == m.cp;
      });
      kind = static_cast<int>(same - kinds_.begin());
      if (same == kinds_.end()) kinds_.push_back(m);
      for (const int n : {0, 1, ny_ + 1, ny_ + 2})
        mass_[static_cast<std::size_t>(j) * (ny_ + 1) + i + n] += m.density * h * h / 4;
    }
}

int PlaneStrainGround::node(double y, double z) const {
  const int i = static_cast<int>(std::lround(y / h_)), j = nz_ + static_cast<int>(std::lround(z / h_));
  const int n = j * (ny_ + 1) + i;
  if (i < 0 || i > ny_ || j < 0 || j > nz_ || std::abs(i * h_ - y) > 1e-9 ||
      std::abs((j - nz_) * h_ - z) > 1e-9 || !(mass_[n] > 0))
    throw std::invalid_argument("plane strain: no node of the ground at this place");
  return n;
}

std::vector<PlaneStrainGround::Record> PlaneStrainGround::run(
    const std::function<double(double)>& q, double half_width, double top,
    const std::vector<std::array<double, 2>>& places, double step, int count) {
  std::vector<Matrix8> stiffness;
  double fastest = 0;
  for (const Material& m : kinds_) {
    const double mu = m.density * m.cs * m.cs;
    stiffness.push_back(make_stiffness(m.density * m.cp * m.cp - 2 * mu, mu));
    fastest = std::max(fastest, m.cp);
  }
  const int steps = static_cast<int>(std::ceil(step * fastest / (0.8 * h_)));  // per output; 1 is the limit
  const double dt = step / steps;

  // Uniform pressure: each surface element of the strip gives half its share to both nodes.
  const int strip = static_cast<int>(std::lround(half_width / h_));
  std::vector<std::pair<int, double>> load;  // force for q = 1; on the plane of symmetry half of it
  for (int i = 0; i <= strip; ++i)
    load.emplace_back(node(i * h_, top), h_ / (2 * half_width) * (i == 0 || i == strip ? 0.5 : 1));
  std::vector<int> receivers;
  for (const auto& [y, z] : places) receivers.push_back(node(y, z));

  const std::size_t n = mass_.size();
  std::vector<double> u(2 * n), v(2 * n), f(2 * n);
  std::vector<Record> records(places.size());
  const auto add_velocities = [&] {
    for (std::size_t r = 0; r < places.size(); ++r) {
      records[r].vy.back() += 0.5 * v[2 * receivers[r]];
      records[r].vz.back() += 0.5 * v[2 * receivers[r] + 1];
    }
  };
  for (int s = 0; s <= (count - 1) * steps; ++s) {
    const bool output = s % steps == 0;
    if (output) {
      for (Record& record : records) record.vy.push_back(0), record.vz.push_back(0);
      add_velocities();
    }
    std::fill(f.begin(), f.end(), 0.0);
    for (int j = 0; j < nz_; ++j)
      for (int i = 0; i < ny_; ++i) {
        const int kind = kind_[static_cast<std::size_t>(j) * ny_ + i];
        if (kind < 0) continue;
        const std::size_t low = 2 * (static_cast<std::size_t>(j) * (ny_ + 1) + i), high = low + 2 * (ny_ + 1);
        double local[8], force[8] = {};
        for (int a = 0; a < 4; ++a) local[a] = u[low + a], local[4 + a] = u[high + a];
        const Matrix8& K = stiffness[kind];
        for (int b = 0; b < 8; ++b)
          for (int a = 0; a < 8; ++a) force[a] += K[b][a] * local[b];
        for (int a = 0; a < 4; ++a) f[low + a] -= force[a], f[high + a] -= force[4 + a];
      }
    const double now = q(s * dt);
    for (const auto& [where, share] : load) f[2 * where + 1] -= share * now;
    for (std::size_t k = 0; k < n; ++k) {
      if (!(mass_[k] > 0)) continue;
      if (k % (ny_ + 1) != 0) v[2 * k] += dt * f[2 * k] / mass_[k];  // u_y = 0 on the plane of symmetry
      v[2 * k + 1] += dt * f[2 * k + 1] / mass_[k];
      u[2 * k] += dt * v[2 * k];
      u[2 * k + 1] += dt * v[2 * k + 1];
    }
    if (output) add_velocities();
  }
  return records;
}

}  // namespace easydyn::reference
