#include "easydyn/mbs/motion_tree.hpp"

#include <algorithm>

#include "easydyn/error.hpp"

namespace easydyn {

using Eigen::Vector3d;
using spatial::Twist;
using spatial::Vector;
using spatial::Wrench;

constinit thread_local MotionTree* MotionTree::current_ = nullptr;

MotionTree::Scope::Scope(MotionTree& tree) : previous_(current_) {
  current_ = &tree;
}
MotionTree::Scope::~Scope() {
  current_ = previous_;
}

void MotionTree::clear(double t) {
  t_ = t;
  size_ = 0;
  entries_.clear();
  bodies_.clear();
  deformable_.clear();
  gravity_ = mass_moment_ = {};
  energy_ = {};
  velocities_known_ = forces_open_ = accelerations_known_ = false;
  trials_ = 0;
}

void MotionTree::shrink_to(int size) {
  if (size < size_) entries_.resize(joints_[static_cast<std::size_t>(size)].first_entry);
  size_ = size;
}

int MotionTree::add_joint(int parent, bool is_rotation, const Vector& axis_0, const Vector& p_0,
                          const Expr& e) {
  if (size_ == static_cast<int>(joints_.size())) joints_.emplace_back();
  Joint& k = joints_[static_cast<std::size_t>(size_)];
  k.parent = parent;
  k.is_rotation = is_rotation;
  k.axis = axis_0;
  k.point = p_0;
  k.rate = e.rate();
  k.bias = e.bias();
  k.first_entry = static_cast<std::uint32_t>(entries_.size());
  for (const Gradient::Entry& g : e.gradient()) entries_.push_back(g);
  k.last_entry = static_cast<std::uint32_t>(entries_.size());

  k.coordinate = e.gradient().size() == 1 ? e.gradient().begin()->coordinate : -1;
  k.run = size_;
  if (k.coordinate > 0 && parent >= 0 && parent == size_ - 1) {
    const Joint& before = joints_[static_cast<std::size_t>(parent)];
    if (before.coordinate == k.coordinate - 1) k.run = before.run;
  }
  return size_++;
}

int MotionTree::add_rotation(int parent, const Vector& axis_0, const Vector& p_0, const Expr& angle) {
  return add_joint(parent, true, axis_0, p_0, angle);
}

int MotionTree::add_translation(int parent, const Vector& axis_0, const Expr& displacement) {
  return add_joint(parent, false, axis_0, Vector(), displacement);
}

void MotionTree::add_body(const Inertia& inertia, const Eigen::Matrix3d& R, const Vector3d& p, int motion) {
  bodies_.push_back({inertia.mass, spatial::Symmetric::rotated(R, inertia.J), Vector(p), motion});
  mass_moment_ += inertia.mass * Vector(p);
}

void MotionTree::follow(int motion, const Vector& P, std::vector<int>& path, Twist& V, Twist& A) const {
  path.clear();
  for (int k = motion; k >= 0; k = joints_[static_cast<std::size_t>(k)].parent) path.push_back(k);
  std::reverse(path.begin(), path.end());
  for (const int i : path) {
    const Joint& k = joints_[static_cast<std::size_t>(i)];
    const Twist S = screw_about(k, P);
    V += k.rate * S;
    A += k.bias * S;
    A += k.rate * spatial::cross(V, S);
  }
}

ExprVector MotionTree::express_point(int motion, const Vector3d& p_0P) const {
  thread_local std::vector<int> path;
  Twist V, A;
  const Vector P(p_0P);
  follow(motion, P, path, V, A);
  const Vector acceleration = A.v + cross(V.w, V.v);  // of the material point
  Gradient gradient[3];
  for (const int i : path) {
    const Joint& k = joints_[static_cast<std::size_t>(i)];
    const Twist S = screw_about(k, P);
    for (int c = 0; c < 3; ++c)
      if (S.v[c] != 0) gradient[c] = Gradient::combine(1, gradient[c], S.v[c], entries(k));
  }
  ExprVector result;
  for (int c = 0; c < 3; ++c)
    result[c] = Expr::of_parts(p_0P[c], V.v[c], acceleration[c], std::move(gradient[c]));
  return result;
}

ExprVector MotionTree::express_direction(int motion, const Vector3d& d) const {
  thread_local std::vector<int> path;
  Twist V, A;
  follow(motion, Vector(), path, V, A);
  const Vector direction(d), rate = cross(V.w, direction), bias = cross(A.w, direction) + cross(V.w, rate);
  Gradient gradient[3];
  for (const int i : path) {
    const Joint& k = joints_[static_cast<std::size_t>(i)];
    if (!k.is_rotation) continue;
    const Vector turn = cross(k.axis, direction);
    for (int c = 0; c < 3; ++c)
      if (turn[c] != 0) gradient[c] = Gradient::combine(1, gradient[c], turn[c], entries(k));
  }
  ExprVector result;
  for (int c = 0; c < 3; ++c) result[c] = Expr::of_parts(d[c], rate[c], bias[c], std::move(gradient[c]));
  return result;
}

void MotionTree::compute_velocities() {
  // The common point: the first body that moves. It depends on the state alone.
  O_ = deformable_.empty() ? Vector() : Vector(deformable_.front()->origin());
  for (const Carried& b : bodies_) {
    if (b.motion < 0) continue;
    O_ = b.p;
    break;
  }

  if (moving_.size() < joints_.size()) moving_.resize(joints_.size());
  for (int i = 0; i < size_; ++i) {
    const Joint& joint = joints_[static_cast<std::size_t>(i)];
    Moving& k = moving_[static_cast<std::size_t>(i)];
    k.S = screw_about(joint, O_);
    k.V = joint.rate * k.S;
    if (joint.parent >= 0) k.V += moving_[static_cast<std::size_t>(joint.parent)].V;
    k.f = {};
  }
  velocities_known_ = forces_open_ = true;
}

void MotionTree::compute_accelerations(const double* qdd) {
  accelerations_known_ = true;
  qdd_ = qdd;
  for (int i = 0; i < size_; ++i) {
    const Joint& joint = joints_[static_cast<std::size_t>(i)];
    Moving& k = moving_[static_cast<std::size_t>(i)];
    double acceleration = joint.bias;
    if (qdd)
      for (const Gradient::Entry& g : entries(joint)) acceleration += g.value * qdd[g.coordinate];
    k.A = acceleration * k.S;
    k.A += joint.rate * spatial::cross(k.V, k.S);
    if (joint.parent >= 0) k.A += moving_[static_cast<std::size_t>(joint.parent)].A;
  }
}

void MotionTree::add_residual(const double* qd, double* r, double* drive_power) {
  // Each body brings its inertia forces and its weight ...
  for (const Carried& b : bodies_) {
    if (b.motion < 0) continue;
    Moving& k = moving_[static_cast<std::size_t>(b.motion)];
    const Vector force = b.mass * (acceleration_of(b.motion, b.p) - gravity_);
    k.f += {b.J * k.A.w + cross(k.V.w, b.J * k.V.w) + cross(b.p - O_, force), force};
  }

  if (!deformable_.empty()) add_deformable_forces(qd, r, drive_power);

  // ... which are handed down to the ground and projected on the way.
  double power = drive_power ? *drive_power : 0;
  for (int i = size_ - 1; i >= 0; --i) {
    const Joint& joint = joints_[static_cast<std::size_t>(i)];
    const Moving& k = moving_[static_cast<std::size_t>(i)];
    const double tau = spatial::dot(k.S, k.f);
    double imposed_rate = joint.rate;
    for (const Gradient::Entry& g : entries(joint)) {
      r[g.coordinate] += g.value * tau;
      imposed_rate -= g.value * qd[g.coordinate];
    }
    power += tau * imposed_rate;
    if (joint.parent >= 0) moving_[static_cast<std::size_t>(joint.parent)].f += k.f;
  }
  if (drive_power) *drive_power = power;
}

// Ic_k of all motions.
void MotionTree::collect_composites() {
  for (int i = 0; i < size_; ++i) moving_[static_cast<std::size_t>(i)].composite = {};
  for (const Carried& b : bodies_)
    if (b.motion >= 0)
      moving_[static_cast<std::size_t>(b.motion)].composite +=
          spatial::Inertia::of_body(b.mass, b.p - O_, b.J);
  for (int i = size_ - 1; i >= 0; --i) {
    const int parent = joints_[static_cast<std::size_t>(i)].parent;
    if (parent >= 0)
      moving_[static_cast<std::size_t>(parent)].composite += moving_[static_cast<std::size_t>(i)].composite;
  }
}

// H_j = S_j . momentum for motion k and its ancestors, run by run. The lanes may go beyond a run: what they find there
// is the same product for other motions.
void MotionTree::project_momentum(int k, const Wrench& momentum) {
  using Lanes = Eigen::Array<double, lanes, 1>;
  const auto part = [&](int c, int j) { return Lanes::Map(screws_.c[c].data() + j); };
  for (int last = k; last >= 0;) {
    const int first = joints_[static_cast<std::size_t>(last)].run;
    for (int j = first; j <= last; j += lanes)
      Lanes::Map(H_.data() + j) = (part(0, j) * momentum.moment[0] + part(1, j) * momentum.moment[1]) +
                                  (part(2, j) * momentum.moment[2] + part(3, j) * momentum.force[0]) +
                                  (part(4, j) * momentum.force[1] + part(5, j) * momentum.force[2]);
    last = joints_[static_cast<std::size_t>(first)].parent;
  }
}

void MotionTree::compute_mass_matrix(Eigen::Ref<Eigen::MatrixXd> M) {
  collect_composites();
  const std::size_t padded = joints_.size() + lanes;
  if (H_.size() < padded) {
    H_.resize(padded);
    for (std::vector<double>& c : screws_.c) c.resize(padded);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(size_); ++i) {
    const Joint& joint = joints_[i];
    const Twist S = (joint.coordinate >= 0 ? entries_[joint.first_entry].value : 1.0) * moving_[i].S;
    for (std::size_t c = 0; c < 3; ++c) {
      screws_.c[c][i] = S.w[static_cast<int>(c)];
      screws_.c[c + 3][i] = S.v[static_cast<int>(c)];
    }
  }

  // W = sum_k sum_j g_j g_k^T H_j, half of it for j = k: column by column, the rows of a run at once.
  M.setZero();
  const auto add_column = [&](int coordinate, double weight, int k) {
    double* const column = M.col(coordinate).data();
    for (int last = k; last >= 0;) {
      const Joint& joint = joints_[static_cast<std::size_t>(last)];
      const double* const H = H_.data() + joint.run;
      if (joint.coordinate >= 0) {
        double* const rows = column + joints_[static_cast<std::size_t>(joint.run)].coordinate;
        for (int j = 0; j <= last - joint.run; ++j) rows[j] += weight * H[j];
      } else {
        for (const Gradient::Entry& g : entries(joint)) column[g.coordinate] += weight * g.value * *H;
      }
      last = joints_[static_cast<std::size_t>(joint.run)].parent;
    }
  };
  for (int k = size_ - 1; k >= 0; --k) {
    const Joint& joint = joints_[static_cast<std::size_t>(k)];
    const Moving& moving = moving_[static_cast<std::size_t>(k)];
    const bool is_single = joint.coordinate >= 0;
    const Gradient::Entries gradient = entries(joint);
    if (gradient.empty()) continue;
    project_momentum(k, moving.composite * ((is_single ? gradient[0].value : 1.0) * moving.S));
    H_[static_cast<std::size_t>(k)] *= 0.5;  // its own pair comes twice in W + W^T
    if (is_single)
      add_column(joint.coordinate, 1, k);
    else
      for (const Gradient::Entry& g : gradient) add_column(g.coordinate, g.value, k);
  }

  // M = W + W^T.
  for (Eigen::Index j = 0; j < M.cols(); ++j) {
    M(j, j) *= 2;
    for (Eigen::Index i = 0; i < j; ++i) M(i, j) = M(j, i) = M(i, j) + M(j, i);
  }
  if (!deformable_.empty()) add_deformable_mass(M);
}

DeformableInertia::FrameMotion MotionTree::frame_motion_of(const DeformableInertia& d) const {
  const int k = d.motion();
  if (k < 0) return {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  const Moving& m = moving_[static_cast<std::size_t>(k)];
  return {m.V.w, velocity_at(k, d.origin()), m.A.w, acceleration_at(k, d.origin())};
}

void MotionTree::add_deformable_forces(const double* qd, double* r, double* drive_power) {
  for (DeformableInertia* const d : deformable_) {
    const auto coordinates = d->shape_coordinates();
    const auto m = static_cast<Eigen::Index>(coordinates.size());
    shape_accelerations_.resize(m);
    shape_forces_.resize(m);
    for (Eigen::Index j = 0; j < m; ++j) {
      const Expr& e = coordinates[static_cast<std::size_t>(j)];
      shape_accelerations_[j] = e.bias() + (qdd_ ? e.gradient().dot(qdd_) : 0.0);
    }
    const Wrench f = d->compute_inertia_force(frame_motion_of(*d), shape_accelerations_, shape_forces_);
    if (d->motion() >= 0)
      moving_[static_cast<std::size_t>(d->motion())].f +=
          {f.moment + cross(Vector(d->origin()) - O_, f.force), f.force};
    for (Eigen::Index j = 0; j < m; ++j) {
      const Expr& e = coordinates[static_cast<std::size_t>(j)];
      for (const Gradient::Entry& g : e.gradient()) r[g.coordinate] += g.value * shape_forces_[j];
      if (drive_power) *drive_power += shape_forces_[j] * (e.rate() - e.gradient().dot(qd));
    }
  }
}

// M += J^T M_d J: the columns of J are the partial velocities of F along the path to the ground, and the shape
// coordinates.
void MotionTree::add_deformable_mass(Eigen::Ref<Eigen::MatrixXd> M) {
  for (DeformableInertia* const d : deformable_) {
    const Eigen::MatrixXd& mass = d->compute_mass_matrix();
    jacobian_.setZero(mass.rows(), M.cols());
    for (int k = d->motion(); k >= 0; k = joints_[static_cast<std::size_t>(k)].parent) {
      const Twist& S = moving_[static_cast<std::size_t>(k)].S;
      const Vector3d w = S.w, v = S.v + cross(S.w, Vector(d->origin()) - O_);
      for (const Gradient::Entry& g : entries(joints_[static_cast<std::size_t>(k)])) {
        jacobian_.block<3, 1>(0, g.coordinate) += g.value * w;
        jacobian_.block<3, 1>(3, g.coordinate) += g.value * v;
      }
    }
    Eigen::Index row = 6;
    for (const Expr& e : d->shape_coordinates()) {
      for (const Gradient::Entry& g : e.gradient()) jacobian_(row, g.coordinate) += g.value;
      ++row;
    }
    mass_jacobian_.noalias() = mass * jacobian_;
    M.noalias() += jacobian_.transpose() * mass_jacobian_;
  }
}

double MotionTree::kinetic_energy() const {
  double T = 0;
  for (DeformableInertia* const d : deformable_) T += d->kinetic_energy(frame_motion_of(*d));
  for (const Carried& b : bodies_) {
    if (b.motion < 0) continue;
    const Twist& V = moving_[static_cast<std::size_t>(b.motion)].V;
    const Vector v = V.v + cross(V.w, b.p - O_);
    T += 0.5 * (b.mass * dot(v, v) + dot(V.w, b.J * V.w));
  }
  return T;
}

void MotionTree::throw_velocities_unknown() {
  throw ModelError("velocities of a frame are known in forces(), not yet in positions()");
}

void MotionTree::throw_forces_closed() {
  throw ModelError(
      "forces, moments and gravity act inside forces() only: elsewhere they would have no effect");
}

Vector3d MotionTree::angular_velocity(int motion) const {
  check_velocities();
  return moving_[static_cast<std::size_t>(motion)].V.w;
}

Vector3d MotionTree::velocity_at(int motion, const Vector3d& p) const {
  check_velocities();
  const Twist& V = moving_[static_cast<std::size_t>(motion)].V;
  return V.v + cross(V.w, Vector(p) - O_);
}

Vector3d MotionTree::acceleration_at(int motion, const Vector3d& p) const {
  if (!accelerations_known_)
    throw ModelError(
        "accelerations are known after an evaluation, not in forces(): give the output a function instead");
  return acceleration_of(motion, Vector(p));
}

}  // namespace easydyn
