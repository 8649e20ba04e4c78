#include "soil/wave_engine.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "soil/gll.hpp"

namespace easydyn::soil {

namespace {

template <class T>
double sum_of(pack<T> value) {
  double sum = 0;
  for (int l = 0; l < Pack<T>::lanes; ++l) sum += static_cast<double>(value[l]);
  return sum;
}

int padded_lanes(int nx, int lanes) {
  return (nx + 2 + lanes - 1) / lanes * lanes;
}

/// No thread without a row of elements.
int count_team(int threads, const ElementBlock& part) {
  return std::clamp(threads, 1, part.rows[1] - part.rows[0]);
}

/// Parts of lines that no other rank gets.
std::size_t count_kept_parts(const RegionPlan& plan) {
  std::size_t kept = 0;
  for (const SeamLine& line : plan.seam_lines())
    for (int part = 0; part < line.parts; ++part) kept += line.exchanged[part] < 0 ? 1 : 0;
  return kept;
}

}  // namespace

template <class T>
WaveEngine<T>::WaveEngine(const Lattice& lattice, const std::vector<EngineMaterial>& materials,
                          const std::vector<double>& relaxation_rates, const EngineBoundary& boundary,
                          int threads, Ranks* ranks)
    : lattice_(lattice),
      materials_(materials),
      rates_(relaxation_rates),
      boundary_(boundary),
      ranks_(ranks),
      rank_(ranks ? ranks->rank() : 0),
      partition_(lattice.ny(), lattice.nz(), lattice.degree, ranks ? ranks->size() : 1),
      part_(partition_.block(rank_)),
      team_(count_team(threads, part_)),
      plan_(partition_, lattice.degree, lattice.ny(), lattice.nz(), rank_, team_.size()),
      tile_function_(find_tile_function<T>(lattice.degree)),
      element_function_(find_element_function<T>(lattice.degree)),
      N_(lattice.degree),
      stride_(padded_lanes(lattice.nx(), Pack<T>::lanes)),
      nX_(lattice.nx() * N_ + 1),
      nY_(lattice.ny() * N_ + 1),
      nZ_(lattice.nz() * N_ + 1),
      first_{part_.rows[0] * N_, part_.slabs[0] * N_},
      last_{part_.rows[1] * N_, part_.slabs[1] * N_},
      axes_(lattice, materials, stride_),
      edge_(lattice, materials, boundary),
      blocks_(lattice, materials, axes_, stride_, part_) {
  for (int ez = 0; ez < lattice.nz(); ++ez)
    slabs_.push_back({lattice.layer[ez], lattice.z[ez + 1] - lattice.z[ez],
                      ez > 0 && lattice.layer[ez - 1] == lattice.layer[ez],
                      ez + 1 < lattice.nz() && lattice.layer[ez + 1] == lattice.layer[ez]});
  for (const EngineMaterial& material : materials_)
    if (material.beta > 0) step_field_ = Field::viscous;
  if (!rates_.empty()) step_field_ = Field::memory;

  if (boundary_.absorber == AbsorbingBoundary::matched_layer)
    layer_ = std::make_unique<MatchedLayer<T>>(lattice, boundary, axes_, stride_, part_);

  scratch_.resize(team_.size());
  const int n = N_ + 1;
  for (Scratch& s : scratch_) {
    s.w.assign(2 * guard + n * n * line_size(), T(0));
    s.f.assign(guard + n * n * line_size(), T(0));
    if (layer_) {
      s.row.assign(guard + n * n * line_size(), T(0));
      s.ends.assign(layer_->scratch_size(), T(0));
    }
    const int lines = plan_.most_rows() * N_ + 1;
    for (auto& plane : s.plane) plane.assign(guard + lines * line_size(), T(0));
  }
  make_seams();

  const std::size_t size = 2 * guard + static_cast<std::size_t>(lines_z()) * lines_y() * line_size();
  u_.assign(size, T(0));
  v_.assign(size, T(0));
  zeta_.resize(rates_.size());
  for (auto& zeta : zeta_) zeta.assign(size, T(0));
  if (has_surface()) load_.assign(guard + lines_y() * line_size(), T(0));
  loaded_row_.assign(lines_y(), 0);
}

/// Memory of the seam slots: parts of lines shared with other ranks lie where they are sent from.
template <class T>
void WaveEngine<T>::make_seams() {
  const std::size_t size = line_size();
  seam_.assign(count_kept_parts(plan_) * size, T(0));
  sent_.assign(plan_.sent_lines() * size, T(0));
  received_.assign(plan_.received_lines() * size, T(0));
  slot_line_.assign(plan_.slots(), nullptr);
  T* next = seam_.data();
  for (const SeamLine& line : plan_.seam_lines())
    for (int part = 0; part < line.parts; ++part) {
      if (line.slot[part] < 0) continue;
      T*& place = slot_line_[line.slot[part]];
      if (line.exchanged[part] >= 0) {
        place = sent_.data() + line.exchanged[part] * size;
      } else {
        place = next;
        next += size;
      }
    }
  if (plan_.has_shell()) halo_ = ranks_->make_halo(plan_.graph(size * sizeof(T)));
}

template <class T>
double WaveEngine<T>::compute_memory(const Lattice& lattice, int memory_variables) {
  return compute_memory(lattice, memory_variables, {{0, lattice.ny()}, {0, lattice.nz()}});
}

template <class T>
double WaveEngine<T>::compute_memory(const Lattice& lattice, int memory_variables, const ElementBlock& part) {
  const double lanes = padded_lanes(lattice.nx(), Pack<T>::lanes);
  const double lines = (double(part.rows[1] - part.rows[0]) * lattice.degree + 1) *
                       (double(part.slabs[1] - part.slabs[0]) * lattice.degree + 1);
  return (2.0 + memory_variables) * sizeof(T) * 3 * lattice.degree * lanes * lines;
}

template <class T>
double WaveEngine<T>::compute_table_memory(const Lattice& lattice, const Partition& partition, int rank,
                                           int threads) {
  const ElementBlock part = partition.block(rank);
  const int N = lattice.degree, stride = padded_lanes(lattice.nx(), Pack<T>::lanes);
  const int team = count_team(threads, part);
  const RegionPlan plan(partition, N, lattice.ny(), lattice.nz(), rank, team);
  const double line = 3.0 * N * stride, corners = (N + 1.0) * (N + 1.0);
  const double scratch = 5.0 * guard + 2 * (corners + plan.most_rows() * N + 1) * line;
  const double seams =
      static_cast<double>(count_kept_parts(plan)) + plan.sent_lines() + plan.received_lines();
  const bool has_surface = part.slabs[1] == lattice.nz();
  const double loads = has_surface ? guard + ((part.rows[1] - part.rows[0]) * N + 1.0) * line : 0;
  return BlockTables<T>::compute_memory(lattice, stride, part) +
         sizeof(T) * (team * scratch + seams * line + loads);
}

template <class T>
double WaveEngine<T>::table_memory() const {
  std::size_t values = seam_.size() + sent_.size() + received_.size() + load_.size();
  for (const Scratch& s : scratch_) values += s.w.size() + s.f.size() + s.plane[0].size() + s.plane[1].size();
  return blocks_.memory() + static_cast<double>(values * sizeof(T));
}

template <class T>
double WaveEngine<T>::compute_layer_memory(const Lattice& lattice, const ElementBlock& part, int threads) {
  const int n = lattice.degree + 1, stride = padded_lanes(lattice.nx(), Pack<T>::lanes);
  const double scratch = static_cast<double>(guard) + n * n * 3.0 * lattice.degree * stride +
                         static_cast<double>(MatchedLayer<T>::count_scratch(lattice));
  return MatchedLayer<T>::compute_memory(lattice, stride, part) +
         static_cast<double>(sizeof(T)) * count_team(threads, part) * scratch;
}

template <class T>
double WaveEngine<T>::mass(int X, int Y, int Z) const {
  const auto* line = blocks_.find_mass_line({Y, Z});
  const double ratio =
      line ? static_cast<double>(line->ratio[static_cast<std::size_t>(X % N_) * stride_ + X / N_]) : 1.0;
  return ratio * axes_.mx[X] * axes_.my[Y] * axes_.mz_density[Z];
}

/// Takes the layer's elements out of a row's force and puts the blocks' in.
template <class T>
void WaveEngine<T>::add_blocks(const Tile<T>& tile, Field field, int ey, int ez) const {
  const auto* const found = blocks_.find_row(ey, ez);
  if (!found) return;
  const auto& block = *found;
  const int n = N_ + 1;
  ElementRow<T> row{};
  row.stride = stride_;
  row.first = block.first;
  row.last = block.last;
  row.rmx = axes_.rmx.data();
  row.hx = blocks_.hx.data();
  row.slope_x = blocks_.slope_x.data();
  row.hy = tile.hy;
  row.hz = tile.hz;
  std::copy_n(tile.f, n * n, row.f);
  row.parts = 1;
  row.weight[0] = blocks_.ones.data();
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
  set_part(0, u_, field == Field::weighted ? block.beta : blocks_.ones);
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
  const double strength = layer_ ? 0 : boundary_.sponge_strength * boundary_.sponge_speed;
  const SpongeFactors along_x = compute_sponge(N_, lattice_.x, lattice_.interior_x(), strength, dt);
  decay_x_.assign(static_cast<std::size_t>(N_) * stride_, T(1));
  gain_x_.assign(static_cast<std::size_t>(N_) * stride_, T(1));
  for (int X = 0; X < nX_; ++X) {
    decay_x_[X % N_ * stride_ + X / N_] = static_cast<T>(along_x.decay[X]);
    gain_x_[X % N_ * stride_ + X / N_] = static_cast<T>(along_x.gain[X]);
  }
  sponge_y_ = compute_sponge(N_, lattice_.y, lattice_.interior_y(), strength, dt);
  sponge_z_ = compute_sponge(N_, lattice_.z, lattice_.interior_z(), strength, dt);
  if (layer_) layer_->set_time_step(dt);
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

/// Force of one row of elements. A row with elements of the matched layer is summed up in lines of its own before it goes to
/// those that earlier rows have begun: so the sum has the same bits whatever the regions.
template <class T>
void WaveEngine<T>::apply_row(Tile<T>& tile, Field field, MatchedLayer<T>* layer, int ey, int ez,
                              Scratch& scratch) const {
  if (!layer) {
    tile_function_(tile);
    add_blocks(tile, field, ey, ez);
    return;
  }
  const int lines = (N_ + 1) * (N_ + 1);
  const std::size_t size = line_size();
  T* begun[Tile<T>::max_n * Tile<T>::max_n] = {};
  for (int a = 0; a < lines; ++a)
    if (tile.add[a]) {
      begun[a] = tile.f[a];
      tile.f[a] = scratch.row.data() + a * size;
      tile.add[a] = false;
    }
  if (layer->fills(ey, ez))
    for (int a = 0; a < lines; ++a) std::fill_n(tile.f[a], size, T(0));
  else
    tile_function_(tile);
  add_blocks(tile, field, ey, ez);
  layer->add_forces(tile, ey, ez, scratch.ends.data());
  for (int a = 0; a < lines; ++a)
    if (begun[a]) {
      for (std::size_t p = 0; p < size; ++p) begun[a][p] += tile.f[a][p];
      tile.f[a] = begun[a];
    }
}

/// Runs through the rows of a region, slab by slab from the bottom; `finish(sums, Y, Z, f)` gets each line of
/// nodes when its force is complete and may overwrite the line's field. Lines of seams wait for finish_seams().
template <class T>
template <class Finish>
void WaveEngine<T>::sweep(int thread, const Region& region, Field field, MatchedLayer<T>* layer,
                          const Finish& finish) {
  const FlushSubnormals flush;
  const GllRule rule(N_);
  const int n = N_ + 1, rows = lattice_.ny();
  const std::size_t size = line_size();
  Scratch& scratch = scratch_[thread];
  const auto [r0, r1] = region.elements.rows;
  const auto [s0, s1] = region.elements.slabs;

  Tile<T> tile{};
  tile.stride = stride_;
  tile.rmx = axes_.rmx.data();
  tile.kx = axes_.kx.data();
  tile.kx_left = axes_.kx_left.data();
  tile.x_end = axes_.x_end.data();
  tile.last_lane = lattice_.nx();

  for (int ez = s0; ez < s1; ++ez) {
    if (thread == 0 && is_exchanging_) halo_->make_progress();
    const Slab& slab = slabs_[ez];
    const EngineMaterial& material = materials_[slab.layer];
    const bool top = ez + 1 == s1;
    const bool below_same = slab.below_same && !(layer && layer->fills_slabs(ez - 1)),
               above_same = slab.above_same && !(layer && layer->fills_slabs(ez + 1));
    tile.lambda = static_cast<T>(material.lambda);
    tile.mu = static_cast<T>(material.mu);
    tile.hz = static_cast<T>(slab.hz);
    tile.k_end = above_same ? N_ : n;
    for (int k = 0; k < n; ++k) {
      const double own = rule.weights(k) * slab.hz / 2;
      tile.mz_element[k] = static_cast<T>(own);
      tile.mz[k] = static_cast<T>(k >= tile.k_end ? 0.0 : own);
    }
    if (below_same) tile.mz[0] = static_cast<T>(rule.weights(0) * (slab.hz + slabs_[ez - 1].hz) / 2);

    T* const plane_low = scratch.plane[ez % 2].data();
    T* const plane_high = scratch.plane[(ez + 1) % 2].data();
    for (int ey = r0; ey < r1; ++ey) {
      const bool last_row = ey + 1 == rows;
      // Where the plain elements end.
      const bool low_end =
                     (ey == 0 && !lattice_.half_model) || (layer && ey > 0 && layer->fills_rows(ey - 1)),
                 high_end = last_row || (layer && layer->fills_rows(ey + 1));
      const double hy = lattice_.y[ey + 1] - lattice_.y[ey];
      tile.hy = static_cast<T>(hy);
      tile.j_end = high_end ? n : N_;
      for (int j = 0; j < n; ++j) {
        tile.my_element[j] = static_cast<T>(rule.weights(j) * hy / 2);
        tile.my[j] = static_cast<T>(j < tile.j_end ? axes_.my[ey * N_ + j] : 0.0);
        tile.gradient_end[j] = T(0);
      }
      if (low_end) tile.my[0] = tile.my_element[0];
      if (high_end) tile.my[N_] = tile.my_element[N_];
      // At the plane of symmetry, even or odd, what the terms of the face act on is zero or held.
      if (low_end) tile.gradient_end[0] = T(-0.5);
      if (high_end) tile.gradient_end[N_] = T(0.5);
      tile.y_end = low_end || high_end;

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
          const int seam = region.find_slot({Y, Z}, j == 0, k == 0);
          if (seam >= 0)
            f = slot_line_[seam];
          else if (k == 0)
            f = plane_low + (Y - r0 * N_) * size;
          else if (k == N_)
            f = plane_high + (Y - r0 * N_) * size;
          else
            f = scratch.f.data() + slot * size;
          tile.f[k * n + j] = f;
          tile.add[k * n + j] = seam < 0 && ((k == 0 && ez > s0) || (j == 0 && ey > r0));
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
      apply_row(tile, field, layer, ey, ez, scratch);

      const int j0 = ey == r0 && region.low_y ? 1 : 0, j1 = last_row ? n : N_;
      const int k0 = ez == s0 && region.low_z ? 1 : 0, k1 = top && !region.high_z ? n : N_;
      for (int k = k0; k < k1; ++k)
        for (int j = j0; j < j1; ++j) finish(scratch.sums, ey * N_ + j, ez * N_ + k, tile.f[k * n + j]);
    }
  }
}

/// Adds up the parts of each line of the seams and finishes it; every rank that shares a line does so.
template <class T>
template <class Finish>
void WaveEngine<T>::finish_seams(int thread, const Finish& finish) {
  const FlushSubnormals flush;
  Scratch& scratch = scratch_[thread];
  const std::size_t size = line_size(), count = plan_.seam_lines().size();
  T* const total = scratch.f.data();
  for (std::size_t s = count * thread / team_.size(); s < count * (thread + 1) / team_.size(); ++s) {
    const SeamLine& line = plan_.seam_lines()[s];
    std::array<const T*, 4> part{};
    for (int i = 0; i < line.parts; ++i)
      part[i] = line.slot[i] >= 0 ? slot_line_[line.slot[i]] : received_.data() + line.exchanged[i] * size;
    for (std::size_t p = 0; p < size; ++p) total[p] = part[0][p] + part[1][p];
    for (int i = 2; i < line.parts; ++i)
      for (std::size_t p = 0; p < size; ++p) total[p] += part[i][p];
    finish(line.is_owned ? scratch.sums : scratch.sums_of_others, line.place.Y, line.place.Z, total);
  }
}

template <class T>
template <class Finish>
void WaveEngine<T>::run_sweep(Field field, MatchedLayer<T>* layer, const Finish& finish) {
  const auto run = [&](const RegionPlan::Regions& regions) {
    team_.run([&](int t) {
      for (const Region& region : regions[t]) sweep(t, region, field, layer, finish);
    });
  };
  if (halo_) {
    run(plan_.shell());
    halo_->begin(sent_.data(), received_.data());
    is_exchanging_ = true;
  }
  run(plan_.core());
  if (halo_) {
    is_exchanging_ = false;
    halo_->end();
  }
  if (!plan_.seam_lines().empty()) team_.run([&](int t) { finish_seams(t, finish); });
}

template <class T>
void WaveEngine<T>::add_springs(int Y, int Z, T* f) const {
  if (!boundary_.dashpots) return;
  const T* u = u_.data() + line_offset(Y, Z);
  const std::size_t component = static_cast<std::size_t>(N_) * stride_;
  for (int c = 0; c < 3; ++c, f += component, u += component) {
    const double k_x = (c == 0 ? edge_.spring_normal_z : edge_.spring_shear_z)[Z] * axes_.my[Y];
    if (!lattice_.quarter_model) f[0] += static_cast<T>(k_x / edge_.distance_x[0] / axes_.mx.front()) * u[0];
    f[lattice_.nx()] += static_cast<T>(k_x / edge_.distance_x[1] / axes_.mx.back()) * u[lattice_.nx()];
    double k = 0;
    const double k_y = (c == 1 ? edge_.spring_normal_z : edge_.spring_shear_z)[Z];
    if (Y == 0 && !lattice_.half_model) k += k_y / edge_.distance_y[0];
    if (Y == nY_ - 1) k += k_y / edge_.distance_y[1];
    if (Z == 0) k += (c == 2 ? edge_.spring_normal_bottom : edge_.spring_shear_bottom) * axes_.my[Y];
    if (k == 0) continue;
    const T spring = static_cast<T>(k);
    for (std::size_t p = 0; p < component; ++p) f[p] += spring * u[p];
  }
}

template <class T>
template <bool account>
void WaveEngine<T>::advance_line(Sums& sums, int Y, int Z, T* f) {
  using V = pack<T>;
  add_springs(Y, Z, f);
  const std::size_t offset = line_offset(Y, Z), row_size = static_cast<std::size_t>(N_) * stride_;
  const double line_mass = axes_.my[Y] * axes_.mz_density[Z];
  if (layer_) layer_->add_inertia(Y, Z, line_mass, u_.data() + offset, v_.data() + offset, f);
  const T* const counted_mass = (layer_ ? layer_->plain_mass() : axes_.mx_table).data();
  const auto* const masses = blocks_.find_mass_line({Y, Z});
  const bool loaded = Z == nZ_ - 1 && loaded_row_[Y - first_.Y];
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
    const T* load = loaded ? load_.data() + (Y - first_.Y) * line_size() + c * row_size : nullptr;

    // Factors of the line: sponge along y and z, dashpots of the faces y = const and z = const.
    double decay = sponge_y_.decay[Y] * sponge_z_.decay[Z], gain = sponge_y_.gain[Y] * sponge_z_.gain[Z];
    const auto add_dashpot = [&](double a) {
      decay *= (1 - a) / (1 + a);
      gain /= 1 + a;
    };
    const int last = lattice_.nx();
    if (is_held_at_start(c)) f[c * row_size] = T(0);
    T end_force[2] = {force[0], force[last]};
    if (boundary_.dashpots) {
      const double y_dashpot = dt_ / 2 * (c == 1 ? edge_.dash_p_z : edge_.dash_s_z)[Z] / axes_.mz_density[Z];
      if (Y == 0 && !lattice_.half_model) add_dashpot(y_dashpot / axes_.my.front());
      if (Y == nY_ - 1) add_dashpot(y_dashpot / axes_.my.back());
      if (Z == 0)
        add_dashpot(dt_ / 2 * (c == 2 ? edge_.dash_p_bottom : edge_.dash_s_bottom) / axes_.mz_density[0]);
      // Those of the faces x = const act on the first and the last node only.
      const double x_dashpot = dt_ / 2 * (c == 0 ? edge_.dash_p_z : edge_.dash_s_z)[Z] / axes_.mz_density[Z];
      for (const int end : {0, last}) {
        if (end == 0 && lattice_.quarter_model) continue;
        const double a = x_dashpot / (end == 0 ? axes_.mx.front() : axes_.mx.back());
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
          const V mx = load_pack(counted_mass + p);
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
    if (account && !layer_)
      for (const int end : {0, last}) {
        const double missing = static_cast<double>(end_force[end == 0 ? 0 : 1] - force[end]);
        sums.energy += 0.5 * axes_.mx[end == 0 ? 0 : nX_ - 1] * missing * static_cast<double>(u[end]);
      }
  }
  if constexpr (account) {
    if (!layer_ || !layer_->holds_line(Y, Z)) {
      sums.kinetic += 0.5 * line_mass * sum_of<T>(kinetic);
      sums.energy += 0.5 * line_mass * sum_of<T>(kinetic) + (layer_ ? 0 : 0.5 * sum_of<T>(strain));
    }
    sums.work += 0.5 * dt_ * sum_of<T>(work);
  }
}

template <class T>
void WaveEngine<T>::advance(const std::vector<SurfaceNodeForce>& forces, bool account) {
  for (std::size_t row = 0; row < loaded_row_.size(); ++row)
    if (loaded_row_[row]) {
      std::fill_n(load_.begin() + row * line_size(), line_size(), T(0));
      loaded_row_[row] = 0;
    }
  for (const SurfaceNodeForce& force : forces) {
    if (!has_line(force.Y, nZ_ - 1)) continue;
    if (force.X == 0 && is_held_at_start(force.component)) continue;
    const int row = force.Y - first_.Y;
    load_[row * line_size() + (force.component * N_ + force.X % N_) * stride_ + force.X / N_] -=
        static_cast<T>(force.force / axes_.mx[force.X]);
    loaded_row_[row] = 1;
  }
  if (!account) {
    run_sweep(step_field_, layer_.get(),
              [this](Sums& s, int Y, int Z, T* f) { advance_line<false>(s, Y, Z, f); });
    return;
  }
  for (Scratch& scratch : scratch_) scratch.sums = {};
  run_sweep(step_field_, layer_.get(),
            [this](Sums& s, int Y, int Z, T* f) { advance_line<true>(s, Y, Z, f); });
  energy_ = kinetic_energy_ = step_work_ = 0;
  for (const Scratch& scratch : scratch_) {
    energy_ += scratch.sums.energy;
    kinetic_energy_ += scratch.sums.kinetic;
    step_work_ += scratch.sums.work;
  }
}

template <class T>
std::vector<double> WaveEngine<T>::compute_internal_force() {
  std::vector<double> result(static_cast<std::size_t>(3) * nX_ * nY_ * nZ_);
  run_sweep(Field::plain, nullptr, [&](Sums&, int Y, int Z, T* f) {
    add_springs(Y, Z, f);
    for (int c = 0; c < 3; ++c)
      for (int X = 0; X < nX_; ++X)
        result[((static_cast<std::size_t>(c) * nZ_ + Z) * nY_ + Y) * nX_ + X] =
            axes_.mx[X] *
            static_cast<double>(f[(c * N_ + X % N_) * static_cast<std::size_t>(stride_) + X / N_]);
  });
  return result;
}

/// The same random numbers at each node whatever the number of ranks: all draw those of all nodes.
template <class T>
void WaveEngine<T>::set_random_displacement() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int Z = 0; Z < nZ_; ++Z)
    for (int Y = 0; Y < nY_; ++Y) {
      if (!has_line(Y, Z)) {
        constexpr unsigned long long draws_per_number = 2;  // 32 bits each
        random.discard(3 * draws_per_number *
                       static_cast<unsigned long long>(count_nodes_with_mass(lattice_, {Y, Z})));
        continue;
      }
      for (int c = 0; c < 3; ++c)
        for (int X = 0; X < nX_; ++X)
          u_[index(c, X, Y, Z)] = mass(X, Y, Z) > 0 ? static_cast<T>(uniform(random)) * y_factor(c, Y) : T(0);
    }
}

template <class T>
double WaveEngine<T>::compute_largest_eigenvalue(bool weighted, int iterations) {
  set_random_displacement();
  const std::size_t row_size = static_cast<std::size_t>(N_) * stride_;
  double eigenvalue = 0, scale = 1;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    for (Scratch& scratch : scratch_) scratch.sums = {};
    run_sweep(weighted ? Field::weighted : Field::plain, nullptr, [&](Sums& sums, int Y, int Z, T* f) {
      if (!weighted) add_springs(Y, Z, f);
      T* u = u_.data() + line_offset(Y, Z);
      const double line_mass = axes_.my[Y] * axes_.mz_density[Z];
      const auto* const masses = blocks_.find_mass_line({Y, Z});
      pack<T> xkx{}, xmx{};
      for (int c = 0; c < 3; ++c) {
        if (is_held_at_start(c)) f[c * row_size] = u[c * row_size] = T(0);
        const T factor = static_cast<T>(scale / line_mass) * y_factor(c, Y);
        for (std::size_t p = 0; p < row_size; p += Pack<T>::lanes) {
          const pack<T> x = load_pack(u + c * row_size + p);
          pack<T> mx = load_pack(axes_.mx_table.data() + p), y = factor * load_pack(f + c * row_size + p);
          if (masses) {
            y *= load_pack(masses->inverse.data() + p);
            mx *= load_pack(masses->ratio.data() + p);
          }
          xkx += mx * x * y;
          xmx += mx * x * x;
          store_pack(u + c * row_size + p, y);
        }
      }
      sums.xkx += line_mass / scale * sum_of<T>(xkx);
      sums.xmx += line_mass * sum_of<T>(xmx);
    });
    std::array<double, 2> sums{};
    for (const Scratch& scratch : scratch_) {
      sums[0] += scratch.sums.xkx;
      sums[1] += scratch.sums.xmx;
    }
    if (ranks_) ranks_->sum(sums.data(), sums.size());
    eigenvalue = sums[0] / sums[1];
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
  if (layer_) layer_->set_to_rest();
}

template class WaveEngine<float>;
template class WaveEngine<double>;

}  // namespace easydyn::soil
