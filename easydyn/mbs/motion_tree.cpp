#include "easydyn/mbs/motion_tree.hpp"

#include <algorithm>

#include "easydyn/error.hpp"

namespace easydyn {

using Eigen::Vector3d;
using spatial::Twist;
using spatial::Wrench;

namespace {
thread_local MotionTree* current_tree = nullptr;
}

MotionTree* MotionTree::current() {
  return current_tree;
}
MotionTree::Scope::Scope(MotionTree& tree) : previous_(current_tree) {
  current_tree = &tree;
}
MotionTree::Scope::~Scope() {
  current_tree = previous_;
}

void MotionTree::clear(double t) {
  t_ = t;
  size_ = 0;
  bodies_.clear();
  deformable_.clear();
  energy_ = {};
  velocities_known_ = false;
}

int MotionTree::add_rotation(int parent, const Vector3d& axis_0, const Vector3d& p_0, const Expr& angle) {
  if (size_ == static_cast<int>(joints_.size())) joints_.emplace_back();
  Joint& k = joints_[static_cast<std::size_t>(size_)];
  k.parent = parent;
  k.is_rotation = true;
  k.axis = axis_0;
  k.point = p_0;
  k.rate = angle.rate();
  k.bias = angle.bias();
  k.gradient = angle.gradient();
  return size_++;
}

int MotionTree::add_translation(int parent, const Vector3d& axis_0, const Expr& displacement) {
  const int k = add_rotation(parent, axis_0, Vector3d::Zero(), displacement);
  joints_[static_cast<std::size_t>(k)].is_rotation = false;
  return k;
}

void MotionTree::add_body(const Inertia& inertia, const Eigen::Matrix3d& R, const Vector3d& p, int motion) {
  bodies_.push_back({inertia, R, p, motion});
}

Twist MotionTree::screw_about(const Joint& k, const Vector3d& P) {
  if (!k.is_rotation) return {Vector3d::Zero(), k.axis};
  return {k.axis, k.axis.cross(P - k.point)};
}

void MotionTree::follow(int motion, const Vector3d& P, std::vector<int>& path, Twist& V, Twist& A) const {
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
  follow(motion, p_0P, path, V, A);
  const Vector3d acceleration = A.v + V.w.cross(V.v);  // of the material point
  Gradient gradient[3];
  for (const int i : path) {
    const Joint& k = joints_[static_cast<std::size_t>(i)];
    const Twist S = screw_about(k, p_0P);
    for (int c = 0; c < 3; ++c)
      if (S.v[c] != 0) gradient[c] = Gradient::combine(1, gradient[c], S.v[c], k.gradient);
  }
  ExprVector result;
  for (int c = 0; c < 3; ++c)
    result[c] = Expr::of_parts(p_0P[c], V.v[c], acceleration[c], std::move(gradient[c]));
  return result;
}

ExprVector MotionTree::express_direction(int motion, const Vector3d& d) const {
  thread_local std::vector<int> path;
  Twist V, A;
  follow(motion, Vector3d::Zero(), path, V, A);
  const Vector3d rate = V.w.cross(d), bias = A.w.cross(d) + V.w.cross(rate);
  Gradient gradient[3];
  for (const int i : path) {
    const Joint& k = joints_[static_cast<std::size_t>(i)];
    if (!k.is_rotation) continue;
    const Vector3d turn = k.axis.cross(d);
    for (int c = 0; c < 3; ++c)
      if (turn[c] != 0) gradient[c] = Gradient::combine(1, gradient[c], turn[c], k.gradient);
  }
  ExprVector result;
  for (int c = 0; c < 3; ++c) result[c] = Expr::of_parts(d[c], rate[c], bias[c], std::move(gradient[c]));
  return result;
}

void MotionTree::compute_velocities() {
  // The common point: the first body that moves. It depends on the state alone.
  O_.setZero();
  for (const Carried& b : bodies_) {
    if (b.motion < 0) continue;
    O_ = b.p;
    break;
  }
  if (O_.isZero() && !deformable_.empty()) O_ = deformable_.front()->origin();

  for (int i = 0; i < size_; ++i) {
    Joint& k = joints_[static_cast<std::size_t>(i)];
    k.S = screw_about(k, O_);
    k.V = k.parent >= 0 ? joints_[static_cast<std::size_t>(k.parent)].V : Twist{};
    k.V += k.rate * k.S;
    k.A_bias = k.bias * k.S;
    k.A_bias += k.rate * spatial::cross(k.V, k.S);
    k.applied = {};
  }

  body_inertia_.clear();
  for (const Carried& b : bodies_)
    body_inertia_.push_back(
        spatial::Inertia::of_body(b.inertia.mass, b.p - O_, b.R * b.inertia.J * b.R.transpose()));
  velocities_known_ = true;
}

void MotionTree::compute_accelerations(const double* qdd) {
  qdd_ = qdd;
  for (int i = 0; i < size_; ++i) {
    Joint& k = joints_[static_cast<std::size_t>(i)];
    k.A = k.parent >= 0 ? joints_[static_cast<std::size_t>(k.parent)].A : Twist{};
    k.A += k.A_bias;
    if (qdd) k.A += k.gradient.dot(qdd) * k.S;
  }
}

void MotionTree::add_residual(const double* qd, double* r, double* drive_power) {
  for (int i = 0; i < size_; ++i) {
    Joint& k = joints_[static_cast<std::size_t>(i)];
    k.f = {};
    k.f -= k.applied;
  }

  // Each body brings its inertia forces ...
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (bodies_[b].motion < 0) continue;
    Joint& k = joints_[static_cast<std::size_t>(bodies_[b].motion)];
    const spatial::Inertia& I = body_inertia_[b];
    k.f += I * k.A;
    k.f += spatial::cross(k.V, I * k.V);
  }

