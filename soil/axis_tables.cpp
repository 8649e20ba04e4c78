#include "soil/axis_tables.hpp"

namespace easydyn::soil {

std::vector<double> node_positions(const GllRule& rule, const std::vector<double>& lines) {
  const int N = rule.degree, n_elements = static_cast<int>(lines.size()) - 1;
  std::vector<double> position(n_elements * N + 1);
  for (int e = 0; e < n_elements; ++e)
    for (int i = 0; i <= N; ++i)
      position[e * N + i] = lines[e] + (lines[e + 1] - lines[e]) * (rule.points(i) + 1) / 2;
  return position;
}

std::vector<double> assemble_mass(const GllRule& rule, const std::vector<double>& lines,
                                  const std::vector<double>& factor) {
  const int N = rule.degree, n_elements = static_cast<int>(lines.size()) - 1;
  std::vector<double> mass(n_elements * N + 1, 0.0);
  for (int e = 0; e < n_elements; ++e)
    for (int i = 0; i <= N; ++i)
      mass[e * N + i] += factor[e] * rule.weights(i) * (lines[e + 1] - lines[e]) / 2;
  return mass;
}

template <class T>
AxisTables<T>::AxisTables(const Lattice& lattice, const std::vector<EngineMaterial>& materials, int stride) {
  const GllRule rule(lattice.degree);
  const int N = lattice.degree, nX = lattice.nx() * N + 1;
  mx = assemble_mass(rule, lattice.x, std::vector<double>(lattice.nx(), 1.0));
  my = assemble_mass(rule, lattice.y, std::vector<double>(lattice.ny(), 1.0));
  mz_density =
      assemble_mass(rule, lattice.z,
                    factor_of_slabs(lattice, materials, [](const EngineMaterial& m) { return m.density; }));

  const std::size_t table = static_cast<std::size_t>(N) * stride;
  rmx.assign(table, T(0));
  kx.assign(table, T(0));
  mx_table.assign(table, T(0));
  kx_left.assign(stride, T(0));
  x_end.assign(stride, T(0));
  for (int X = 0; X < nX; ++X) {
    const int e = X / N, i = X % N;
    rmx[i * stride + e] = static_cast<T>(1 / mx[X]);
    mx_table[i * stride + e] = static_cast<T>(mx[X]);
    if (e < lattice.nx()) kx[i * stride + e] = static_cast<T>(2 / (lattice.x[e + 1] - lattice.x[e]) / mx[X]);
    if (i == 0 && e > 0) kx_left[e] = static_cast<T>(2 / (lattice.x[e] - lattice.x[e - 1]) / mx[X]);
  }
  // At a plane of symmetry, even or odd, what the terms of the face act on is zero or held.
  if (!lattice.quarter_model) x_end[0] = static_cast<T>(-0.5 / mx.front());
  x_end[lattice.nx()] = static_cast<T>(0.5 / mx.back());
}

template struct AxisTables<float>;
template struct AxisTables<double>;

}  // namespace easydyn::soil
