#include "soil/boundary_tables.hpp"

#include <cmath>

#include "soil/axis_tables.hpp"

namespace easydyn::soil {

SpongeFactors compute_sponge(int degree, const std::vector<double>& lines, std::array<double, 2> interior,
                             double strength, double dt) {
  const std::vector<double> position = node_positions(GllRule(degree), lines);
  SpongeFactors factors{std::vector<double>(position.size(), 1.0), std::vector<double>(position.size(), 1.0)};
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
    factors.decay[p] = (1 - a) / (1 + a);
    factors.gain[p] = 1 / (1 + a);
  }
  return factors;
}

BoundaryTables::BoundaryTables(const Lattice& lattice, const std::vector<EngineMaterial>& materials,
                               const EngineBoundary& boundary) {
  const GllRule rule(lattice.degree);
  const auto along_z = [&](const auto& modulus) {
    return assemble_mass(rule, lattice.z, factor_of_slabs(lattice, materials, modulus));
  };
  const auto spring_normal = [](const EngineMaterial& m) {
    const double nu = m.lambda / (2 * (m.lambda + m.mu));
    return 6 * m.mu / (3 - 2 * nu);
  };
  const auto spring_shear = [](const EngineMaterial& m) { return m.mu; };
  const auto dash_p = [](const EngineMaterial& m) { return std::sqrt(m.density * (m.lambda + 2 * m.mu)); };
  const auto dash_s = [](const EngineMaterial& m) { return std::sqrt(m.density * m.mu); };
  spring_normal_z = along_z(spring_normal);
  spring_shear_z = along_z(spring_shear);
  dash_p_z = along_z(dash_p);
  dash_s_z = along_z(dash_s);
  const EngineMaterial& bottom = materials[lattice.layer.front()];
  const double depth = -lattice.z.front();
  spring_normal_bottom = spring_normal(bottom) / depth;
  spring_shear_bottom = spring_shear(bottom) / depth;
  dash_p_bottom = dash_p(bottom);
  dash_s_bottom = dash_s(bottom);
  distance_x = {boundary.origin[0] - lattice.x.front(), lattice.x.back() - boundary.origin[0]};
  distance_y = {boundary.origin[1] - lattice.y.front(), lattice.y.back() - boundary.origin[1]};
}

}  // namespace easydyn::soil
