#include "track/track_model.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "easydyn/require.hpp"

namespace easydyn::track {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

/// Adds factor * element (4 x 4) on the rail unknowns first, first + 1, second, second + 1.
void add_element(Triplets& to, int first, int second, double factor, const Eigen::Matrix4d& element) {
  const std::array<int, 4> dof = {first, first + 1, second, second + 1};
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

}  // namespace

TrackModel::TrackModel(const TrackData& data, int bays, double begin)
    : data_(data), bays_(bays), begin_(begin), rigid_(is_rigid(data.foundation) ? 1 : 0) {
  validate(data_);
  const std::string track = data_.label();
  require(bays >= 1, track, "bays", bays, "", ">= 1");
  require(bays >= 2 * data_.ends.bays, track, "bays", bays, "",
          fmt::format(">= {}, two absorbing ends", 2 * data_.ends.bays));
  require_finite(track, "x of the first sleeper", begin, "m");
  dofs_per_bay_ = 2 * data_.elements_per_bay + 2 - rigid_;

  const int n = bays * dofs_per_bay_ + 4 - rigid_;
  Triplets M, C, K;
  // rail: all elements are alike, only their damping varies near the ends
  const BeamElement element(data_.rails * data_.rail.bending_stiffness(),
                            data_.rails * data_.rail.mass_per_length,
                            data_.sleeper_spacing / data_.elements_per_bay);
  const Eigen::Matrix4d M_e = element.compute_mass(), K_e = element.compute_stiffness();
  const Eigen::Matrix4d C_e = data_.ends.alpha * M_e + data_.ends.beta * K_e;
  for (int node = 0; node + 1 < nodes(); ++node) {
    const int first = rail_dof(node), second = rail_dof(node + 1);
    add_element(M, first, second, 1, M_e);
    add_element(K, first, second, 1, K_e);
    const double t3 = absorption(0.5 * (node_x(node) + node_x(node + 1)));
    if (t3 > 0) add_element(C, first, second, t3, C_e);
  }
  // supports
  const Clm ground = as_clm(data_.foundation);
  for (int j = 0; j < sleepers(); ++j) {
    const int w = rail_dof(j * data_.elements_per_bay), u_s = sleeper_dof(j), u_f = foundation_dof(j);
    M.emplace_back(u_s, u_s, data_.sleeper_mass);
    add_spring(K, u_s, w, data_.pad_stiffness);
    add_spring(C, u_s, w, data_.pad_damping);
    add_spring(K, u_s, u_f, data_.ballast_stiffness);
    add_spring(C, u_s, u_f, data_.ballast_damping);
    if (rigid_) continue;
    M.emplace_back(u_f, u_f, ground.m_f);
    add_spring(K, u_f, -1, ground.k_f);
    add_spring(C, u_f, -1, ground.d_f);
    if (j == bays || !std::holds_alternative<Clm>(data_.foundation)) continue;
    add_spring(K, u_f, foundation_dof(j + 1), ground.k_c);
    add_spring(C, u_f, foundation_dof(j + 1), ground.d_c);
  }
  for (auto [matrix, triplets] : {std::pair{&M_, &M}, std::pair{&C_, &C}, std::pair{&K_, &K}}) {
    matrix->resize(n, n);
    matrix->setFromTriplets(triplets->begin(), triplets->end());
    half_bandwidth_ = std::max(half_bandwidth_, compute_half_bandwidth(*matrix));
  }
}

int TrackModel::rail_dof(int node) const {
  assert(0 <= node && node < nodes());
  const int bay = node / data_.elements_per_bay;
  return bay * dofs_per_bay_ + 2 - rigid_ + 2 * (node - bay * data_.elements_per_bay);
}

int TrackModel::sleeper_dof(int j) const {
  assert(0 <= j && j < sleepers());
  return j * dofs_per_bay_ + 1 - rigid_;
}

int TrackModel::foundation_dof(int j) const {
  assert(0 <= j && j < sleepers());
  return rigid_ ? -1 : j * dofs_per_bay_;
}

RailPoint TrackModel::rail_point(double x) const {
  if (!(begin() <= x && x <= end()))
    require(false, data_.label(), "x on the rail", x, "m",
            fmt::format("between {:g} and {:g}", begin(), end()));
  const double length = data_.sleeper_spacing / data_.elements_per_bay;
  const double elements = (x - begin_) / length;
  const int node = std::min(static_cast<int>(elements), nodes() - 2);
  const int first = rail_dof(node), second = rail_dof(node + 1);
  return {{first, first + 1, second, second + 1}, compute_beam_shape(elements - node, length)};
}

Eigen::VectorXd TrackModel::rail_load(double x, double force) const {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(size());
  const RailPoint point = rail_point(x);
  for (int i = 0; i < 4; ++i) f[point.dof[i]] = force * point.shape.N[i];
  return f;
}

Eigen::VectorXd TrackModel::ballast_reactions(const Eigen::Ref<const Eigen::VectorXd>& q,
                                              const Eigen::Ref<const Eigen::VectorXd>& qd) const {
  Eigen::VectorXd reactions(sleepers());
  for (int j = 0; j < sleepers(); ++j) reactions[j] = ballast_reaction(j, q, qd);
  return reactions;
}

double TrackModel::absorption(double x) const {
  if (data_.ends.bays == 0) return 0;
  const double length = data_.ends.bays * data_.sleeper_spacing;
  const double t = std::max(1 - (x - begin()) / length, 1 - (end() - x) / length);
  return t > 0 ? t * t * t : 0;
}

}  // namespace easydyn::track
