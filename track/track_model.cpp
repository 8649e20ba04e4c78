#include "track/track_model.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "easydyn/require.hpp"

namespace easydyn::track {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

/// Adds factor * element (4 x 4) on two deflections a, b with the rotations that follow them.
void add_element(Triplets& to, int a, int b, double factor, const Eigen::Matrix4d& element) {
  const std::array<int, 4> dof = {a, a + 1, b, b + 1};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) to.emplace_back(dof[i], dof[j], factor * element(i, j));
}

/// Adds a spring (or damper) between the unknowns a and b; b < 0 is the fixed ground.
void add_spring(Triplets& to, int a, int b, double k) {
  to.emplace_back(a, a, k);
  if (b < 0) return;
  to.emplace_back(b, b, k);
  to.emplace_back(a, b, -k);
  to.emplace_back(b, a, -k);
}

int compute_half_bandwidth(const Eigen::SparseMatrix<double>& A) {
  Eigen::Index width = 0;
  for (int k = 0; k < A.outerSize(); ++k)
    for (Eigen::SparseMatrix<double>::InnerIterator it(A, k); it; ++it)
      width = std::max(width, std::abs(it.row() - it.col()));
  return static_cast<int>(width);
}

BeamElement slab_element(const TrackData& data) {
  return {data.slab->bending_stiffness, data.slab->mass_per_length, data.sleeper_spacing};
}

BeamElement rail_element(const TrackData& data) {
  validate(data);
  return {rail_beam(data), data.sleeper_spacing / data.elements_per_bay};
}

/// t^3 of AbsorbingEnds at a place on a track of so many bays; place and ends counted in bays.
double absorption(double place, int bays, int absorbing) {
  if (absorbing == 0) return 0;
  const double t = std::max(1 - place / absorbing, 1 - (bays - place) / absorbing);
  return t > 0 ? t * t * t : 0;
}

}  // namespace

TrackModel::TrackModel(const TrackData& data, int bays, double begin)
    : data_(data),
      bays_(bays),
      begin_(begin),
      rigid_(is_rigid(data.foundation) ? 1 : 0),
      element_(rail_element(data)) {
  const std::string track = data_.label();
  require(bays >= 1, track, "bays", bays, "", ">= 1");
  require_finite(track, "x of the first sleeper", begin, "m");
  support_dofs_ = 1 + (rigid_ ? 0 : 1) + (data_.ballast_mass ? 1 : 0) + (data_.under_sleeper_pads ? 1 : 0) +
                  (data_.slab ? 1 : 0);
  dofs_per_bay_ = 2 * data_.elements_per_bay + support_dofs_;
  read_variation();

  const int n = dofs_of(bays);
  Triplets M, C, K;
  const Eigen::Matrix4d M_e = element_.compute_mass(), K_e = element_.compute_stiffness();
  for (int node = 0; node + 1 < nodes(); ++node) {
    const int first = rail_dof(node), second = rail_dof(node + 1);
    add_element(M, first, second, 1, M_e);
    add_element(K, first, second, 1, K_e);
  }
  if (data_.slab) {
    const BeamElement slab = slab_element(data_);
    for (int j = 0; j < bays; ++j) {
      add_element(M, sleeper_dof(j), sleeper_dof(j + 1), 1, slab.compute_mass());
      add_element(K, sleeper_dof(j), sleeper_dof(j + 1), 1, slab.compute_stiffness());
    }
  }
  const Clm ground = as_clm(data_.foundation);
  for (int j = 0; j < sleepers(); ++j) {
    const SupportVariation& here = support(j);
    const int w = rail_dof(j * data_.elements_per_bay), u_s = sleeper_dof(j), u_f = foundation_dof(j);
    M.emplace_back(u_s, u_s, data_.sleeper_mass);
    add_spring(K, u_s, w, here.pad * data_.pad_stiffness);
    add_spring(C, u_s, w, here.pad * data_.pad_damping);
    if (const auto& pads = data_.under_sleeper_pads) {
      add_spring(K, u_s, ballast_top_dof(j), pads->stiffness);
      add_spring(C, u_s, ballast_top_dof(j), pads->damping);
    }
    if (here.gap == 0) {
      add_spring(K, ballast_top_dof(j), below_ballast_dof(j), here.ballast * data_.ballast_stiffness);
      add_spring(C, ballast_top_dof(j), below_ballast_dof(j), here.ballast * data_.ballast_damping);
    }
    const double ballast_next = j < bays ? std::min(here.ballast, support(j + 1).ballast) : 0;
    const double ground_next = j < bays ? std::min(here.foundation, support(j + 1).foundation) : 0;
    if (const auto& ballast = data_.ballast_mass) {
      M.emplace_back(ballast_dof(j), ballast_dof(j), ballast->mass);
      add_spring(K, ballast_dof(j), u_f, here.foundation * ballast->base_stiffness);
      add_spring(C, ballast_dof(j), u_f, here.foundation * ballast->base_damping);
      if (j < bays && (ballast->shear_stiffness > 0 || ballast->shear_damping > 0)) {
        add_spring(K, ballast_dof(j), ballast_dof(j + 1), ballast_next * ballast->shear_stiffness);
        add_spring(C, ballast_dof(j), ballast_dof(j + 1), ballast_next * ballast->shear_damping);
      }
    }
    if (rigid_) continue;
    M.emplace_back(u_f, u_f, ground.m_f);
    add_spring(K, u_f, -1, here.foundation * ground.k_f);
    add_spring(C, u_f, -1, here.foundation * ground.d_f);
    if (j == bays || !std::holds_alternative<Clm>(data_.foundation)) continue;
    add_spring(K, u_f, foundation_dof(j + 1), ground_next * ground.k_c);
    add_spring(C, u_f, foundation_dof(j + 1), ground_next * ground.d_c);
  }
  for (auto [matrix, triplets] : {std::pair{&M_, &M}, std::pair{&C_inner_, &C}, std::pair{&K_, &K}}) {
    matrix->resize(n, n);
    matrix->setFromTriplets(triplets->begin(), triplets->end());
  }
  C_ = C_inner_ + compute_end_damping(bays);
  for (const auto* matrix : {&M_, &C_, &K_})
    half_bandwidth_ = std::max(half_bandwidth_, compute_half_bandwidth(*matrix));
}