  if (!deformable_.empty()) add_deformable_forces(qd, r, drive_power);

  // ... which are handed down to the ground and projected on the way.
  double power = drive_power ? *drive_power : 0;
  for (int i = size_ - 1; i >= 0; --i) {
    Joint& k = joints_[static_cast<std::size_t>(i)];
    const double tau = spatial::dot(k.S, k.f);
    for (const Gradient::Entry& g : k.gradient) r[g.coordinate] += g.value * tau;
    power += tau * (k.rate - k.gradient.dot(qd));
    if (k.parent >= 0) joints_[static_cast<std::size_t>(k.parent)].f += k.f;
  }
  if (drive_power) *drive_power = power;
}

void MotionTree::add_mass_matrix(Eigen::Ref<Eigen::MatrixXd> M) {
  for (int i = 0; i < size_; ++i) joints_[static_cast<std::size_t>(i)].composite = {};
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    if (bodies_[b].motion >= 0)
      joints_[static_cast<std::size_t>(bodies_[b].motion)].composite += body_inertia_[b];

  for (int i = size_ - 1; i >= 0; --i) {
    const Joint& k = joints_[static_cast<std::size_t>(i)];
    const Wrench momentum = k.composite * k.S;
    for (int j = i; j >= 0; j = joints_[static_cast<std::size_t>(j)].parent) {
      const Joint& a = joints_[static_cast<std::size_t>(j)];
      const double H = spatial::dot(a.S, momentum);
      for (const Gradient::Entry& gk : k.gradient)
        for (const Gradient::Entry& ga : a.gradient) {
          const double m = gk.value * ga.value * H;
          M(gk.coordinate, ga.coordinate) += m;
          if (j != i) M(ga.coordinate, gk.coordinate) += m;
        }
    }
    if (k.parent >= 0) joints_[static_cast<std::size_t>(k.parent)].composite += k.composite;
  }
  if (!deformable_.empty()) add_deformable_mass(M);
}

