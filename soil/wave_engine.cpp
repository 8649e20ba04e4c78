#include "soil/wave_engine.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "soil/gll.hpp"

namespace easydyn::soil {

namespace {

/// Assembled lumped mass of a line of elements: node distances weighted by quadrature, times `factor` of
/// each.
std::vector<double> assemble_mass(const GllRule& rule, const std::vector<double>& lines,
                                  const std::vector<double>& factor) {
  const int N = rule.degree, n_elements = static_cast<int>(lines.size()) - 1;
  std::vector<double> mass(n_elements * N + 1, 0.0);
  for (int e = 0; e < n_elements; ++e)
    for (int i = 0; i <= N; ++i)
      mass[e * N + i] += factor[e] * rule.weights(i) * (lines[e + 1] - lines[e]) / 2;
  return mass;
}

std::vector<double> node_positions(const GllRule& rule, const std::vector<double>& lines) {
  const int N = rule.degree, n_elements = static_cast<int>(lines.size()) - 1;
  std::vector<double> position(n_elements * N + 1);
  for (int e = 0; e < n_elements; ++e)
    for (int i = 0; i <= N; ++i)
      position[e * N + i] = lines[e] + (lines[e + 1] - lines[e]) * (rule.points(i) + 1) / 2;
  return position;
}

/// Sponge factors of the nodes of one axis: `strength` [m/s] / length is the damping at the outer edges.
void make_sponge(const std::vector<double>& position, std::array<double, 2> interior, double strength,
                 double dt, std::vector<double>& decay, std::vector<double>& gain) {
  decay.assign(position.size(), 1.0);
  gain.assign(position.size(), 1.0);
  for (std::size_t p = 0; p < position.size(); ++p) {
    double s = 0, length = 1;
    if (position[p] < interior[0]) {
      length = interior[0] - position.front();
      s = (interior[0] - position[p]) / length;
    } else if (position[p] > interior[1]) {
      length = position.back() - interior[1];
      s = (position[p] - interior[1]) / length;
    }
    const double a = strength / length * s * s * dt / 2;
    decay[p] = (1 - a) / (1 + a);
    gain[p] = 1 / (1 + a);
  }
}

template <class T>
double sum_of(pack<T> value) {
  double sum = 0;
  for (int l = 0; l < Pack<T>::lanes; ++l) sum += static_cast<double>(value[l]);
  return sum;
}

int padded_lanes(int nx, int lanes) {
  return (nx + 2 + lanes - 1) / lanes * lanes;
}

}  // namespace

template <class T>
WaveEngine<T>::WaveEngine(const Lattice& lattice, const std::vector<EngineMaterial>& materials,
                          const std::vector<double>& relaxation_rates, const EngineBoundary& boundary,
                          int threads)
    : lattice_(lattice),
      materials_(materials),
      rates_(relaxation_rates),
      boundary_(boundary),
      team_(std::clamp(threads, 1, lattice.ny())),
      tile_function_(find_tile_function<T>(lattice.degree)),
      element_function_(find_element_function<T>(lattice.degree)),
      N_(lattice.degree),
      stride_(padded_lanes(lattice.nx(), Pack<T>::lanes)),
      nX_(lattice.nx() * N_ + 1),
      nY_(lattice.ny() * N_ + 1),
      nZ_(lattice.nz() * N_ + 1) {
  for (int ez = 0; ez < lattice.nz(); ++ez)
    slabs_.push_back({lattice.layer[ez], lattice.z[ez + 1] - lattice.z[ez],
                      ez > 0 && lattice.layer[ez - 1] == lattice.layer[ez],
                      ez + 1 < lattice.nz() && lattice.layer[ez + 1] == lattice.layer[ez]});
  for (const EngineMaterial& material : materials_)
    if (material.beta > 0) step_field_ = Field::viscous;
  if (!rates_.empty()) step_field_ = Field::memory;

  const int threads_used = team_.size();
  for (int t = 0; t <= threads_used; ++t)
    first_row_.push_back(static_cast<int>(static_cast<long>(lattice.ny()) * t / threads_used));
  scratch_.resize(threads_used);
  const int n = N_ + 1;
  for (int t = 0; t < threads_used; ++t) {
    Scratch& s = scratch_[t];
    s.w.assign(2 * guard + n * n * line_size(), T(0));
    s.f.assign(guard + n * n * line_size(), T(0));
    const int lines = (first_row_[t + 1] - first_row_[t]) * N_ + 1;
    for (auto& plane : s.plane) plane.assign(guard + lines * line_size(), T(0));
    if (t > 0) {
      s.seam_low.assign(nZ_ * line_size(), T(0));
      s.seam_high.assign(nZ_ * line_size(), T(0));
    }
  }

  const std::size_t size = 2 * guard + static_cast<std::size_t>(nZ_) * nY_ * line_size();
  u_.assign(size, T(0));
  v_.assign(size, T(0));
  zeta_.resize(rates_.size());
  for (auto& zeta : zeta_) zeta.assign(size, T(0));
  load_.assign(guard + nY_ * line_size(), T(0));
  loaded_row_.assign(nY_, 0);
  make_line_tables();
  make_boundary_tables();
  if (!lattice_.blocks.empty()) make_block_tables();
}

template <class T>
double WaveEngine<T>::compute_memory(const Lattice& lattice, int memory_variables) {
  const double lanes = padded_lanes(lattice.nx(), Pack<T>::lanes);
  const double lines =
      (double(lattice.ny()) * lattice.degree + 1) * (double(lattice.nz()) * lattice.degree + 1);
  return (2.0 + memory_variables) * sizeof(T) * 3 * lattice.degree * lanes * lines;
}

template <class T>
void WaveEngine<T>::make_line_tables() {
  const GllRule rule(N_);
  const std::vector<double> ones_x(lattice_.nx(), 1.0), ones_y(lattice_.ny(), 1.0);
  std::vector<double> density;
  for (const Slab& slab : slabs_) density.push_back(materials_[slab.layer].density);
  mx_ = assemble_mass(rule, lattice_.x, ones_x);
  my_ = assemble_mass(rule, lattice_.y, ones_y);
  mz_density_ = assemble_mass(rule, lattice_.z, density);

  const std::size_t table = static_cast<std::size_t>(N_) * stride_;
  rmx_.assign(table, T(0));
  kx_.assign(table, T(0));
  mx_table_.assign(table, T(0));
  kx_left_.assign(stride_, T(0));
  x_end_.assign(stride_, T(0));
  for (int X = 0; X < nX_; ++X) {
    const int e = X / N_, i = X % N_;
    rmx_[i * stride_ + e] = static_cast<T>(1 / mx_[X]);
    mx_table_[i * stride_ + e] = static_cast<T>(mx_[X]);
    if (e < lattice_.nx())
      kx_[i * stride_ + e] = static_cast<T>(2 / (lattice_.x[e + 1] - lattice_.x[e]) / mx_[X]);
    if (i == 0 && e > 0) kx_left_[e] = static_cast<T>(2 / (lattice_.x[e] - lattice_.x[e - 1]) / mx_[X]);
  }
  // At a plane of symmetry, even or odd, what the terms of the face act on is zero or held.
  if (!lattice_.quarter_model) x_end_[0] = static_cast<T>(-0.5 / mx_.front());
  x_end_[lattice_.nx()] = static_cast<T>(0.5 / mx_.back());
}

template <class T>
void WaveEngine<T>::make_boundary_tables() {
  const GllRule rule(N_);
  const auto along_z = [&](auto modulus) {
    std::vector<double> factor;
    for (const Slab& slab : slabs_) factor.push_back(modulus(materials_[slab.layer]));
    return assemble_mass(rule, lattice_.z, factor);
  };
  const auto spring_normal = [](const EngineMaterial& m) {
    const double nu = m.lambda / (2 * (m.lambda + m.mu));
    return 6 * m.mu / (3 - 2 * nu);
  };
  const auto spring_shear = [](const EngineMaterial& m) { return m.mu; };
  const auto dash_p = [](const EngineMaterial& m) { return std::sqrt(m.density * (m.lambda + 2 * m.mu)); };
  const auto dash_s = [](const EngineMaterial& m) { return std::sqrt(m.density * m.mu); };
  spring_normal_z_ = along_z(spring_normal);
  spring_shear_z_ = along_z(spring_shear);
  dash_p_z_ = along_z(dash_p);
  dash_s_z_ = along_z(dash_s);
  const EngineMaterial& bottom = materials_[slabs_.front().layer];
  const double depth = -lattice_.z.front();
  spring_normal_bottom_ = spring_normal(bottom) / depth;
  spring_shear_bottom_ = spring_shear(bottom) / depth;
  dash_p_bottom_ = dash_p(bottom);
  dash_s_bottom_ = dash_s(bottom);
  distance_x_ = {boundary_.origin[0] - lattice_.x.front(), lattice_.x.back() - boundary_.origin[0]};
  distance_y_ = {boundary_.origin[1] - lattice_.y.front(), lattice_.y.back() - boundary_.origin[1]};
}

template <class T>
int WaveEngine<T>::find_material(int ex, int ey, int ez) const {
  const auto is_in = [](const std::array<int, 2>& range, int e) { return range[0] <= e && e < range[1]; };
  for (auto block = lattice_.blocks.rbegin(); block != lattice_.blocks.rend(); ++block)
    if (is_in(block->x, ex) && is_in(block->y, ey) && is_in(block->z, ez)) return block->material;
  return lattice_.layer[ez];
}

template <class T>
void WaveEngine<T>::make_block_tables() {
  const int nx = lattice_.nx(), ny = lattice_.ny(), nz = lattice_.nz();
  ones_.assign(stride_, T(1));
  hx_.assign(stride_, T(0));
  slope_x_.assign(stride_, T(0));
  for (int ex = 0; ex < nx; ++ex) {
    const double h = lattice_.x[ex + 1] - lattice_.x[ex];
    hx_[ex] = static_cast<T>(h);
    slope_x_[ex] = static_cast<T>(2 / h);
  }
  block_row_.assign(static_cast<std::size_t>(ny) * nz, -1);
  mass_line_.assign(static_cast<std::size_t>(nY_) * nZ_, -1);
  for (int ez = 0; ez < nz; ++ez)
    for (int ey = 0; ey < ny; ++ey) {
      const int layer = lattice_.layer[ez];
      BlockRow row{nx, 0, {}, {}, {}, {}, {}, {}, {}, {}};
      for (auto* table :
           {&row.lambda, &row.mu, &row.minus_lambda, &row.minus_mu, &row.lambda_change, &row.mu_change,
            &row.beta, &row.minus_weight[0], &row.minus_weight[1], &row.minus_weight[2]})
        table->assign(stride_, T(0));
      for (int ex = 0; ex < nx; ++ex) {
        const int material = find_material(ex, ey, ez);
        if (material == layer) continue;
        row.first = std::min(row.first, ex);
        row.last = ex + 1;
        const EngineMaterial& from = materials_[layer];
        const EngineMaterial to = material < 0 ? EngineMaterial{} : materials_[material];
        row.lambda[ex] = static_cast<T>(to.lambda);
        row.mu[ex] = static_cast<T>(to.mu);
        row.minus_lambda[ex] = static_cast<T>(-from.lambda);
        row.minus_mu[ex] = static_cast<T>(-from.mu);
        row.lambda_change[ex] = static_cast<T>(to.lambda - from.lambda);
        row.mu_change[ex] = static_cast<T>(to.mu - from.mu);
        row.beta[ex] = static_cast<T>(to.beta);
        for (std::size_t l = 0; l < to.memory_weights.size(); ++l)
          row.minus_weight[l][ex] = static_cast<T>(-to.memory_weights[l]);
      }
      if (row.last == 0) continue;
      block_row_[static_cast<std::size_t>(ez) * ny + ey] = static_cast<int>(block_rows_.size());
      block_rows_.push_back(std::move(row));
    }

  // True masses of the lines of those rows.
  const GllRule rule(N_);
  const auto density = [&](int ex, int ey, int ez) {
    const int material = find_material(ex, ey, ez);
    return material < 0 ? 0.0 : materials_[material].density;
  };
  // The one or two elements of a node on an axis, each with its share of the node's length.
  struct Share {
    int element;
    double length;
  };
  const auto shares = [&](const std::vector<double>& lines, int node) {
    std::vector<Share> result;
    const int e = node / N_, i = node % N_;
    if (i == 0 && e > 0) result.push_back({e - 1, rule.weights(N_) * (lines[e] - lines[e - 1]) / 2});
    if (e + 1 < static_cast<int>(lines.size()))
      result.push_back({e, rule.weights(i) * (lines[e + 1] - lines[e]) / 2});
    return result;
  };
  for (int Z = 0; Z < nZ_; ++Z)
    for (int Y = 0; Y < nY_; ++Y) {
      const std::vector<Share> in_y = shares(lattice_.y, Y), in_z = shares(lattice_.z, Z);
      bool has_block = false;
      for (const Share& y : in_y)
        for (const Share& z : in_z)
          has_block = has_block || block_row_[static_cast<std::size_t>(z.element) * ny + y.element] >= 0;
      if (!has_block) continue;
      MassLine line;
      line.ratio.assign(static_cast<std::size_t>(N_) * stride_, T(0));
      line.inverse.assign(static_cast<std::size_t>(N_) * stride_, T(0));
      for (int X = 0; X < nX_; ++X) {
        double sum = 0;
        for (const Share& z : in_z)
          for (const Share& y : in_y)
            for (const Share& x : shares(lattice_.x, X))
              sum += density(x.element, y.element, z.element) * x.length * y.length * z.length;
        const double ratio = sum / mass_of_layers(X, Y, Z);
        const std::size_t place = static_cast<std::size_t>(X % N_) * stride_ + X / N_;
        line.ratio[place] = static_cast<T>(ratio);
        line.inverse[place] = static_cast<T>(ratio > 0 ? 1 / ratio : 0.0);
      }
      mass_line_[static_cast<std::size_t>(Z) * nY_ + Y] = static_cast<int>(mass_lines_.size());
      mass_lines_.push_back(std::move(line));
    }
}

template <class T>
double WaveEngine<T>::mass(int X, int Y, int Z) const {
  const MassLine* line = find_mass_line(Y, Z);
  const double ratio =
      line ? static_cast<double>(line->ratio[static_cast<std::size_t>(X % N_) * stride_ + X / N_]) : 1.0;
  return ratio * mass_of_layers(X, Y, Z);
}

/// Takes the layer's elements out of a row's force and puts the blocks' in.
template <class T>
void WaveEngine<T>::add_blocks(const Tile<T>& tile, Field field, int ey, int ez) const {
  if (block_row_.empty()) return;
  const int number = block_row_[static_cast<std::size_t>(ez) * lattice_.ny() + ey];
  if (number < 0) return;
  const BlockRow& block = block_rows_[number];
  const int n = N_ + 1;
  ElementRow<T> row{};
  row.stride = stride_;
  row.first = block.first;
  row.last = block.last;
  row.rmx = rmx_.data();
  row.hx = hx_.data();
  row.slope_x = slope_x_.data();
  row.hy = tile.hy;
  row.hz = tile.hz;
  std::copy_n(tile.f, n * n, row.f);
  row.parts = 1;
  row.weight[0] = ones_.data();
  std::copy_n(tile.w, n * n, row.part[0]);
  if (field == Field::plain) {  // w is the same for both materials
    row.lambda = block.lambda_change.data();
    row.mu = block.mu_change.data();
    element_function_(row);
    return;
  }
  row.lambda = block.minus_lambda.data();
  row.mu = block.minus_mu.data();
  element_function_(row);

  row.lambda = block.lambda.data();
  row.mu = block.mu.data();
  const auto set_part = [&](int p, const AlignedVector<T>& values, const AlignedVector<T>& weight) {
    row.weight[p] = weight.data();
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        row.part[p][k * n + j] = values.data() + line_offset(ey * N_ + j, ez * N_ + k);
  };
  set_part(0, u_, field == Field::weighted ? block.beta : ones_);
  if (field == Field::viscous) set_part(row.parts++, v_, block.beta);
  if (field == Field::memory)
    for (std::size_t l = 0; l < zeta_.size(); ++l) set_part(row.parts++, zeta_[l], block.minus_weight[l]);
  element_function_(row);
}

template <class T>
void WaveEngine<T>::set_time_step(double dt) {
  dt_ = dt;
  keep_.clear();
  for (const double rate : rates_) keep_.push_back(static_cast<T>(std::exp(-rate * dt)));
  const GllRule rule(N_);
  const double strength = boundary_.sponge_strength * boundary_.sponge_speed;
  std::vector<double> decay, gain;
  make_sponge(node_positions(rule, lattice_.x), lattice_.interior_x(), strength, dt, decay, gain);
  decay_x_.assign(static_cast<std::size_t>(N_) * stride_, T(1));
  gain_x_.assign(static_cast<std::size_t>(N_) * stride_, T(1));
  for (int X = 0; X < nX_; ++X) {
    decay_x_[X % N_ * stride_ + X / N_] = static_cast<T>(decay[X]);
    gain_x_[X % N_ * stride_ + X / N_] = static_cast<T>(gain[X]);
  }
  make_sponge(node_positions(rule, lattice_.y), lattice_.interior_y(), strength, dt, decay_y_, gain_y_);
  make_sponge(node_positions(rule, lattice_.z), lattice_.interior_z(), strength, dt, decay_z_, gain_z_);
}

template <class T>
void WaveEngine<T>::form_line(Field field, int layer, int Y, int Z, T* out) const {
  const EngineMaterial& material = materials_[layer];
  const T* u = u_.data() + line_offset(Y, Z);
  const std::size_t size = line_size();
  const T beta = static_cast<T>(material.beta);
  if (field == Field::weighted) {
    for (std::size_t p = 0; p < size; ++p) out[p] = beta * u[p];
  } else if (field == Field::viscous) {
    const T* v = v_.data() + line_offset(Y, Z);
    for (std::size_t p = 0; p < size; ++p) out[p] = u[p] + beta * v[p];
  } else {
    const std::size_t offset = line_offset(Y, Z);
    const auto y = [&](std::size_t l) { return static_cast<T>(material.memory_weights[l]); };
    switch (zeta_.size()) {
      case 1: {
        const T y0 = y(0);
        const T* z0 = zeta_[0].data() + offset;
        for (std::size_t p = 0; p < size; ++p) out[p] = u[p] - y0 * z0[p];
        break;
      }
      case 2: {
        const T y0 = y(0), y1 = y(1);
        const T *z0 = zeta_[0].data() + offset, *z1 = zeta_[1].data() + offset;
        for (std::size_t p = 0; p < size; ++p) out[p] = u[p] - y0 * z0[p] - y1 * z1[p];
        break;
      }
      default: {
        const T y0 = y(0), y1 = y(1), y2 = y(2);
        const T *z0 = zeta_[0].data() + offset, *z1 = zeta_[1].data() + offset,
                *z2 = zeta_[2].data() + offset;
        for (std::size_t p = 0; p < size; ++p) out[p] = u[p] - y0 * z0[p] - y1 * z1[p] - y2 * z2[p];
      }
    }
  }
}

/// Runs through the rows of one thread, slab by slab from the bottom; `finish(scratch, Y, Z, f)` gets each
/// line of nodes when its force is complete and may overwrite the line's field.
template <class T>
template <class Finish>
void WaveEngine<T>::sweep(int thread, Field field, const Finish& finish) {
  const FlushSubnormals flush;
  const GllRule rule(N_);
  const int n = N_ + 1, rows = lattice_.ny(), slabs = lattice_.nz();
  const std::size_t size = line_size();
  Scratch& scratch = scratch_[thread];
  const int r0 = first_row_[thread], r1 = first_row_[thread + 1];
  const bool seam_low = thread > 0, seam_high = thread + 1 < team_.size();

  Tile<T> tile{};
  tile.stride = stride_;
  tile.rmx = rmx_.data();
  tile.kx = kx_.data();
  tile.kx_left = kx_left_.data();
  tile.x_end = x_end_.data();
  tile.last_lane = lattice_.nx();

  for (int ez = 0; ez < slabs; ++ez) {
    const Slab& slab = slabs_[ez];
    const EngineMaterial& material = materials_[slab.layer];
    const bool top = ez + 1 == slabs;
    tile.lambda = static_cast<T>(material.lambda);
    tile.mu = static_cast<T>(material.mu);
    tile.hz = static_cast<T>(slab.hz);
    tile.k_end = slab.above_same ? N_ : n;
    for (int k = 0; k < n; ++k) {
      const double own = rule.weights(k) * slab.hz / 2;
      tile.mz_element[k] = static_cast<T>(own);
      tile.mz[k] = static_cast<T>(k >= tile.k_end ? 0.0 : own);
    }
    if (slab.below_same) tile.mz[0] = static_cast<T>(rule.weights(0) * (slab.hz + slabs_[ez - 1].hz) / 2);

    T* const plane_low = scratch.plane[ez % 2].data();
    T* const plane_high = scratch.plane[(ez + 1) % 2].data();
    for (int ey = r0; ey < r1; ++ey) {
      const bool last_row = ey + 1 == rows;
      const double hy = lattice_.y[ey + 1] - lattice_.y[ey];
      tile.hy = static_cast<T>(hy);
      tile.j_end = last_row ? n : N_;
      for (int j = 0; j < n; ++j) {
        tile.my_element[j] = static_cast<T>(rule.weights(j) * hy / 2);
        tile.my[j] = static_cast<T>(j < tile.j_end ? my_[ey * N_ + j] : 0.0);
        tile.gradient_end[j] = T(0);
      }
      // At the plane of symmetry, even or odd, what the terms of the face act on is zero or held.
      if (ey == 0 && !lattice_.half_model) tile.gradient_end[0] = T(-0.5);
      if (last_row) tile.gradient_end[N_] = T(0.5);
      tile.y_end = (ey == 0 && !lattice_.half_model) || last_row;

      for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j) {
          const int Y = ey * N_ + j, Z = ez * N_ + k, slot = k * n + Y % n;
          if (field == Field::plain) {
            tile.w[k * n + j] = u_.data() + line_offset(Y, Z);
          } else {
            T* line = scratch.w.data() + guard + slot * size;
            if (j > 0 || ey == r0) form_line(field, slab.layer, Y, Z, line);
            tile.w[k * n + j] = line;
          }
          T* f;
          if (j == 0 && ey == r0 && seam_low)
            f = scratch.seam_high.data() + Z * size;
          else if (j == N_ && ey + 1 == r1 && seam_high)
            f = scratch_[thread + 1].seam_low.data() + Z * size;
          else if (k == 0)
            f = plane_low + (Y - r0 * N_) * size;
          else if (k == N_)
            f = plane_high + (Y - r0 * N_) * size;
          else
            f = scratch.f.data() + slot * size;
          tile.f[k * n + j] = f;
          tile.add[k * n + j] = (k == 0 && ez > 0) || (j == 0 && ey > r0);
        }
      // Soon needed: what finishes this row, then the field of the next row (or of the first one, a slab up).
      tile.ahead_count = 0;
      const auto fetch = [&](const AlignedVector<T>& values, int Y, int Z) {
        if (tile.ahead_count < Tile<T>::max_ahead)
          tile.ahead[tile.ahead_count++] = values.data() + line_offset(Y, Z);
      };
      for (int k = 0; k < N_; ++k)
        for (int j = 0; j < N_; ++j) fetch(v_, ey * N_ + j, ez * N_ + k);
      if (ey + 1 < r1 || !top) {
        const int next_y = (ey + 1 < r1 ? ey + 1 : r0) * N_, next_z = (ey + 1 < r1 ? ez : ez + 1) * N_;
        for (int k = 0; k < n; ++k)
          for (int j = 1; j < n; ++j) {
            fetch(u_, next_y + j, next_z + k);
            if (field == Field::viscous) fetch(v_, next_y + j, next_z + k);
            if (field == Field::memory)
              for (const auto& zeta : zeta_) fetch(zeta, next_y + j, next_z + k);
          }
      }
      tile_function_(tile);
      add_blocks(tile, field, ey, ez);

      const int j0 = ey == r0 && seam_low ? 1 : 0, j1 = last_row ? n : N_, k1 = top ? n : N_;
      for (int k = 0; k < k1; ++k)
        for (int j = j0; j < j1; ++j) finish(scratch, ey * N_ + j, ez * N_ + k, tile.f[k * n + j]);
    }
  }
}

