#include <gtest/gtest.h>

#include "track/passage.hpp"
#include "track/wheel_rail_contact.hpp"
#include "vehicles/planar_vehicle.hpp"
#include "vehicles/t2000_like.hpp"

namespace {

using namespace easydyn;
using namespace easydyn::vehicles;

class TramOnTrack : public System {
 public:
  explicit TramOnTrack(double x0) : x0_(x0) {
    for (const PlanarVehicle::Wheel& w : tram.wheels())
      contacts.emplace_back(w.name, track::HertzContact(1e11, w.contacts), w.radius, w.static_load,
                            std::make_shared<track::FlatProfile>());
  }
  PlanarVehicle tram{*this, t2000_like()};
  track::FlexibleTrack rail{*this, track::TrackModel(track::t2000_like_track(), 121, -60.5 * 0.72)};
  std::vector<track::WheelRailContact> contacts;
  void positions() override { tram.place(x0_ + 8.333 * time()); }
  void forces() override {
    gravity(vehicles::gravity);
    tram.apply_suspensions();
    for (std::size_t w = 0; w < contacts.size(); ++w) contacts[w].apply(*tram.wheels()[w].body, rail);
  }

 private:
  double x0_;
};

// The articulated tram has a soft mode (0.44 Hz): whatever the start leaves in it swings for seconds.
TEST(TramPassage, BeginsWithoutATransientOnAPerfectRail) {
  for (const double x0 : {-8.0, -7.79, -7.6}) {  // anywhere between two sleepers
    TramOnTrack system(x0);
    std::vector<const track::TrackContact*> contacts;
    for (const auto& c : system.contacts) contacts.push_back(&c);
    const track::Passage p = track::compute_passage(
        system, system.rail, contacts,
        {.duration = 1.5, .step = 2e-4, .output_step = 1e-3, .first_sleeper_x = -1, .last_sleeper_x = 1});
    // Heave of the bodies: below 0.05 mm (the step of the example is 1 mm; measured: a few micrometres).
    for (Eigen::Index b = 0; b < 3; ++b) {
      const auto height = p.body_height.col(b);
      EXPECT_LT(height.maxCoeff() - height.minCoeff(), 5e-5)
          << p.body_names[static_cast<std::size_t>(b)] << " " << x0;
    }
    // Contact forces stay within 0.5 % of the static load, the sleeper passing included.
    for (std::size_t w = 0; w < contacts.size(); ++w) {
      const auto force = p.contact_force.col(static_cast<Eigen::Index>(w));
      EXPECT_LT(force.maxCoeff() - force.minCoeff(), 5e-3 * system.contacts[w].static_load())
          << contacts[w]->name();
    }
  }
}

TEST(RailVehicleHinges, MustFollowTheOrderOfTheBodies) {
  RailVehicle tram = t2000_like();
  std::swap(tram.bodies[0], tram.bodies[1]);
  EXPECT_THROW(validate(tram), ModelError);
  tram = t2000_like();
  tram.hinges.push_back({"one too many", tram.hinges[0].front_body, tram.hinges[1].rear_body, 0.0});
  EXPECT_THROW(validate(tram), ModelError);
}

}  // namespace
