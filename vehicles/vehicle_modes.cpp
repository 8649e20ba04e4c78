#include "vehicles/vehicle_modes.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>

#include "vehicles/planar_vehicle.hpp"

namespace easydyn::vehicles {
namespace {

class VehicleOnRigidRails : public System {
 public:
  explicit VehicleOnRigidRails(const RailVehicle& data) : System(data.label()), vehicle(*this, data) {
    vehicle.hold_wheels();
  }
  PlanarVehicle vehicle;

 protected:
  void positions() override { vehicle.place(0); }
  void forces() override {
    gravity(vehicles::gravity);
    vehicle.apply_suspensions();
  }
};

/// What a body of the system is in the data sheet.
struct PartOfBody {
  VehicleMode::Part part;
  int index;
};

std::vector<PartOfBody> parts_of(const VehicleOnRigidRails& system) {
  const RailVehicle& data = system.vehicle.data();
  std::vector<PartOfBody> parts;
  for (const Body& body : system.bodies()) {
    PartOfBody found{VehicleMode::Part::wheel_pair, 0};
    for (std::size_t i = 0; i < data.bodies.size(); ++i)
      if (data.bodies[i].name == body.name()) found = {VehicleMode::Part::body, static_cast<int>(i)};
    for (std::size_t g = 0; g < data.gears.size(); ++g) {
      if (data.gears[g].name == body.name()) found = {VehicleMode::Part::frame, static_cast<int>(g)};
      for (const WheelPair& pair : data.gears[g].wheel_pairs)
        if (body.name() == pair.name || body.name() == pair.name + ", hub" ||
            body.name() == pair.name + ", tyre")
          found.index = static_cast<int>(g);
    }
    parts.push_back(found);
  }
  return parts;
}

/// Kinetic energies of the bodies, summed over the columns of `shapes` as velocities; factor 1/2 left out.
struct BodyEnergies {
  Eigen::VectorXd bounce, pitch;
};
BodyEnergies compute_energies(VehicleOnRigidRails& system, const Eigen::MatrixXcd& shapes) {
  const auto n = static_cast<Eigen::Index>(system.bodies().size());
  BodyEnergies energies{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  State state = system.initial_state();
  for (const Eigen::VectorXcd shape : shapes.colwise())
    for (const bool is_real : {true, false}) {
      state.qd = is_real ? Eigen::VectorXd(shape.real()) : Eigen::VectorXd(shape.imag());
      system.evaluate(state);
      Eigen::Index i = 0;
      for (const Body& body : system.bodies()) {
        energies.bounce[i] += body.mass() * body.velocity().squaredNorm();
        energies.pitch[i] += body.inertia().J(1, 1) * body.angular_velocity().squaredNorm();
        ++i;
      }
    }
  return energies;
}

/// A basis of the same space, orthonormal with respect to M.
Eigen::MatrixXcd orthonormal(const Eigen::MatrixXcd& shapes, const Eigen::LLT<Eigen::MatrixXd>& M) {
  const Eigen::MatrixXcd upper = Eigen::MatrixXd(M.matrixU()).cast<std::complex<double>>();
  const Eigen::MatrixXcd scaled = upper * shapes;
  const Eigen::HouseholderQR<Eigen::MatrixXcd> qr(scaled);
  const Eigen::MatrixXcd Q = qr.householderQ() * Eigen::MatrixXcd::Identity(shapes.rows(), shapes.cols());
  return upper.triangularView<Eigen::Upper>().solve(Q);
}

}  // namespace

std::vector<VehicleMode> compute_vehicle_modes(const RailVehicle& vehicle) {
  VehicleOnRigidRails system(vehicle);
  const std::vector<PartOfBody> parts = parts_of(system);
  // The forces are linear to about the square of the pitch: a small step, and differences of fourth order
  const Linearization lin = linearize(system, system.initial_state(), 1e-5);
  const Eigen::LLT<Eigen::MatrixXd> M(lin.M);
  const std::vector<Mode> modes = compute_modes(lin);

  std::vector<VehicleMode> rows;
  for (std::size_t first = 0; first < modes.size();) {
    std::size_t end = first + 1;
    while (end < modes.size() &&
           std::abs(modes[end].pole - modes[first].pole) < 1e-5 * std::abs(modes[first].pole))
      ++end;
    Eigen::MatrixXcd shapes(lin.M.rows(), static_cast<Eigen::Index>(end - first));
    for (std::size_t i = first; i < end; ++i)
      shapes.col(static_cast<Eigen::Index>(i - first)) = modes[i].shape;
    const BodyEnergies energies = compute_energies(system, orthonormal(shapes, M));
    const Eigen::VectorXd all = energies.bounce + energies.pitch;
    Eigen::Index most = 0;
    const double largest = all.maxCoeff();
    std::vector<std::string> names;
    for (Eigen::Index i = all.size() - 1; i >= 0; --i)
      if (all[i] >= 0.9 * largest) most = i;  // the foremost of them
    for (Eigen::Index i = 0; i < all.size(); ++i)
      if (all[i] >= 0.9 * largest) names.push_back(system.bodies()[static_cast<std::size_t>(i)].name());
    const bool is_pitch = energies.pitch[most] > energies.bounce[most];
    std::string motion = names[0];
    if (names.size() == 2) motion += " and " + names[1];
    if (names.size() > 2) motion += fmt::format(" and {} others", names.size() - 1);
    const PartOfBody& part = parts[static_cast<std::size_t>(most)];
    rows.push_back({modes[first].pole, modes[first].frequency, modes[first].damping,
                    static_cast<int>(end - first), motion + (is_pitch ? ", pitch" : ", bounce"), part.part,
                    part.index, is_pitch, all[most] / all.sum()});
    first = end;
  }
  return rows;
}

}  // namespace easydyn::vehicles