template <class T>
template <class Finish>
void WaveEngine<T>::finish_seam(int thread, const Finish& finish) {
  if (thread == 0) return;
  const FlushSubnormals flush;
  Scratch& scratch = scratch_[thread];
  for (int Z = 0; Z < nZ_; ++Z) {
    T* f = scratch.seam_high.data() + Z * line_size();
    const T* low = scratch.seam_low.data() + Z * line_size();
    for (std::size_t p = 0; p < line_size(); ++p) f[p] += low[p];
    finish(scratch, first_row_[thread] * N_, Z, f);
  }
}

template <class T>
template <class Finish>
void WaveEngine<T>::run_sweep(Field field, const Finish& finish) {
  team_.run([&](int t) { sweep(t, field, finish); });
  if (team_.size() > 1) team_.run([&](int t) { finish_seam(t, finish); });
}

template <class T>
void WaveEngine<T>::add_springs(int Y, int Z, T* f) const {
  if (!boundary_.dashpots) return;
  const T* u = u_.data() + line_offset(Y, Z);
  const std::size_t component = static_cast<std::size_t>(N_) * stride_;
  for (int c = 0; c < 3; ++c, f += component, u += component) {
    const double k_x = (c == 0 ? spring_normal_z_ : spring_shear_z_)[Z] * my_[Y];
    if (!lattice_.quarter_model) f[0] += static_cast<T>(k_x / distance_x_[0] / mx_.front()) * u[0];
    f[lattice_.nx()] += static_cast<T>(k_x / distance_x_[1] / mx_.back()) * u[lattice_.nx()];
    double k = 0;
    const double k_y = (c == 1 ? spring_normal_z_ : spring_shear_z_)[Z];
    if (Y == 0 && !lattice_.half_model) k += k_y / distance_y_[0];
    if (Y == nY_ - 1) k += k_y / distance_y_[1];
    if (Z == 0) k += (c == 2 ? spring_normal_bottom_ : spring_shear_bottom_) * my_[Y];
    if (k == 0) continue;
    const T spring = static_cast<T>(k);
    for (std::size_t p = 0; p < component; ++p) f[p] += spring * u[p];
  }
}

