#include "soil/boundary_tables.hpp"

#include <cmath>

#include "soil/axis_tables.hpp"

namespace easydyn::soil {

std::vector<double> compute_edge_damping(int degree, const std::vector<double>& lines,
                                         std::array<double, 2> interior, double strength) {
  std::vector<double> values = node_positions(GllRule(degree), lines);
  const double low = values.front(), high = values.back();
  for (double& value : values) {
    double s = 0, length = 1;
    if (value < interior[0]) {
      length = interior[0] - low;
      s = (interior[0] - value) / length;
    } else if (value > interior[1]) {
      length = high - interior[1];
      s = (value - interior[1]) / length;
    }
    value = strength / length * s * s;
  }
  return values;
}

SpongeFactors compute_sponge(int degree, const std::vector<double>& lines, std::array<double, 2> interior,
                             double strength, double dt) {
  SpongeFactors factors;
  for (const double damping : compute_edge_damping(degree, lines, interior, strength)) {
    const double a = damping * dt / 2;
    factors.decay.push_back((1 - a) / (1 + a));
    factors.gain.push_back(1 / (1 + a));
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