void TrackModel::read_variation() {
  supports_.assign(static_cast<std::size_t>(sleepers()), SupportVariation());
  if (!data_.variation) return;
  for (int j = 0; j < sleepers(); ++j) {
    const SupportVariation s = data_.variation(j, sleeper_x(j));
    const std::string support = fmt::format("{}, sleeper {} at {:g} m", data_.label(), j, sleeper_x(j));
    require_positive(support, "pad factor", s.pad, "");
    require_not_negative(support, "ballast factor", s.ballast, "");
    require_positive(support, "foundation factor", s.foundation, "");
    if (rigid_ && !data_.ballast_mass)
      require(s.foundation == 1, support, "foundation factor", s.foundation, "", "1 on rigid ground");
    require_not_negative(support, "gap", s.gap, "m");
    supports_[static_cast<std::size_t>(j)] = s;
    if (s.gap > 0) hanging_.push_back(j);
    const SupportVariation& first = supports_.front();
    is_uniform_ = is_uniform_ && s.gap == 0 && s.pad == first.pad && s.ballast == first.ballast &&
                  s.foundation == first.foundation;
  }
}

Eigen::SparseMatrix<double> TrackModel::compute_end_damping(int bays) const {
  const int absorbing = data_.ends.bays;
  require(bays >= 2 * absorbing, data_.label(), "bays", bays, "",
          fmt::format(">= {}, two absorbing ends", 2 * absorbing));
  const auto damping = [this](const BeamElement& element) -> Eigen::Matrix4d {
    return data_.ends.alpha * element.compute_mass() + data_.ends.beta * element.compute_stiffness();
  };
  Triplets C;
  // all elements are alike, only their damping varies near the ends
  const Eigen::Matrix4d C_rail = damping(element_);
  const int per_bay = data_.elements_per_bay;
  for (int e = 0; e < bays * per_bay; ++e) {
    const double t3 = absorption((e + 0.5) / per_bay, bays, absorbing);
    if (t3 == 0) continue;
    const auto dof = [&](int node) {
      return node / per_bay * dofs_per_bay_ + support_dofs_ + 2 * (node % per_bay);
    };
    add_element(C, dof(e), dof(e + 1), t3, C_rail);
  }
  if (data_.slab) {
    const Eigen::Matrix4d C_slab = damping(slab_element(data_));
    for (int j = 0; j < bays; ++j) {
      const double t3 = absorption(j + 0.5, bays, absorbing);
      const int u = j * dofs_per_bay_ + support_dofs_ - 2;
      if (t3 > 0) add_element(C, u, u + dofs_per_bay_, t3, C_slab);
    }
  }
  Eigen::SparseMatrix<double> matrix(dofs_of(bays), dofs_of(bays));
  matrix.setFromTriplets(C.begin(), C.end());
  return matrix;
}