DeformableInertia::FrameMotion MotionTree::frame_motion_of(const DeformableInertia& d) const {
  const int k = d.motion();
  if (k < 0) return {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  const Joint& joint = joints_[static_cast<std::size_t>(k)];
  return {joint.V.w, velocity_at(k, d.origin()), joint.A.w, acceleration_at(k, d.origin())};
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
      joints_[static_cast<std::size_t>(d->motion())].f +=
          {f.moment + (d->origin() - O_).cross(f.force), f.force};
    for (Eigen::Index j = 0; j < m; ++j) {
      const Expr& e = coordinates[static_cast<std::size_t>(j)];
      for (const Gradient::Entry& g : e.gradient()) r[g.coordinate] += g.value * shape_forces_[j];
      if (drive_power) *drive_power += shape_forces_[j] * (e.rate() - e.gradient().dot(qd));
    }
  }
}

// Partial velocities of F along the path to the ground, and the shape coordinates, are the columns of a Jacobian.
void MotionTree::add_deformable_mass(Eigen::Ref<Eigen::MatrixXd> M) {
  struct Column {
    const Gradient* gradient;
    Eigen::VectorXd value;
  };
  for (DeformableInertia* const d : deformable_) {
    const Eigen::MatrixXd& mass = d->compute_mass_matrix();
    std::vector<Column> columns;
    for (int k = d->motion(); k >= 0; k = joints_[static_cast<std::size_t>(k)].parent) {
      const Joint& joint = joints_[static_cast<std::size_t>(k)];
      Column c{&joint.gradient, Eigen::VectorXd::Zero(mass.rows())};
      c.value.head<3>() = joint.S.w;
      c.value.segment<3>(3) = joint.S.v + joint.S.w.cross(d->origin() - O_);
      columns.push_back(std::move(c));
    }
    const auto coordinates = d->shape_coordinates();
    for (std::size_t j = 0; j < coordinates.size(); ++j)
      columns.push_back(
          {&coordinates[j].gradient(), Eigen::VectorXd::Unit(mass.rows(), 6 + static_cast<Eigen::Index>(j))});
    for (const Column& a : columns) {
      const Eigen::VectorXd momentum = mass * a.value;
      for (const Column& b : columns) {
        const double H = b.value.dot(momentum);
        for (const Gradient::Entry& ga : *a.gradient)
          for (const Gradient::Entry& gb : *b.gradient)
            M(ga.coordinate, gb.coordinate) += ga.value * gb.value * H;
      }
    }
  }
}

double MotionTree::kinetic_energy() const {
  double T = 0;
  for (DeformableInertia* const d : deformable_) T += d->kinetic_energy(frame_motion_of(*d));
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (bodies_[b].motion < 0) continue;
    const Twist& V = joints_[static_cast<std::size_t>(bodies_[b].motion)].V;
    T += 0.5 * spatial::dot(V, body_inertia_[b] * V);
  }
  return T;
}

void MotionTree::check_velocities() const {
  if (!velocities_known_)
    throw ModelError("velocities and forces of a frame are known in forces(), not yet in positions()");
}

Vector3d MotionTree::angular_velocity(int motion) const {
  check_velocities();
  return joints_[static_cast<std::size_t>(motion)].V.w;
}

Vector3d MotionTree::velocity_at(int motion, const Vector3d& p) const {
  check_velocities();
  const Twist& V = joints_[static_cast<std::size_t>(motion)].V;
  return V.v + V.w.cross(p - O_);
}

Vector3d MotionTree::acceleration_at(int motion, const Vector3d& p) const {
  const Joint& k = joints_[static_cast<std::size_t>(motion)];
  const Vector3d d = p - O_;
  // The spatial acceleration is that of the field at a fixed point: add w x v for the material point.
  return k.A.v + k.A.w.cross(d) + k.V.w.cross(k.V.v + k.V.w.cross(d));
}

void MotionTree::add_wrench(int motion, const Vector3d& force, const Vector3d& p) {
  check_velocities();
  joints_[static_cast<std::size_t>(motion)].applied += {(p - O_).cross(force), force};
}

void MotionTree::add_moment(int motion, const Vector3d& moment) {
  check_velocities();
  joints_[static_cast<std::size_t>(motion)].applied += {moment, Vector3d::Zero()};
}

}  // namespace easydyn
