#include "track/periodic_track.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "easydyn/error.hpp"
#include "tests/reference/periodic_support.hpp"
#include "tests/reference/winkler_beam.hpp"
#include "track/receptance.hpp"
#include "track/track_model.hpp"

namespace {

using namespace easydyn::track;
using Complex = std::complex<double>;
const double pi = std::acos(-1.0);

TrackData undamped(TrackData data) {
  data.pad_damping = data.ballast_damping = 0;
  return data;
}

easydyn::reference::PeriodicSupport reference_of(const TrackData& d) {
  const Clm c = as_clm(d.foundation);
  return {.EI = d.rails * d.rail.bending_stiffness(),
          .m = d.rails * d.rail.mass_per_length,
          .L = d.sleeper_spacing,
          .k_p = d.pad_stiffness,
          .d_p = d.pad_damping,
          .m_s = d.sleeper_mass,
          .k_b = d.ballast_stiffness,
          .d_b = d.ballast_damping,
          .m_f = c.m_f,
          .k_f = c.k_f,
          .d_f = c.d_f,
          .k_c = c.k_c,
          .d_c = c.d_c};
}

TEST(BeamDynamicStiffness, IsTheLimitOfManyElements) {
  const TrackData euler = thalys_like_track();
  TrackData timoshenko = euler;
  timoshenko.theory = RailTheory::timoshenko;
  for (const TrackData& data : {euler, timoshenko}) {
    const BeamProperties beam = rail_beam(data);
    const double L = 0.6, omega = 2 * pi * 900;
    const Eigen::Matrix4d exact = compute_beam_dynamic_stiffness(beam, L, omega);
    const auto error = [&](int n) {
      const BeamElement element(beam, L / n);
      Eigen::MatrixXd D = Eigen::MatrixXd::Zero(2 * n + 2, 2 * n + 2);
      for (int e = 0; e < n; ++e)
        D.block<4, 4>(2 * e, 2 * e) += element.compute_stiffness() - omega * omega * element.compute_mass();
      std::vector<int> ends = {0, 1, 2 * n, 2 * n + 1}, inner;
      for (int i = 2; i < 2 * n; ++i) inner.push_back(i);
      const Eigen::MatrixXd D_ii = D(inner, inner), D_ie = D(inner, ends);
      const Eigen::Matrix4d condensed = D(ends, ends) - D_ie.transpose() * D_ii.lu().solve(D_ie);
      return (condensed - exact).norm() / exact.norm();
    };
    const double order = std::log2(error(8) / error(16));
    EXPECT_NEAR(order, beam.is_shear_stiff() ? 4 : 2, 0.05);
  }
}

TEST(PeriodicTrack, HasTheReceptanceOfTheIndependentLatticeSum) {
  for (const TrackData& data : {t2000_like_track(), thalys_like_track()}) {
    const PeriodicTrack track(data);
    const auto reference = reference_of(data);
    for (const double f : {2.0, 20.0, 60.0, 150.0, 400.0, 700.0, 1100.0}) {
      const Complex exact = reference.receptance(2 * pi * f), H = track.compute_rail_receptance(f);
      // measured 1e-10: cancellation in the lattice sum at low frequency
      EXPECT_LT(std::abs(H / exact - 1.0), 1e-8) << f << " Hz";
    }
  }
}

TEST(PeriodicTrack, IsTheLimitOfTheTrackInFiniteElements) {
  const PeriodicTrack exact(thalys_like_track());
  const std::vector<double> frequencies = {20, 100, 400, 700};
  std::vector<double> worst;
  for (const int elements : {1, 2, 4, 8}) {
    TrackData data = thalys_like_track();
    data.elements_per_bay = elements;
    data.ends.bays = 60;
    const TrackModel track(data, 240);
    const Eigen::VectorXcd H = compute_rail_receptance(track, 72, 72, frequencies),
                           H_5 = compute_rail_receptance(track, 72, 75, frequencies);
    double error = 0;
    for (size_t i = 0; i < frequencies.size(); ++i) {
      const Complex point = exact.compute_rail_receptance(frequencies[i]);
      error = std::max(error, std::abs(H[i] - point) / std::abs(point));
      error = std::max(error,
                       std::abs(H_5[i] - exact.compute_rail_receptance(frequencies[i], 5)) / std::abs(point));
    }
    worst.push_back(error);
  }
  EXPECT_LT(worst[2], 2.5e-4);  // four elements per bay, up to 700 Hz: measured 2.1e-4
  EXPECT_NEAR(std::log2(worst[1] / worst[2]), 4, 0.1);  // measured 3.97
  EXPECT_NEAR(std::log2(worst[2] / worst[3]), 4, 0.1);  // measured 3.99
}

TEST(PeriodicTrack, HasOneWaveAheadPerSharedUnknown) {
  TrackData data = thalys_like_track();
  EXPECT_EQ(PeriodicTrack(data).compute_waves(80).size(), 3u);  // rail 2, chain of foundations 1
  data.foundation = RigidGround{};
  EXPECT_EQ(PeriodicTrack(data).compute_waves(80).size(), 2u);
  data.slab = Slab{3e8, 3000};
  EXPECT_EQ(PeriodicTrack(data).compute_waves(80).size(), 4u);
  EXPECT_EQ(PeriodicTrack(zhai_2004_track()).compute_waves(80).size(), 3u);
}

/// One UIC60 rail on springs 0.1 m apart, 50 MN/m2.
TrackData fine_track() {
  TrackData data = undamped(t2000_like_track());
  data.name = "fine";
  data.rail = rail_section("60E1");
  data.rails = 1;
  data.sleeper_spacing = 0.1;
  data.pad_stiffness = 5e6;
  data.sleeper_mass = 1e-6;
  data.ballast_stiffness = 5e12;
  data.foundation = RigidGround{};
  return data;
}

TEST(PeriodicTrack, PropagatesTheWavesOfTheBeamOnABedding) {
  const TrackData data = fine_track();
  const double EI = data.rail.bending_stiffness(), m = data.rail.mass_per_length, k_w = 50e6;
  const PeriodicTrack track(data);
  // cut-on sqrt(k / m) / 2 pi = 145.03 Hz
  EXPECT_TRUE(track.compute_propagating_waves(140).empty());
  for (const double f : {200.0, 300.0, 900.0, 2000.0}) {
    const double omega = 2 * pi * f, k = std::pow((m * omega * omega - k_w) / EI, 0.25);
    const auto waves = track.compute_propagating_waves(f);
    ASSERT_EQ(waves.size(), 1u) << f;
    // springs 0.1 m apart: 4 (lambda a)^4 / 720 = 1.1e-6 of EI; the ballast 1e-6 of k_w
    EXPECT_NEAR(waves[0].wavenumber / k, 1, 5e-6);
    EXPECT_NEAR(waves[0].phase_speed / (omega / k), 1, 5e-6);
    EXPECT_NEAR(waves[0].group_speed / (2 * EI * k * k * k / (m * omega)), 1, 5e-5);
  }
}

TEST(PeriodicTrack, HasTheGroupSpeedOfItsDispersion) {
  const TrackData clm = thalys_like_track();
  TrackData timoshenko = clm, slab = clm;
  timoshenko.theory = RailTheory::timoshenko;
  slab.slab = Slab{3e8, 3000};
  for (const TrackData& data : {clm, timoshenko, slab, zhai_2004_track()}) {
    const PeriodicTrack track(data);
    int compared = 0;
    for (const double f : {70.0, 300.0, 500.0, 700.0, 1000.0, 1500.0}) {
      const auto below = track.compute_propagating_waves(f - 0.01),
                 waves = track.compute_propagating_waves(f),
                 above = track.compute_propagating_waves(f + 0.01);
      if (below.size() != waves.size() || above.size() != waves.size()) continue;
      for (size_t i = 0; i < waves.size(); ++i, ++compared) {
        const double slope = 2 * pi * 0.02 / (above[i].wavenumber - below[i].wavenumber);
        EXPECT_NEAR(waves[i].group_speed / slope, 1, 2e-4) << data.name << " " << f;
      }
    }
    EXPECT_GE(compared, 4);
  }
}

TEST(PeriodicTrack, StopsAtThePinnedPinnedFrequency) {
  const TrackData data = undamped(railfe_default_track());
  const double f = pinned_pinned_frequency(data);
  EXPECT_NEAR(f,
              easydyn::reference::pinned_pinned_frequency(data.rail.bending_stiffness(),
                                                          data.rail.mass_per_length, 0.6),
              1e-9 * f);
  // half a wave per bay with nodes at the sleepers: mu = -1 is an edge of a stop band
  double nearest = 1;
  for (const double g : {f * (1 - 1e-9), f * (1 + 1e-9)})
    for (const TrackWave& wave : PeriodicTrack(data).compute_waves(g))
      nearest = std::min(nearest, std::abs(wave.propagation + 1.0));
  EXPECT_LT(nearest, 1e-3);
  // a Timoshenko rail is softer: closed form, as in rail_beam_test
  TrackData timoshenko = data;
  timoshenko.theory = RailTheory::timoshenko;
  const double shear = pinned_pinned_frequency(timoshenko);
  EXPECT_GT(shear, 0.7 * f);
  EXPECT_LT(shear, 0.85 * f);
}

TEST(DecayRate, FarFromTheForceIsThePropagationConstant) {
  TrackData data = railfe_default_track();
  data.ends.bays = 60;
  data.elements_per_bay = 16;
  const TrackModel track(data, 300);
  const std::vector<double> frequencies = {400, 650, 800};
  const auto near = compute_rail_receptance(track, 60, 66, frequencies),
             far = compute_rail_receptance(track, 60, 78, frequencies);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double measured = 20 * std::log10(std::abs(near[i] / far[i])) / 12;
    const double constant =
        PeriodicTrack(data).compute_waves(frequencies[static_cast<size_t>(i)]).front().decay_rate;
    EXPECT_NEAR(measured / constant, 1, 1e-3) << frequencies[static_cast<size_t>(i)];
  }
}

