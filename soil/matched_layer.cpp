#include "soil/matched_layer.hpp"

#include <algorithm>

namespace easydyn::soil {
namespace {

struct FilterFactors {
  double a, g;
};

/// psi = x / (i w + pole) by the trapezoidal rule, see StretchedRow.
FilterFactors make_filter(double pole, double dt) {
  const double half = pole * dt / 2;
  return {(1 - half) / (1 + half), dt / 2 / (1 + half)};
}

}  // namespace

template <class T>
MatchedLayer<T>::Ends::Ends(const Lattice& lattice) {
  constexpr int lanes = Pack<T>::lanes;
  int used = 0;
  for (const int end : {0, 1}) {
    const int count = lattice.sponge_x[end];
    if (count == 0) continue;
    pieces.push_back({end == 0 ? 0 : lattice.nx() - count, used, count + 1});
    used += count + 1;
  }
  for (int first = 0; first < used - 1; first += lanes) packs.push_back({first, true});
  stride = (static_cast<int>(packs.size()) + 1) * lanes;  // a pack reads one lane further
}

template <class T>
MatchedLayer<T>::Places::Places(const Lattice& lattice, int stride, const ElementBlock& part)
    : ends(lattice) {
  constexpr int lanes = Pack<T>::lanes;
  const int N = lattice.degree, nx = lattice.nx();
  for (int first = 0; first < stride; first += lanes) {
    bool has_element = false, has_layer_element = false, has_node = false, has_layer_node = false;
    for (int e = first; e < first + lanes; ++e) {
      has_element = has_element || e < nx;
      has_layer_element = has_layer_element || (e < nx && is_layer(lattice.sponge_x, e, nx));
      for (int i = 0; i < N; ++i) {
        const int X = e * N + i;
        if (X > nx * N) continue;
        has_node = true;
        has_layer_node = has_layer_node || is_behind(lattice.sponge_x, X, N, nx);
      }
    }
    if (has_element) all_elements.push_back({first, has_layer_element});
    if (has_node) all_nodes.push_back({first, has_layer_node});
    if (has_layer_node) layer_nodes.push_back({first, true});
  }
  const auto count_axes = [](const std::vector<LanePack>& packs, int others) {
    int axes = 0;
    for (const LanePack& p : packs) axes += others + (p.stretched_x ? 1 : 0);
    return static_cast<std::size_t>(axes);
  };
  const std::size_t per_element_axis =
      static_cast<std::size_t>(StretchedRow<T>::states_per_axis) * (N + 1) * (N + 1) * (N + 1) * lanes;
  for (int ez = part.slabs[0]; ez < part.slabs[1]; ++ez)
    for (int ey = part.rows[0]; ey < part.rows[1]; ++ey) {
      const int others = (is_layer(lattice.sponge_y, ey, lattice.ny()) ? 1 : 0) +
                         (is_layer(lattice.sponge_z, ez, lattice.nz()) ? 1 : 0);
      const std::size_t axes = count_axes(others > 0 ? all_elements : ends.packs, others);
      row.push_back(axes > 0 ? static_cast<std::ptrdiff_t>(element_states) : -1);
      element_states += axes * per_element_axis;
    }
  const std::size_t per_node_axis = static_cast<std::size_t>(3) * N * lanes;
  for (int Z = part.slabs[0] * N; Z <= part.slabs[1] * N; ++Z)
    for (int Y = part.rows[0] * N; Y <= part.rows[1] * N; ++Y) {
      const int others = (is_behind(lattice.sponge_y, Y, N, lattice.ny()) ? 1 : 0) +
                         (is_behind(lattice.sponge_z, Z, N, lattice.nz()) ? 1 : 0);
      const std::size_t axes = count_axes(others > 0 ? all_nodes : layer_nodes, others);
      line.push_back(axes > 0 ? static_cast<std::ptrdiff_t>(line_states) : -1);
      line_states += axes * per_node_axis;
    }
}

template <class T>
double MatchedLayer<T>::compute_memory(const Lattice& lattice, int stride, const ElementBlock& part) {
  const Places places(lattice, stride, part);
  return static_cast<double>((places.element_states + places.line_states) * sizeof(T));
}

template <class T>
std::size_t MatchedLayer<T>::count_scratch(const Lattice& lattice) {
  const int n = lattice.degree + 1;
  return static_cast<std::size_t>(2) * n * n * 3 * lattice.degree * Ends(lattice).stride;
}

template <class T>
MatchedLayer<T>::MatchedLayer(const Lattice& lattice, const EngineBoundary& boundary,
                              const AxisTables<T>& axes, int stride, const ElementBlock& part)
    : lattice_(lattice),
      part_(part),
      stride_(stride),
      alpha_(boundary.layer_alpha),
      places_(lattice, stride, part),
      function_(find_stretched_function<T>(lattice.degree)) {
  const int N = lattice.degree, nX = lattice.nx() * N + 1;
  const double strength = boundary.layer_strength * boundary.layer_speed;
  d_y_ = compute_edge_damping(N, lattice.y, lattice.interior_y(), strength);
  d_z_ = compute_edge_damping(N, lattice.z, lattice.interior_z(), strength);
  const std::vector<double> d_x = compute_edge_damping(N, lattice.x, lattice.interior_x(), strength);
  const auto size = [&](Tables& tables, int lanes) {
    for (auto* values : {&tables.rmx, &tables.d, &tables.a, &tables.g})
      values->assign(static_cast<std::size_t>(N) * lanes, T(0));
    for (auto* values : {&tables.h, &tables.slope}) values->assign(static_cast<std::size_t>(lanes), T(0));
  };
  size(row_, stride);
  row_.rmx = axes.rmx;
  plain_mass_.assign(row_.rmx.size(), T(0));
  for (int X = 0; X < nX; ++X) {
    const std::size_t place = static_cast<std::size_t>(X % N) * stride + X / N;
    row_.d[place] = static_cast<T>(d_x[X]);
    if (!is_behind(lattice.sponge_x, X, N, lattice.nx())) plain_mass_[place] = static_cast<T>(axes.mx[X]);
  }
  for (int ex = 0; ex < lattice.nx(); ++ex) {
    const double h = lattice.x[ex + 1] - lattice.x[ex];
    row_.h[ex] = static_cast<T>(h);
    row_.slope[ex] = static_cast<T>(2 / h);
  }
  const int short_stride = places_.ends.stride;
  size(ends_, short_stride);
  for (const Piece& piece : places_.ends.pieces)
    for (int e = 0; e < piece.count; ++e) {
      for (int i = 0; i < N; ++i) {
        ends_.rmx[i * short_stride + piece.to + e] = row_.rmx[i * stride + piece.from + e];
        ends_.d[i * short_stride + piece.to + e] = row_.d[i * stride + piece.from + e];
      }
      if (e + 1 == piece.count) continue;  // its element is not of the layer
      ends_.h[piece.to + e] = row_.h[piece.from + e];
      ends_.slope[piece.to + e] = row_.slope[piece.from + e];
    }
  element_state_.assign(places_.element_states, T(0));
  line_state_.assign(places_.line_states, T(0));
}

template <class T>
void MatchedLayer<T>::set_time_step(double dt) {
  dt_ = dt;
  const int N = lattice_.degree, n = N + 1;
  for (Tables* tables : {&row_, &ends_})
    for (std::size_t p = 0; p < tables->d.size(); ++p) {
      const FilterFactors quotient = make_filter(alpha_ + static_cast<double>(tables->d[p]), dt);
      tables->a[p] = static_cast<T>(quotient.a);
      tables->g[p] = static_cast<T>(quotient.g);
    }
  const auto fill = [&](const std::vector<double>& d, int elements, std::vector<T>& points) {
    points.clear();
    for (int e = 0; e < elements; ++e) {
      for (int i = 0; i < n; ++i) points.push_back(static_cast<T>(d[e * N + i]));
      for (int i = 0; i < n; ++i) points.push_back(static_cast<T>(make_filter(alpha_ + d[e * N + i], dt).a));
      for (int i = 0; i < n; ++i) points.push_back(static_cast<T>(make_filter(alpha_ + d[e * N + i], dt).g));
    }
  };
  fill(d_y_, lattice_.ny(), y_);
  fill(d_z_, lattice_.nz(), z_);
}

template <class T>
void MatchedLayer<T>::set_to_rest() {
  std::fill(element_state_.begin(), element_state_.end(), T(0));
  std::fill(line_state_.begin(), line_state_.end(), T(0));
}

template <class T>
void MatchedLayer<T>::copy_ends(const T* from, T* to) const {
  const int rows = 3 * lattice_.degree, stride = places_.ends.stride;
  for (const Piece& piece : places_.ends.pieces)
    for (int r = 0; r < rows; ++r)
      std::copy_n(from + r * stride_ + piece.from, piece.count, to + r * stride + piece.to);
}

template <class T>
void MatchedLayer<T>::add_ends(const T* from, T* to) const {
  const int rows = 3 * lattice_.degree, stride = places_.ends.stride;
  for (const Piece& piece : places_.ends.pieces)
    for (int r = 0; r < rows; ++r)
      for (int e = 0; e < piece.count; ++e)
        to[r * stride_ + piece.from + e] += from[r * stride + piece.to + e];
}

template <class T>
void MatchedLayer<T>::add_forces(const Tile<T>& tile, int ey, int ez, T* scratch) {
  const std::ptrdiff_t begin =
      places_.row[static_cast<std::size_t>(ez - part_.slabs[0]) * (part_.rows[1] - part_.rows[0]) +
                  (ey - part_.rows[0])];
  if (begin < 0) return;
  const int n = lattice_.degree + 1;
  const std::size_t lines = lines_of_row(), ends_size = ends_line_size();
  const bool is_whole = fills(ey, ez);
  StretchedRow<T> row;
  for (std::size_t l = 0; l < lines; ++l) {
    row.w[l] = tile.w[l];
    row.f[l] = tile.f[l];
    if (is_whole) continue;
    T *w = scratch + 2 * l * ends_size, *f = w + ends_size;
    copy_ends(tile.w[l], w);
    std::fill_n(f, ends_size, T(0));
    row.w[l] = w;
    row.f[l] = f;
  }
  const Tables& tables = is_whole ? row_ : ends_;
  row.stride = is_whole ? stride_ : places_.ends.stride;
  row.rmx = tables.rmx.data();
  row.hx = tables.h.data();
  row.slope_x = tables.slope.data();
  row.hy = tile.hy;
  row.hz = tile.hz;
  row.lambda = tile.lambda;
  row.mu = tile.mu;
  row.subtracts_plain = !is_whole;
  const std::vector<LanePack>& packs = is_whole ? places_.all_elements : places_.ends.packs;
  row.packs = packs.data();
  row.pack_count = static_cast<int>(packs.size());
  row.stretched_y = fills_rows(ey);
  row.stretched_z = fills_slabs(ez);
  row.state = element_state_.data() + begin;
  const FilterFactors product = make_filter(alpha_, dt_);
  row.a = static_cast<T>(product.a);
  row.g = static_cast<T>(product.g);
  row.d_x = tables.d.data();
  row.a_x = tables.a.data();
  row.g_x = tables.g.data();
  row.d_y = y_.data() + static_cast<std::size_t>(3) * n * ey;
  row.a_y = row.d_y + n;
  row.g_y = row.a_y + n;
  row.d_z = z_.data() + static_cast<std::size_t>(3) * n * ez;
  row.a_z = row.d_z + n;
  row.g_z = row.a_z + n;
  function_(row);
  if (!is_whole)
    for (std::size_t l = 0; l < lines; ++l) add_ends(row.f[l], tile.f[l]);
}

template <class T>
void MatchedLayer<T>::add_inertia(int Y, int Z, double line_mass, const T* u, T* v, T* f) {
  using V = pack<T>;
  constexpr int lanes = Pack<T>::lanes;
  const int N = lattice_.degree;
  const std::ptrdiff_t begin =
      places_
          .line[static_cast<std::size_t>(Z - part_.slabs[0] * N) * ((part_.rows[1] - part_.rows[0]) * N + 1) +
                (Y - part_.rows[0] * N)];
  if (begin < 0) return;
  T* state = line_state_.data() + begin;
  const FilterFactors factors = make_filter(alpha_, dt_);
  const T a = static_cast<T>(factors.a), g = static_cast<T>(factors.g), alpha = static_cast<T>(alpha_),
          mass = static_cast<T>(line_mass), half_dt = static_cast<T>(dt_ / 2);
  const T sum = static_cast<T>(d_y_[Y] + d_z_[Z]), product = static_cast<T>(d_y_[Y] * d_z_[Z]);
  const int others = count_axes_across(Y, Z);
  const auto filter = [&](V x) {
    const V psi = g * x + load_pack(state);
    store_pack(state, a * psi + g * x);
    state += lanes;
    return psi;
  };
  for (const LanePack& p : others > 0 ? places_.all_nodes : places_.layer_nodes) {
    const int axes = others + (p.stretched_x ? 1 : 0);
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i < N; ++i) {
        const std::size_t place = static_cast<std::size_t>(c * N + i) * stride_ + p.first;
        const V d_x = load_pack(row_.d.data() + static_cast<std::size_t>(i) * stride_ + p.first);
        const V c1 = d_x + sum;
        const V u_p = load_pack(u + place), x1 = u_p - alpha * filter(u_p);
        V inertia = -alpha * c1 * x1;
        if (axes > 1) {
          const V x2 = x1 - alpha * filter(x1);
          inertia += (d_x * sum + product) * x2;
          if (axes > 2) inertia += d_x * product * filter(x2);
        }
        const V damping = half_dt * c1, gain = T(1) / (T(1) + damping);
        store_pack(v + place, (T(1) - damping) * gain * load_pack(v + place));
        store_pack(f + place, gain * (load_pack(f + place) + mass * inertia));
      }
  }
}

template class MatchedLayer<float>;
template class MatchedLayer<double>;

}  // namespace easydyn::soil
