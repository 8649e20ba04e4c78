#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "easydyn/error.hpp"
#include "tests/reference/winkler_beam.hpp"
#include "track/receptance.hpp"
#include "track/track_model.hpp"

namespace {

using namespace easydyn::track;

const UnderSleeperPads soft_pads{1.5e8, 4e4};
const BallastMass moving_ballast{1000, 1.5e8, 6e4, 1.6e8, 1.6e5};
const Slab concrete{3e8, 3000};

struct Kind {
  std::string name;
  std::function<void(TrackData&)> change;
};

class TrackWith : public testing::TestWithParam<Kind> {
 protected:
  TrackData data() const {
    TrackData d = t2000_like_track();
    d.ends.bays = 2;
    GetParam().change(d);
    return d;
  }
};

INSTANTIATE_TEST_SUITE_P(
    EachSupport, TrackWith,
    testing::Values(Kind{"timoshenko", [](TrackData& d) { d.theory = RailTheory::timoshenko; }},
                    Kind{"under_sleeper_pads", [](TrackData& d) { d.under_sleeper_pads = soft_pads; }},
                    Kind{"ballast_mass", [](TrackData& d) { d.ballast_mass = moving_ballast; }},
                    Kind{"ballast_mass_on_rigid_ground",
                         [](TrackData& d) { d.ballast_mass = moving_ballast, d.foundation = RigidGround{}; }},
                    Kind{"slab", [](TrackData& d) { d.slab = concrete, d.sleeper_mass = 0; }},
                    Kind{"slab_on_rigid_ground",
                         [](TrackData& d) { d.slab = concrete, d.foundation = RigidGround{}; }},
                    Kind{"everything",
                         [](TrackData& d) {
                           d.theory = RailTheory::timoshenko, d.under_sleeper_pads = soft_pads;
                           d.ballast_mass = moving_ballast, d.slab = concrete;
                         }}),
    [](const auto& test) { return test.param.name; });

TEST_P(TrackWith, HasSymmetricMatricesThatStoreAndDissipateEnergy) {
  const TrackModel track(data(), 6);
  const Eigen::MatrixXd M = track.M(), C = track.C(), K = track.K();
  EXPECT_LT((M - M.transpose()).norm(), 1e-15 * M.norm());
  EXPECT_LT((C - C.transpose()).norm(), 1e-15 * C.norm());
  EXPECT_LT((K - K.transpose()).norm(), 1e-15 * K.norm());
  const auto lowest_pivot = [](const Eigen::MatrixXd& A) {
    return Eigen::LDLT<Eigen::MatrixXd>(A).vectorD().minCoeff();
  };
  EXPECT_GT(lowest_pivot(K), 0);
  EXPECT_GE(lowest_pivot(C), -1e-12 * C.norm());  // rounding only: dampers leave some motions free
  EXPECT_GE(lowest_pivot(M), -1e-12 * M.norm());
}

TEST_P(TrackWith, NumbersEveryUnknownOnceAndByBay) {
  const TrackModel track(data(), 6);
  std::multiset<int> used;
  const auto use = [&](int dof) {
    if (dof >= 0) used.insert(dof);
  };
  for (int node = 0; node < track.nodes(); ++node) {
    use(track.rail_dof(node));
    use(track.rail_dof(node) + 1);
  }
  for (int j = 0; j < track.sleepers(); ++j) {
    EXPECT_LE(track.first_dof(j), track.sleeper_dof(j));
    EXPECT_EQ(track.first_dof(j) + track.support_dofs(), track.rail_dof(j * 4));
    use(track.foundation_dof(j));
    use(track.ballast_dof(j));
    if (data().under_sleeper_pads) use(track.ballast_top_dof(j));
    use(track.sleeper_dof(j));
    use(track.slab_slope_dof(j));
  }
  ASSERT_EQ(int(used.size()), track.size());
  int expected = 0;
  for (const int dof : used) EXPECT_EQ(dof, expected++);
  EXPECT_EQ(track.size(), track.dofs_of(6));
  EXPECT_LE(track.half_bandwidth(), track.dofs_per_bay() + (data().slab ? 1 : 0));
}

TEST_P(TrackWith, CarriesAStaticLoadByItsBallast) {
  const TrackModel track(data(), 40, -10);
  const Eigen::VectorXd q = compute_static_response(track, track.rail_load(2.345, 1e5));
  const Eigen::VectorXd reactions = track.ballast_reactions(q, Eigen::VectorXd::Zero(track.size()));
  EXPECT_NEAR(reactions.sum() / 1e5, 1, 1e-10);
}

// A window takes a principal block: inside it is the same as a short track of its own.
TEST_P(TrackWith, GivesTheInsideOfAShortTrackAsABlockOfALongOne) {
  const TrackModel whole(data(), 30), part(data(), 8);
  EXPECT_TRUE(whole.is_uniform());
  const int first = whole.first_dof(11), n = whole.dofs_of(8), bay = whole.dofs_per_bay();
  ASSERT_EQ(n, part.size());
  const auto inside = [&](const Eigen::MatrixXd& A) -> Eigen::MatrixXd {
    return A.block(bay, bay, n - 2 * bay, n - 2 * bay);
  };
  const auto block = [&](const Eigen::SparseMatrix<double>& A) -> Eigen::MatrixXd {
    return Eigen::MatrixXd(A).block(first, first, n, n);
  };
  EXPECT_EQ(inside(block(whole.M())), inside(part.M()));
  EXPECT_EQ(inside(block(whole.K())), inside(part.K()));
  EXPECT_EQ(inside(block(whole.inner_damping())), inside(part.inner_damping()));
  const Eigen::MatrixXd sum = block(whole.inner_damping()) + Eigen::MatrixXd(whole.compute_end_damping(8));
  EXPECT_EQ(inside(sum), inside(part.C()));
  EXPECT_EQ(Eigen::MatrixXd(whole.C()),
            Eigen::MatrixXd(whole.inner_damping()) + Eigen::MatrixXd(whole.compute_end_damping(30)));
}

TEST_P(TrackWith, TellsEveryValueForTheReport) {
  EXPECT_NO_THROW(validate(data()));
  std::set<std::string> names;
  for (const easydyn::Parameter& p : parameters(data())) EXPECT_TRUE(names.insert(p.name).second) << p.name;
  EXPECT_EQ(names.contains("under-sleeper pad stiffness"), data().under_sleeper_pads.has_value());
  EXPECT_EQ(names.contains("ballast shear damping"), data().ballast_mass.has_value());
  EXPECT_EQ(names.contains("slab mass per length"), data().slab.has_value());
  EXPECT_EQ(names.contains("rail shear factor"), data().theory == RailTheory::timoshenko);
}

const std::vector<double> frequencies = {5, 40, 120, 400};

TEST(UnderSleeperPads, ActInSeriesWithTheBallast) {
  TrackData with = t2000_like_track(), without = with;
  // proportional pads: k_u = n k_b, d_u = n d_b make a ballast n / (n + 1) as stiff, at any frequency
  with.under_sleeper_pads = UnderSleeperPads{3 * with.ballast_stiffness, 3 * with.ballast_damping};
  without.ballast_stiffness = 0.75 * without.ballast_stiffness;
  without.ballast_damping = 0.75 * without.ballast_damping;
  const TrackModel a(with, 60), b(without, 60);
  const auto H_a = compute_rail_receptance(a, 20.1, 21, frequencies),
             H_b = compute_rail_receptance(b, 20.1, 21, frequencies);
  EXPECT_LT((H_a - H_b).norm() / H_b.norm(), 1e-10);
}

TEST(BallastMass, OnRigidGroundIsAFoundationOfItsOwn) {
  TrackData with = t2000_like_track(), without = with;
  with.foundation = RigidGround{};
  with.ballast_mass = moving_ballast;
  without.foundation = Clm{1000, 1.5e8, 6e4, 1.6e8, 1.6e5};
  const TrackModel a(with, 60), b(without, 60);
  const auto H_a = compute_rail_receptance(a, 20.1, 21, frequencies),
             H_b = compute_rail_receptance(b, 20.1, 21, frequencies);
  EXPECT_LT((H_a - H_b).norm() / H_b.norm(), 1e-10);
  // but the soil receives what is below the ballast
  const Eigen::VectorXd q = compute_static_response(a, a.rail_load(20, 1e5));
  EXPECT_NEAR(a.ballast_reaction(28, q, 0 * q), 1.5e8 * q[a.ballast_dof(28)], 1e-6);
}

TEST(Slab, DeflectsAsABeamOnItsBedding) {
  // a soft rail presses the load on one point of the slab through one rigid pad
  TrackData d = t2000_like_track();
  d.foundation = RigidGround{};
  d.slab = concrete;
  d.pad_stiffness = 1e13;
  d.rail.inertia = 1e-12;
  d.ends.bays = 0;
  d.ballast_stiffness = 1e8 * d.sleeper_spacing;  // 100 MN/m2
  const TrackModel track(d, 120);
  const Eigen::VectorXd q = compute_static_response(track, track.rail_load(60 * 0.72, 1e5));
  const easydyn::reference::WinklerBeam beam{3e8, 3000, 1e8};
  // lambda = 0.54 / m: point supports a = 0.72 m apart change EI by 4 (lambda a)^4 / 720 = 1.3e-4
  for (const int n : {0, 1, 3, 6})
    EXPECT_NEAR(q[track.sleeper_dof(60 + n)], beam.static_deflection(1e5, n * 0.72),
                2e-4 * beam.static_deflection(1e5, 0));
}

TEST(SupportVariation, ScalesWhatItNames) {
  TrackData twice = t2000_like_track();
  twice.ends.bays = 2;
  TrackData varied = twice;
  const Clm clm = as_clm(twice.foundation);
  twice.pad_stiffness = 2 * twice.pad_stiffness, twice.pad_damping = 2 * twice.pad_damping;
  twice.ballast_stiffness = 3 * twice.ballast_stiffness, twice.ballast_damping = 3 * twice.ballast_damping;
  twice.foundation = Clm{clm.m_f, 0.5 * clm.k_f, 0.5 * clm.d_f, 0.5 * clm.k_c, 0.5 * clm.d_c};
  varied.variation = [](int, double) { return SupportVariation{2, 3, 0.5}; };
  const TrackModel a(twice, 6), b(varied, 6);
  EXPECT_TRUE(b.is_uniform());
  EXPECT_LT((Eigen::MatrixXd(a.K()) - Eigen::MatrixXd(b.K())).norm(), 1e-15 * a.K().norm());
  EXPECT_LT((Eigen::MatrixXd(a.C()) - Eigen::MatrixXd(b.C())).norm(), 1e-15 * a.C().norm());
  EXPECT_EQ(Eigen::MatrixXd(a.M()), Eigen::MatrixXd(b.M()));
}

TEST(SupportVariation, MakesATransitionThatStaysPassive) {
  TrackData data = t2000_like_track();  // its d_c is negative
  data.ends.bays = 2;
  data.variation = [](int, double x) {
    return SupportVariation{.foundation = x < 3 ? 1.0 : x < 6 ? 1 + (x - 3) * 3 : 10.0};
  };
  const TrackModel track(data, 20);
  EXPECT_FALSE(track.is_uniform());
  EXPECT_DOUBLE_EQ(track.support(6).foundation, 1 + (6 * 0.72 - 3) * 3);
  const Eigen::MatrixXd C = track.C();
  EXPECT_GE(Eigen::LDLT<Eigen::MatrixXd>(C).vectorD().minCoeff(), -1e-12 * C.norm());
  // the stiff side deflects less
  const auto deflection = [&](double x) {
    return track.rail_point(x).deflection(compute_static_response(track, track.rail_load(x, 1e5)));
  };
  EXPECT_GT(deflection(1.44), 1.3 * deflection(12.24));
}

TEST(SupportVariation, IsRefusedByTheSleeperAndReported) {
  using testing::ThrowsMessage;
  const auto built_with = [](const SupportVariation& third) {
    return [third] {
      TrackData data = t2000_like_track();
      data.ends.bays = 0;
      data.variation = [third](int j, double) { return j == 3 ? third : SupportVariation(); };
      return TrackModel(data, 6);
    };
  };
  EXPECT_THAT([&] { built_with({.gap = -1e-3})(); },
              ThrowsMessage<easydyn::ModelError>(
                  "track \"t2000-like\", sleeper 3 at 2.16 m: gap = -0.001 m, must be >= 0"));
  EXPECT_THROW(built_with({.pad = 0})(), easydyn::ModelError);
  EXPECT_THROW(built_with({.ballast = -1})(), easydyn::ModelError);
  EXPECT_THROW(built_with({.foundation = 0})(), easydyn::ModelError);
  const TrackModel track = built_with({.ballast = 0.5, .gap = 2e-3})();
  EXPECT_EQ(track.hanging_sleepers(), std::vector<int>{3});
  double gap = 0, factor = 0;
  for (const easydyn::Parameter& p : parameters(track)) {
    if (p.name == "gap below the sleeper at 2.16 m") gap = p.value;
    if (p.name == "smallest factor on the ballast") factor = p.value;
  }
  EXPECT_EQ(gap, 2e-3);
  EXPECT_EQ(factor, 0.5);
}

}  // namespace
