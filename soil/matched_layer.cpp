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
MatchedLayer<T>::Places::Places(const Lattice& lattice, int stride, const ElementBlock& part) {
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
    if (has_layer_element) layer_elements.push_back({first, true});
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
      const std::size_t axes = count_axes(others > 0 ? all_elements : layer_elements, others);
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
MatchedLayer<T>::MatchedLayer(const Lattice& lattice, const EngineBoundary& boundary,
                              const AxisTables<T>& axes, int stride, const ElementBlock& part)
    : lattice_(lattice),
      part_(part),
      stride_(stride),
      alpha_(boundary.layer_alpha),
      places_(lattice, stride, part),
      function_(find_stretched_function<T>(lattice.degree)),
      rmx_(axes.rmx) {
  const int N = lattice.degree, nX = lattice.nx() * N + 1;
  const double strength = boundary.layer_strength * boundary.layer_speed;
  d_y_ = compute_edge_damping(N, lattice.y, lattice.interior_y(), strength);
  d_z_ = compute_edge_damping(N, lattice.z, lattice.interior_z(), strength);
  const std::vector<double> d_x = compute_edge_damping(N, lattice.x, lattice.interior_x(), strength);
  const std::size_t table = static_cast<std::size_t>(N) * stride;
  for (auto* values : {&d_x_, &a_x_, &g_x_, &plain_mass_}) values->assign(table, T(0));
  for (auto* values : {&hx_, &slope_x_}) values->assign(static_cast<std::size_t>(stride), T(0));
  for (int X = 0; X < nX; ++X) {
    const std::size_t place = static_cast<std::size_t>(X % N) * stride + X / N;
    d_x_[place] = static_cast<T>(d_x[X]);
    if (!is_behind(lattice.sponge_x, X, N, lattice.nx())) plain_mass_[place] = static_cast<T>(axes.mx[X]);
  }
  for (int ex = 0; ex < lattice.nx(); ++ex) {
    const double h = lattice.x[ex + 1] - lattice.x[ex];
    hx_[ex] = static_cast<T>(h);
    slope_x_[ex] = static_cast<T>(2 / h);
  }
  element_state_.assign(places_.element_states, T(0));
  line_state_.assign(places_.line_states, T(0));
}

template <class T>
void MatchedLayer<T>::set_time_step(double dt) {
  dt_ = dt;
  const int N = lattice_.degree, n = N + 1;
  for (std::size_t p = 0; p < d_x_.size(); ++p) {
    const FilterFactors quotient = make_filter(alpha_ + static_cast<double>(d_x_[p]), dt);
    a_x_[p] = static_cast<T>(quotient.a);
    g_x_[p] = static_cast<T>(quotient.g);
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
void MatchedLayer<T>::add_forces(const Tile<T>& tile, int ey, int ez) {
  const std::ptrdiff_t begin =
      places_.row[static_cast<std::size_t>(ez - part_.slabs[0]) * (part_.rows[1] - part_.rows[0]) +
                  (ey - part_.rows[0])];
  if (begin < 0) return;
  const int n = lattice_.degree + 1;
  StretchedRow<T> row;
  std::copy_n(tile.w, n * n, row.w);
  std::copy_n(tile.f, n * n, row.f);
  row.stride = stride_;
  row.rmx = rmx_.data();
  row.hx = hx_.data();
  row.slope_x = slope_x_.data();
  row.hy = tile.hy;
  row.hz = tile.hz;
  row.lambda = tile.lambda;
  row.mu = tile.mu;
  row.subtracts_plain = !fills(ey, ez);
  const std::vector<LanePack>& packs = fills(ey, ez) ? places_.all_elements : places_.layer_elements;
  row.packs = packs.data();
  row.pack_count = static_cast<int>(packs.size());
  row.stretched_y = fills_rows(ey);
  row.stretched_z = fills_slabs(ez);
  row.state = element_state_.data() + begin;
  const FilterFactors product = make_filter(alpha_, dt_);
  row.a = static_cast<T>(product.a);
  row.g = static_cast<T>(product.g);
  row.d_x = d_x_.data();
  row.a_x = a_x_.data();
  row.g_x = g_x_.data();
  row.d_y = y_.data() + static_cast<std::size_t>(3) * n * ey;
  row.a_y = row.d_y + n;
  row.g_y = row.a_y + n;
  row.d_z = z_.data() + static_cast<std::size_t>(3) * n * ez;
  row.a_z = row.d_z + n;
  row.g_z = row.a_z + n;
  function_(row);
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
        const V d_x = load_pack(d_x_.data() + static_cast<std::size_t>(i) * stride_ + p.first);
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
