#include "vehicles/axle_loads.hpp"

#include <Eigen/LU>

#include "easydyn/require.hpp"

namespace easydyn::vehicles {
namespace {

/// The linear system under construction. A rigid part has heave at its index and pitch after it.
class Statics {
 public:
  Statics(int motions, int hinges)
      : motions_(motions),
        K_(Eigen::MatrixXd::Zero(motions + hinges, motions + hinges)),
        load_(Eigen::VectorXd::Zero(motions + hinges)) {}

  /// Row of the height of a part at the distance dx ahead of its centre of mass.
  Eigen::RowVectorXd height_at(int part, double dx) const {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(K_.cols());
    row[part] = 1;
    row[part + 1] = -dx;
    return row;
  }
  Eigen::RowVectorXd height(int point) const { return Eigen::RowVectorXd::Unit(K_.cols(), point); }

  void add_weight(int part, double mass) { load_[part] -= gravity * mass; }
  void add_spring(double k, const Eigen::RowVectorXd& shortening) {
    K_ += k * shortening.transpose() * shortening;
  }
  void add_hinge(int number, const Eigen::RowVectorXd& gap) {
    K_.row(motions_ + number) += gap;
    K_.col(motions_ + number) += gap.transpose();
  }

  Eigen::VectorXd solve(const std::string& vehicle) const {
    // unknowns scaled to be comparable: stiffness rows against geometric rows
    const double scale = K_.topLeftCorner(motions_, motions_).diagonal().maxCoeff();
    Eigen::VectorXd d = Eigen::VectorXd::Ones(K_.rows());
    d.tail(K_.rows() - motions_).setConstant(scale);
    const Eigen::MatrixXd scaled = d.asDiagonal() * K_ * d.asDiagonal() / scale;
    Eigen::FullPivLU<Eigen::MatrixXd> lu(scaled);
    lu.setThreshold(1e-11);
    if (!lu.isInvertible())
      throw ModelError(
          vehicle +
          ": a motion without stiffness leaves no static equilibrium; a gear with a single secondary "
          "point does not resist the pitch of an articulated body");
    const Eigen::VectorXd load = d.asDiagonal() * load_ / scale;
    Eigen::VectorXd q = lu.solve(load);
    q += lu.solve(load - scaled * q);  // one refinement: equilibrium to rounding
    return d.asDiagonal() * q;
  }

 private:
  int motions_;
  Eigen::MatrixXd K_;
  Eigen::VectorXd load_;
};

/// A spring of the system and where its force is wanted.
struct Spring {
  double k;
  Eigen::RowVectorXd shortening;
  double* force;
};

}  // namespace

double AxleLoads::gear_load(int gear) const {
  double sum = 0;
  for (const WheelPairLoad& pair : wheel_pairs[gear]) sum += pair.axle_load;
  return sum;
}

double AxleLoads::total() const {
  double sum = 0;
  for (size_t gear = 0; gear < wheel_pairs.size(); ++gear) sum += gear_load(static_cast<int>(gear));
  return sum;
}

AxleLoads compute_axle_loads(const RailVehicle& vehicle) {
  validate(vehicle);
  const int bodies = static_cast<int>(vehicle.bodies.size()), gears = static_cast<int>(vehicle.gears.size()),
            hinges = static_cast<int>(vehicle.hinges.size());
  int motions = 2 * bodies;  // bodies, then frames, then hubs
  for (const RunningGear& gear : vehicle.gears) motions += gear.has_frame() ? 2 : 0;
  int hub = motions;
  for (const RunningGear& gear : vehicle.gears)
    for (const WheelPair& pair : gear.wheel_pairs) motions += pair.resilient ? 1 : 0;

  AxleLoads loads;
  loads.secondary.resize(gears);
  loads.wheel_pairs.resize(gears);
  loads.hinge.resize(hinges);
  Statics statics(motions, hinges);
  std::vector<Spring> springs;
  // bodies and hinges
  for (int i = 0; i < bodies; ++i) statics.add_weight(2 * i, vehicle.bodies[i].mass);
  const auto body_height = [&](const std::string& name, double x) {
    const int i = vehicle.body_index(name);
    return statics.height_at(2 * i, x - vehicle.bodies[i].x);
  };
  for (int i = 0; i < hinges; ++i) {
    const Hinge& hinge = vehicle.hinges[i];
    statics.add_hinge(i, body_height(hinge.rear_body, hinge.x) - body_height(hinge.front_body, hinge.x));
  }
  // gears: secondary suspensions above the frame, wheel pairs below
  int frame = 2 * bodies;
  for (int g = 0; g < gears; ++g) {
    const RunningGear& gear = vehicle.gears[g];
    if (gear.has_frame()) statics.add_weight(frame, gear.frame_mass);
    loads.secondary[g].resize(gear.secondaries.size());
    loads.wheel_pairs[g].resize(gear.wheel_pairs.size());
    for (size_t i = 0; i < gear.secondaries.size(); ++i) {
      const SecondarySuspension& s = gear.secondaries[i];
      springs.push_back({s.stiffness, statics.height_at(frame, s.x - gear.x) - body_height(s.body, s.x),
                         &loads.secondary[g][i]});
    }
    for (size_t i = 0; i < gear.wheel_pairs.size(); ++i) {
      const WheelPair& pair = gear.wheel_pairs[i];
      WheelPairLoad& load = loads.wheel_pairs[g][i];
      load.name = pair.name;
      load.x = pair.x;
      const Eigen::RowVectorXd above =
          gear.has_frame() ? statics.height_at(frame, pair.x - gear.x) : body_height(gear.body, pair.x);
      if (!pair.resilient) {
        springs.push_back({pair.primary_stiffness, -above, &load.primary});
        continue;
      }
      statics.add_weight(hub, pair.mass - pair.resilient->tyre_mass);
      springs.push_back({pair.primary_stiffness, statics.height(hub) - above, &load.primary});
      springs.push_back({pair.resilient->stiffness, -statics.height(hub), &load.resilient});
      ++hub;
    }
    if (gear.has_frame()) frame += 2;
  }
  for (const Spring& spring : springs) statics.add_spring(spring.k, spring.shortening);

  const Eigen::VectorXd q = statics.solve(vehicle.label());
  for (const Spring& spring : springs) *spring.force = spring.k * spring.shortening.dot(q);
  for (int i = 0; i < hinges; ++i) loads.hinge[i] = q[motions + i];
  for (int g = 0; g < gears; ++g)
    for (size_t i = 0; i < loads.wheel_pairs[g].size(); ++i)
      loads.wheel_pairs[g][i].axle_load =
          loads.wheel_pairs[g][i].primary + gravity * vehicle.gears[g].wheel_pairs[i].mass;
  return loads;
}

}  // namespace easydyn::vehicles