TEST(DecayRate, OfEn15461IsTheSumOverTheClosedFormOfTheBeam) {
  TrackData data = fine_track();
  const double d = 3e4;  // [N s/m2]
  data.pad_damping = d * 0.1;
  data.elements_per_bay = 2;
  data.ends.bays = 100;
  const TrackModel track(data, 1200);
  const std::vector<double> frequencies = {50, 200, 400};
  const Eigen::VectorXd D = compute_decay_rate(track, 20, frequencies);
  for (size_t i = 0; i < frequencies.size(); ++i) {
    // A(x) ~ exp(-b x) + i exp(-i b x), b^4 = (m w^2 - k - i w d) / EI with the root that decays both ways
    const double w = 2 * pi * frequencies[i], dx = 1e-3;
    const Complex b = std::pow(Complex(60.21 * w * w - 50e6, -w * d) / data.rail.bending_stiffness(), 0.25);
    const auto A = [&](double x) {
      return std::norm(std::exp(-b * x) + Complex(0, 1) * std::exp(Complex(0, -1) * b * x));
    };
    double sum = 0.5 * dx * A(0);
    for (int n = 1; n < 80000; ++n) sum += dx * A(n * dx);
    EXPECT_NEAR(D[static_cast<Eigen::Index>(i)] / (10 / std::log(10.0) * A(0) / sum), 1, 2e-3)
        << frequencies[i];
  }
  EXPECT_THROW(compute_decay_rate(track, 110, frequencies), easydyn::ModelError);
}

TEST(PeriodicTrack, RefusesWhatHasNoSteadyResponse) {
  EXPECT_THROW(PeriodicTrack(fine_track()).compute_rail_receptance(300), easydyn::SolverError);
  EXPECT_THROW(PeriodicTrack(fine_track()).compute_waves(0), easydyn::ModelError);
}

}  // namespace