template <class T>
template <bool account>
void WaveEngine<T>::advance_line(Scratch& scratch, int Y, int Z, T* f) {
  using V = pack<T>;
  add_springs(Y, Z, f);
  const std::size_t offset = line_offset(Y, Z), row_size = static_cast<std::size_t>(N_) * stride_;
  const double line_mass = my_[Y] * mz_density_[Z];
  const MassLine* const masses = find_mass_line(Y, Z);
  const bool loaded = Z == nZ_ - 1 && loaded_row_[Y];
  const T dt = static_cast<T>(dt_), half_dt = static_cast<T>(0.5 * dt_);
  const int memories = static_cast<int>(zeta_.size());
  T keep[3] = {};
  for (int l = 0; l < memories; ++l) keep[l] = keep_[l];

  V kinetic{}, strain{}, work{};
  for (int c = 0; c < 3; ++c) {
    T* u = u_.data() + offset + c * row_size;
    T* v = v_.data() + offset + c * row_size;
    T* z[3] = {};
    for (int l = 0; l < memories; ++l) z[l] = zeta_[l].data() + offset + c * row_size;
    const T* force = f + c * row_size;
    const T* load = loaded ? load_.data() + Y * line_size() + c * row_size : nullptr;

    // Factors of the line: sponge along y and z, dashpots of the faces y = const and z = const.
    double decay = decay_y_[Y] * decay_z_[Z], gain = gain_y_[Y] * gain_z_[Z];
    const auto add_dashpot = [&](double a) {
      decay *= (1 - a) / (1 + a);
      gain /= 1 + a;
    };
    const int last = lattice_.nx();
    if (is_held_at_start(c)) f[c * row_size] = T(0);
    T end_force[2] = {force[0], force[last]};
    if (boundary_.dashpots) {
      const double y_dashpot = dt_ / 2 * (c == 1 ? dash_p_z_ : dash_s_z_)[Z] / mz_density_[Z];
      if (Y == 0 && !lattice_.half_model) add_dashpot(y_dashpot / my_.front());
      if (Y == nY_ - 1) add_dashpot(y_dashpot / my_.back());
      if (Z == 0) add_dashpot(dt_ / 2 * (c == 2 ? dash_p_bottom_ : dash_s_bottom_) / mz_density_[0]);
      // Those of the faces x = const act on the first and the last node only.
      const double x_dashpot = dt_ / 2 * (c == 0 ? dash_p_z_ : dash_s_z_)[Z] / mz_density_[Z];
      for (const int end : {0, last}) {
        if (end == 0 && lattice_.quarter_model) continue;
        const double a = x_dashpot / (end == 0 ? mx_.front() : mx_.back());
        v[end] *= static_cast<T>((1 - a) / (1 + a));
        const T load_end = load ? load[end] : T(0);  // added again below
        f[c * row_size + end] = (force[end] + load_end) * static_cast<T>(1 / (1 + a)) - load_end;
      }
    }
    const T line_decay = static_cast<T>(decay) * y_factor(c, Y);
    const T line_gain = static_cast<T>(-gain * dt_ / line_mass) * y_factor(c, Y);

    const auto advance = [&]<int M>() {
      for (std::size_t p = 0; p < row_size; p += Pack<T>::lanes) {
        V total = load_pack(force + p);
        const V internal = total;
        if (load) total += load_pack(load + p);
        if (masses) total *= load_pack(masses->inverse.data() + p);
        const V v_old = load_pack(v + p), u_old = load_pack(u + p);
        const V v_new = load_pack(decay_x_.data() + p) * (line_decay * v_old) +
                        load_pack(gain_x_.data() + p) * (line_gain * total);
        const V u_new = u_old + dt * v_new;
        store_pack(v + p, v_new);
        store_pack(u + p, u_new);
        if constexpr (M > 0) {
          const V middle = u_old + half_dt * v_new;
#pragma GCC unroll 3
          for (int l = 0; l < M; ++l) {
            const V old = load_pack(z[l] + p);
            store_pack(z[l] + p, middle + keep[l] * (old - middle));
          }
        }
        if constexpr (account) {
          // (1 + E) / (2 S): the sponge's share in the mass of the kinetic energy.
          const V decay_p = load_pack(decay_x_.data() + p) * static_cast<T>(decay);
          const V gain_p = load_pack(gain_x_.data() + p) * static_cast<T>(2 * gain);
          const V mx = load_pack(mx_table_.data() + p);
          V kinetic_p = mx * (T(1) + decay_p) / gain_p * v_new * v_new;
          if (masses) kinetic_p *= load_pack(masses->ratio.data() + p);
          kinetic += kinetic_p;
          strain += mx * u_new * internal;
          if (load) work -= mx * load_pack(load + p) * (v_old + v_new);
        }
      }
    };
    switch (memories) {
      case 0:
        advance.template operator()<0>();
        break;
      case 1:
        advance.template operator()<1>();
        break;
      case 2:
        advance.template operator()<2>();
        break;
      default:
        advance.template operator()<3>();
    }
    if constexpr (account)
      for (const int end : {0, last}) {
        const double missing = static_cast<double>(end_force[end == 0 ? 0 : 1] - force[end]);
        scratch.energy += 0.5 * mx_[end == 0 ? 0 : nX_ - 1] * missing * static_cast<double>(u[end]);
      }
  }
  if constexpr (account) {
    scratch.kinetic += 0.5 * line_mass * sum_of<T>(kinetic);
    scratch.energy += 0.5 * line_mass * sum_of<T>(kinetic) + 0.5 * sum_of<T>(strain);
    scratch.work += 0.5 * dt_ * sum_of<T>(work);
  }
}

