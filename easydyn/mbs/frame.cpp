#include "easydyn/mbs/frame.hpp"

#include "easydyn/error.hpp"
#include "easydyn/mbs/motion_tree.hpp"

namespace easydyn {

using Eigen::Vector3d;
using spatial::Vector;

namespace {
MotionTree& current_tree() {
  MotionTree* tree = MotionTree::current();
  if (!tree) throw ModelError("a moving frame can only be made inside System::positions()");
  return *tree;
}
}  // namespace

Frame Frame::followed_by(const Motion& motion) const {
  if (tree_ && MotionTree::current() && tree_ != MotionTree::current())
    throw ModelError("a motion follows a frame of another system: frames join within one system only");
  const Vector x(&R_(0, 0)), y(&R_(0, 1)), z(&R_(0, 2));
  Frame result(*this);
  const auto turn_about = [&](const Vector& axis_0) {
    const Expr& angle = motion.e_[0];
    if (angle.is_constant()) return;
    result.tree_ = &current_tree();
    result.motion_ = result.tree_->add_rotation(motion_, axis_0, Vector(p_), angle);
  };
  const double angle = motion.e_[0].value();
  double c = 1, s = 0;
  if (motion.kind_ <= Motion::Kind::rotation_z) {
    c = std::cos(angle);
    s = std::sin(angle);
  }
  switch (motion.kind_) {
    // About one of the axes: it stays, the two others turn in their plane.
    case Motion::Kind::rotation_x:
      turn_about(x);
      Vector::write_columns(x, c * y + s * z, c * z - s * y, result.R_);
      break;
    case Motion::Kind::rotation_y:
      turn_about(y);
      Vector::write_columns(c * x - s * z, y, c * z + s * x, result.R_);
      break;
    case Motion::Kind::rotation_z:
      turn_about(z);
      Vector::write_columns(c * x + s * y, c * y - s * x, z, result.R_);
      break;
    case Motion::Kind::rotation:
      turn_about(motion.vector_[0] * x + motion.vector_[1] * y + motion.vector_[2] * z);
      result.R_.noalias() = R_ * Eigen::AngleAxisd(angle, motion.vector_).toRotationMatrix();
      break;
    case Motion::Kind::offset:
      result.p_ = Vector(p_) + motion.vector_[0] * x + motion.vector_[1] * y + motion.vector_[2] * z;
      break;
    case Motion::Kind::translation: {
      const Vector columns[3] = {x, y, z};
      Vector p(p_);
      for (int i = 0; i < 3; ++i) {
        const Expr& displacement = motion.e_[i];
        p += displacement.value() * columns[i];
        if (displacement.is_constant()) continue;
        result.tree_ = &current_tree();
        result.motion_ = result.tree_->add_translation(result.motion_, columns[i], displacement);
      }
      result.p_ = p;
    }
  }
  return result;
}

ExprVector Frame::express_point(const Vector3d& p_FP) const {
  const Vector3d p = point(p_FP);
  return tree_ ? tree_->express_point(motion_, p) : ExprVector(p);
}

ExprVector Frame::express_direction(const Vector3d& d_F) const {
  const Vector3d d = direction(d_F);
  return tree_ ? tree_->express_direction(motion_, d) : ExprVector(d);
}

Vector3d Frame::angular_velocity() const {
  return tree_ ? tree_->angular_velocity(motion_) : Vector3d(Vector3d::Zero());
}

Vector3d Frame::velocity_at(const Vector3d& p_0P) const {
  return tree_ ? tree_->velocity_at(motion_, p_0P) : Vector3d(Vector3d::Zero());
}

void Frame::add_force(const Vector3d& F_0, const Vector3d& p_0P) const {
  if (tree_) tree_->add_wrench(motion_, F_0, p_0P);
}

void Frame::add_moment(const Vector3d& M_0) const {
  if (tree_) tree_->add_moment(motion_, M_0);
}

}  // namespace easydyn