int TrackModel::rail_dof(int node) const {
  assert(0 <= node && node < nodes());
  const int bay = node / data_.elements_per_bay;
  return first_dof(bay) + support_dofs_ + 2 * (node - bay * data_.elements_per_bay);
}

int TrackModel::sleeper_dof(int j) const {
  assert(0 <= j && j < sleepers());
  return first_dof(j) + support_dofs_ - (data_.slab ? 2 : 1);
}

int TrackModel::foundation_dof(int j) const {
  assert(0 <= j && j < sleepers());
  return rigid_ ? -1 : first_dof(j);
}

int TrackModel::ballast_dof(int j) const {
  return data_.ballast_mass ? first_dof(j) + (rigid_ ? 0 : 1) : -1;
}

int TrackModel::ballast_top_dof(int j) const {
  return sleeper_dof(j) - (data_.under_sleeper_pads ? 1 : 0);
}

int TrackModel::slab_slope_dof(int j) const {
  return data_.slab ? sleeper_dof(j) + 1 : -1;
}

RailPoint TrackModel::rail_point(double x) const {
  if (!(begin() <= x && x <= end()))
    require(false, data_.label(), "x on the rail", x, "m",
            fmt::format("between {:g} and {:g}", begin(), end()));
  const double elements = (x - begin_) / element_.length();
  const int node = std::min(static_cast<int>(elements), nodes() - 2);
  const int first = rail_dof(node), second = rail_dof(node + 1);
  return {{first, first + 1, second, second + 1}, element_.shape(elements - node)};
}

Eigen::VectorXd TrackModel::rail_load(double x, double force) const {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(size());
  const RailPoint point = rail_point(x);
  for (int i = 0; i < 4; ++i) f[point.dof[i]] = force * point.shape.N[i];
  return f;
}

double TrackModel::ballast_force(int j, double compression, double rate) const {
  const SupportVariation& here = support(j);
  if (const auto& ballast = data_.ballast_mass)
    return here.foundation * (ballast->base_stiffness * compression + ballast->base_damping * rate);
  if (here.gap > 0) return unilateral_ballast(j).force(compression, rate);
  return here.ballast * (data_.ballast_stiffness * compression + data_.ballast_damping * rate);
}

Eigen::VectorXd TrackModel::ballast_reactions(const Eigen::Ref<const Eigen::VectorXd>& q,
                                              const Eigen::Ref<const Eigen::VectorXd>& qd) const {
  Eigen::VectorXd reactions(sleepers());
  for (int j = 0; j < sleepers(); ++j) reactions[j] = ballast_reaction(j, q, qd);
  return reactions;
}

UnilateralBallast TrackModel::unilateral_ballast(int j) const {
  const SupportVariation& here = support(j);
  return {here.ballast * data_.ballast_stiffness, here.ballast * data_.ballast_damping, here.gap};
}

PortShape TrackModel::ballast_shape(int j) const {
  PortShape shape;
  shape.add(ballast_top_dof(j), 1);
  if (below_ballast_dof(j) >= 0) shape.add(below_ballast_dof(j), -1);
  return shape;
}

std::vector<Parameter> parameters(const TrackModel& track) {
  const TrackData& data = track.data();
  std::vector<Parameter> table = parameters(data);
  if (!data.variation) return table;
  const auto add_range = [&](const std::string& name, double SupportVariation::*factor) {
    double least = track.support(0).*factor, most = least;
    for (int j = 1; j < track.sleepers(); ++j) {
      least = std::min(least, track.support(j).*factor);
      most = std::max(most, track.support(j).*factor);
    }
    if (least == 1 && most == 1) return;
    table.push_back({data.label(), "smallest factor on the " + name, least, "1", data.variation_source});
    table.push_back({data.label(), "largest factor on the " + name, most, "1", data.variation_source});
  };
  add_range("pads", &SupportVariation::pad);
  add_range("ballast", &SupportVariation::ballast);
  add_range("foundation", &SupportVariation::foundation);
  for (const int j : track.hanging_sleepers())
    table.push_back({data.label(), fmt::format("gap below the sleeper at {:g} m", track.sleeper_x(j)),
                     track.support(j).gap, "m", data.variation_source});
  return table;
}

}  // namespace easydyn::track