template <class T>
void WaveEngine<T>::advance(const std::vector<SurfaceNodeForce>& forces, bool account) {
  for (int Y = 0; Y < nY_; ++Y)
    if (loaded_row_[Y]) {
      std::fill_n(load_.begin() + Y * line_size(), line_size(), T(0));
      loaded_row_[Y] = 0;
    }
  for (const SurfaceNodeForce& force : forces) {
    if (force.X == 0 && is_held_at_start(force.component)) continue;
    load_[force.Y * line_size() + (force.component * N_ + force.X % N_) * stride_ + force.X / N_] -=
        static_cast<T>(force.force / mx_[force.X]);
    loaded_row_[force.Y] = 1;
  }
  if (!account) {
    run_sweep(step_field_, [this](Scratch& s, int Y, int Z, T* f) { advance_line<false>(s, Y, Z, f); });
    return;
  }
  for (Scratch& scratch : scratch_) scratch.energy = scratch.kinetic = scratch.work = 0;
  run_sweep(step_field_, [this](Scratch& s, int Y, int Z, T* f) { advance_line<true>(s, Y, Z, f); });
  energy_ = kinetic_energy_ = step_work_ = 0;
  for (const Scratch& scratch : scratch_) {
    energy_ += scratch.energy;
    kinetic_energy_ += scratch.kinetic;
    step_work_ += scratch.work;
  }
}

