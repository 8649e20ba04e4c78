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

TEST(AbsorbingEnds, SendLittleBackOnOtherRailsAndSupports) {
  const std::vector<double> frequencies = {1, 20, 60, 100, 160, 200}, from_load = {-4.5, 6};
  TrackData timoshenko = thalys_like_track(), pads = timoshenko;
  timoshenko.theory = RailTheory::timoshenko;
  pads.under_sleeper_pads = UnderSleeperPads{1.5e8, 4e4};
  EXPECT_LT(reflected(timoshenko, frequencies, from_load), 1e-5);
  EXPECT_LT(reflected(pads, frequencies, from_load), 1e-5);
  EXPECT_LT(reflected(zhai_2004_track(), frequencies, from_load), 2e-4);     // measured 8e-5
  EXPECT_LT(reflected(lincent_like_track(), frequencies, from_load), 4e-4);  // measured 2e-4: little damping
}

// the waves of a slab are long: the default sends back 1 %
TEST(AbsorbingEnds, OfASlabAreTwiceAsLongAndSofter) {
  const std::vector<double> frequencies = {1, 20, 60, 100, 160, 200}, from_load = {-4.5, 6};
  TrackData data = thalys_like_track();
  data.slab = Slab{3e8, 3000};
  data.ends.bays = 40;
  data.ends.alpha = 1500;
  EXPECT_LT(reflected(data, frequencies, from_load), 5e-4);  // measured 3.2e-4
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
