#include "easydyn/mbs/frame.hpp"

#include "easydyn/error.hpp"
#include "easydyn/mbs/motion_tree.hpp"

namespace easydyn {

using Eigen::Vector3d;

namespace {
MotionTree& current_tree() {
  MotionTree* tree = MotionTree::current();
  if (!tree) throw ModelError("a moving frame can only be made inside System::positions()");
  return *tree;
}
}  // namespace

Frame Frame::followed_by(const Motion& motion) const {
  Frame result = *this;
  if (motion.is_rotation_) {
    const Expr& angle = motion.e_[0];
    if (!angle.is_constant()) {
      result.tree_ = &current_tree();
      result.motion_ = result.tree_->add_rotation(motion_, R_ * motion.axis_, p_, angle);
    }
    result.R_ = R_ * Eigen::AngleAxisd(angle.value(), motion.axis_).toRotationMatrix();
  } else {
    result.p_ += R_ * Vector3d(motion.e_[0].value(), motion.e_[1].value(), motion.e_[2].value());
    for (int i = 0; i < 3; ++i) {
      if (motion.e_[i].is_constant()) continue;
      result.tree_ = &current_tree();
      result.motion_ = result.tree_->add_translation(result.motion_, R_.col(i), motion.e_[i]);
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
