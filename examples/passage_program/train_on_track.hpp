#pragma once

#include <memory>
#include <string>
#include <vector>

#include "easydyn/easydyn.hpp"
#include "track/hanging_sleepers.hpp"
#include "track/moving_load.hpp"
#include "track/passage.hpp"
#include "track/profile.hpp"
#include "track/wheel_rail_contact.hpp"
#include "vehicles/moving_loads.hpp"
#include "vehicles/planar_vehicle.hpp"
#include "vehicles/simplified_vehicle.hpp"

namespace easydyn::examples {

/// What is known of the train: "full", "three-masses", "quarter", "wheel-pair" (vehicles/simplified_vehicle.hpp), or null:
/// "moving-loads".
std::unique_ptr<vehicles::VehicleModel> make_vehicle(System& system, const vehicles::RailVehicle& data,
                                                     const std::string& detail);

/// A train at constant speed on a flexible track, with a contact under every wheel pair.
class TrainOnTrack : public System {
 public:
  /// @param x0      of the train's origin at t = 0 [m]
  /// @param speed   [m/s]
  /// @param shape   of all wheels, at angles spread by the golden ratio; null: round
  TrainOnTrack(const vehicles::RailVehicle& data, const track::TrackModel& model, double x0, double speed,
               const std::shared_ptr<const track::Profile>& profile, const std::string& detail = "full",
               const std::shared_ptr<const track::WheelShape>& shape = nullptr, double shape_begin = 0)
      : System("train on track"),
        train(make_vehicle(*this, data, detail)),
        track(*this, model),
        x0_(x0),
        speed_(speed) {
    if (!train) {
      for (const vehicles::MovingLoad& load : vehicles::moving_loads(data).loads) {
        loads.emplace_back(load.name, load.load);
        load_x_.push_back(load.x);
      }
      return;
    }
    for (const auto& w : train->wheels()) {
      wheels.emplace_back(w.name, track::HertzContact(hertz_constant, w.contacts), w.radius, w.static_load,
                          profile);
      const double phase = 2 * units::pi * 0.618034 * static_cast<double>(wheels.size());
      if (shape)
        wheels.back().set_wheel_shape(shape, {.phase = phase, .fade_begin = shape_begin, .fade_length = 10});
    }
  }

  static constexpr double hertz_constant = 1e11;  ///< of one wheel [N/m^1.5]; F: railFE
  std::unique_ptr<vehicles::VehicleModel> train;
  track::FlexibleTrack track;
  std::vector<track::WheelRailContact> wheels;
  std::vector<track::MovingLoad> loads;  ///< instead of wheels, if nothing else is known of the train

  /// All that touches the rail, in order.
  std::vector<const track::TrackContact*> contacts() const {
    std::vector<const track::TrackContact*> list;
    for (const track::WheelRailContact& w : wheels) list.push_back(&w);
    for (const track::MovingLoad& load : loads) list.push_back(&load);
    return list;
  }

 protected:
  void positions() override {
    if (train) train->place(x0_ + speed_ * time());
  }
  void forces() override {
    gravity(vehicles::gravity);
    if (train) train->apply_suspensions();
    for (std::size_t w = 0; w < wheels.size(); ++w) wheels[w].apply(*train->wheels()[w].body, track);
    const double x = x0_ + speed_ * time().value();
    for (std::size_t l = 0; l < loads.size(); ++l) loads[l].apply(x + load_x_[l], speed_, track, energy());
    track::apply_hanging_sleepers(track, energy());
  }

 private:
  double x0_, speed_;
  std::vector<double> load_x_;
};

inline std::unique_ptr<vehicles::VehicleModel> make_vehicle(System& system, const vehicles::RailVehicle& data,
                                                            const std::string& detail) {
  using vehicles::VehicleDetail;
  if (detail == "moving-loads") return nullptr;
  if (detail == "full") return std::make_unique<vehicles::PlanarVehicle>(system, data);
  const VehicleDetail level = detail == "three-masses" ? VehicleDetail::three_masses
                              : detail == "quarter"    ? VehicleDetail::quarter
                                                       : VehicleDetail::wheel_pair;
  return std::make_unique<vehicles::SimplifiedVehicle>(system, data, level);
}

}  // namespace easydyn::examples
