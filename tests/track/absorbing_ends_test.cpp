#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "track/receptance.hpp"
#include "track/track_model.hpp"

namespace {

using namespace easydyn::track;

/// Largest difference of the rail's receptances, relative to that at the load, between a track with absorbing
/// ends and one so long that nothing returns; load 5 m before the absorbing bays begin.
double reflected(const TrackData& data, std::span<const double> frequencies,
                 std::span<const double> from_load) {
  const double spacing = data.sleeper_spacing, load = 5 + data.ends.bays * spacing;
  const int inside = int(20 / spacing);
  const TrackModel track(data, inside + 2 * data.ends.bays);
  TrackData endless = data;
  endless.ends.bays = 150;
  const int extra = 350;
  const TrackModel reference(endless, inside + 2 * (data.ends.bays + extra), -extra * spacing);
  double worst = 0;
  const Eigen::VectorXcd at_load = compute_rail_receptance(reference, load, load, frequencies);
  for (const double s : from_load) {
    const Eigen::VectorXcd difference = compute_rail_receptance(track, load, load + s, frequencies) -
                                        compute_rail_receptance(reference, load, load + s, frequencies);
    const Eigen::ArrayXd relative = difference.array().abs() / at_load.array().abs();
    worst = std::max(worst, relative.maxCoeff());
  }
  return worst;
}

TEST(AbsorbingEnds, SendNothingBackBelow200Hz) {
  const std::vector<double> frequencies = {1, 5, 10, 20, 40, 60, 80, 100, 130, 160, 180, 200};
  const std::vector<double> from_load = {-4.5, 0, 6};
  EXPECT_LT(reflected(t2000_like_track(), frequencies, from_load), 1e-5);
  EXPECT_LT(reflected(thalys_like_track(), frequencies, from_load), 1e-5);
}

// near the pinned-pinned frequency (877 Hz with sleepers every 0.72 m) the waves hardly travel, and any
// change of the track throws some back
TEST(AbsorbingEnds, SendLittleBackBelowThePinnedPinnedFrequency) {
  const std::vector<double> frequencies = {300, 400, 500, 600, 700};
  const std::vector<double> from_load = {-4.5, 0, 6};
  EXPECT_LT(reflected(t2000_like_track(), frequencies, from_load), 1e-3);
  EXPECT_LT(reflected(thalys_like_track(), frequencies, from_load), 1e-3);
}

}  // namespace
