#include "track_on_soil/critical_speed.hpp"

#include "track/free_track_wave.hpp"

namespace easydyn::track_on_soil {

std::optional<soil::ModeCrossing> compute_critical_speed(const track::TrackData& data,
                                                         const soil::Site& site) {
  const track::FreeTrackWave wave = track::compute_free_track_wave(data);
  return soil::find_crossing(soil::LayeredGround(site, soil::GroundDamping::none), wave.frequency,
                             wave.phase_speed);
}

double compute_upper_rayleigh_speed(const soil::Site& site) {
  soil::Site upper = site;
  upper.layers.erase(upper.layers.begin() + 1, upper.layers.end());
  return soil::compute_rayleigh_speeds(soil::LayeredGround(upper, soil::GroundDamping::none), 10).front();
}

}  // namespace easydyn::track_on_soil
