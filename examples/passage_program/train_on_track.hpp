#pragma once

#include <memory>
#include <vector>

#include "easydyn/easydyn.hpp"
#include "track/passage.hpp"
#include "track/profile.hpp"
#include "track/wheel_rail_contact.hpp"
#include "vehicles/planar_vehicle.hpp"

namespace easydyn::examples {

/// A train at constant speed on a flexible track, with a contact under every wheel pair.
class TrainOnTrack : public System {
 public:
  /// @param x0       of the train's origin at t = 0 [m]
  /// @param speed    [m/s]
  /// @param hertz    constant of one wheel [N/m^1.5]
  TrainOnTrack(const vehicles::RailVehicle& data, const track::TrackModel& model, double x0, double speed,
               const std::shared_ptr<const track::Profile>& profile, double hertz = 1e11)
      : System("train on track"), train(*this, data), track(*this, model), x0_(x0), speed_(speed) {
    for (const auto& w : train.wheels())
      wheels.emplace_back(w.name, track::HertzContact(hertz, w.contacts), w.radius, w.static_load, profile);
  }

  vehicles::PlanarVehicle train;
  track::FlexibleTrack track;
  std::vector<track::WheelRailContact> wheels;

  /// All that touches the track, in order.
  std::vector<const track::TrackContact*> contacts() const {
    std::vector<const track::TrackContact*> list;
    for (const track::WheelRailContact& w : wheels) list.push_back(&w);
    return list;
  }

 protected:
  void positions() override { train.place(x0_ + speed_ * time()); }
  void forces() override {
    gravity(vehicles::gravity);
    train.apply_suspensions();
    for (std::size_t w = 0; w < wheels.size(); ++w) wheels[w].apply(*train.wheels()[w].body, track);
  }

 private:
  double x0_, speed_;
};

}  // namespace easydyn::examples