template <class T>
std::vector<double> WaveEngine<T>::compute_internal_force() {
  std::vector<double> result(static_cast<std::size_t>(3) * nX_ * nY_ * nZ_);
  run_sweep(Field::plain, [&](Scratch&, int Y, int Z, T* f) {
    add_springs(Y, Z, f);
    for (int c = 0; c < 3; ++c)
      for (int X = 0; X < nX_; ++X)
        result[((static_cast<std::size_t>(c) * nZ_ + Z) * nY_ + Y) * nX_ + X] =
            mx_[X] * static_cast<double>(f[(c * N_ + X % N_) * static_cast<std::size_t>(stride_) + X / N_]);
  });
  return result;
}

template <class T>
double WaveEngine<T>::compute_largest_eigenvalue(bool weighted, int iterations) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int Z = 0; Z < nZ_; ++Z)
    for (int Y = 0; Y < nY_; ++Y)
      for (int c = 0; c < 3; ++c)
        for (int X = 0; X < nX_; ++X)
          u_[index(c, X, Y, Z)] = mass(X, Y, Z) > 0 ? static_cast<T>(uniform(random)) * y_factor(c, Y) : T(0);
  const std::size_t row_size = static_cast<std::size_t>(N_) * stride_;
  double eigenvalue = 0, scale = 1;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    for (Scratch& scratch : scratch_) scratch.sum_xkx = scratch.sum_xmx = 0;
    run_sweep(weighted ? Field::weighted : Field::plain, [&](Scratch& scratch, int Y, int Z, T* f) {
      if (!weighted) add_springs(Y, Z, f);
      T* u = u_.data() + line_offset(Y, Z);
      const double line_mass = my_[Y] * mz_density_[Z];
      const MassLine* const masses = find_mass_line(Y, Z);
      pack<T> xkx{}, xmx{};
      for (int c = 0; c < 3; ++c) {
        if (is_held_at_start(c)) f[c * row_size] = u[c * row_size] = T(0);
        const T factor = static_cast<T>(scale / line_mass) * y_factor(c, Y);
        for (std::size_t p = 0; p < row_size; p += Pack<T>::lanes) {
          const pack<T> x = load_pack(u + c * row_size + p);
          pack<T> mx = load_pack(mx_table_.data() + p), y = factor * load_pack(f + c * row_size + p);
          if (masses) {
            y *= load_pack(masses->inverse.data() + p);
            mx *= load_pack(masses->ratio.data() + p);
          }
          xkx += mx * x * y;
          xmx += mx * x * x;
          store_pack(u + c * row_size + p, y);
        }
      }
      scratch.sum_xkx += line_mass / scale * sum_of<T>(xkx);
      scratch.sum_xmx += line_mass * sum_of<T>(xmx);
    });
    double xkx = 0, xmx = 0;
    for (const Scratch& scratch : scratch_) {
      xkx += scratch.sum_xkx;
      xmx += scratch.sum_xmx;
    }
    eigenvalue = xkx / xmx;
    scale = eigenvalue > 0 ? 1 / eigenvalue : 1;
  }
  set_to_rest();
  return eigenvalue;
}

template <class T>
double WaveEngine<T>::compute_stable_step() {
  const double omega2 = compute_largest_eigenvalue(false);
  const double lambda = step_field_ == Field::viscous ? compute_largest_eigenvalue(true) : 0.0;
  // dt^2 omega^2 / 4 + dt lambda / 2 = 1
  return 2 / (lambda / 2 + std::sqrt(lambda * lambda / 4 + omega2));
}

template <class T>
void WaveEngine<T>::set_to_rest() {
  std::fill(u_.begin(), u_.end(), T(0));
  std::fill(v_.begin(), v_.end(), T(0));
  for (auto& zeta : zeta_) std::fill(zeta.begin(), zeta.end(), T(0));
}

template class WaveEngine<float>;
template class WaveEngine<double>;

}  // namespace easydyn::soil
