#pragma once

#include <memory>

#include "track/profile.hpp"

/// Local defects of the running surface, each as the path of the centre of a rigid wheel that rolls over it. A
/// step up or down is `StepProfile`. Several of them, and an irregularity, are added by `ProfileSum`.
///
/// Kinds of defects as in Kouroussis et al. 2015 (F); the shapes of gap, switch and crossing are idealisations of ours
/// (D), with representative sizes. Where the wheel passes to another point of contact its path has a kink, at which
/// a rigid wheel takes a velocity at once.
namespace easydyn::track {

/// Joint whose rail ends are bent down (Kabo et al. 2006, F): along each half the surface falls as
///   p = -depth (1 - cos(pi s / length)),   s = 0 .. length / 2 from its end to the joint
/// mirrored behind the joint, which is sharp: p' jumps by 2 pi depth / length. The wheel bridges the joint.
struct DippedJoint {
  double depth = 3e-3;  ///< at the joint [m], >= 0 (F: typical)
  double length = 1;    ///< of both halves together [m] (F: typical)
};
std::shared_ptr<const Profile> dipped_joint(double x0, const DippedJoint& joint = {});

/// Smooth bump (height > 0) or hollow (height < 0): p = height / 2 (1 + cos(2 pi s / length)), |s| < length / 2
/// about x0.
struct Pulse {
  double height = 1e-3;  ///< [m]
  double length = 0.1;   ///< [m]
};
std::shared_ptr<const Profile> pulse(double x0, const Pulse& pulse = {});

/// Gap between two rails from x0 to x0 + width, the second one higher by height_difference. The wheel dips by about
/// width^2 / (8 R) and its path has one kink, of width / R where the rails are level.
struct RailGap {
  double width = 10e-3;          ///< [m], > 0
  double height_difference = 0;  ///< [m], may be negative
};
std::shared_ptr<const Profile> rail_gap(double x0, const RailGap& gap = {});

/// Switch: the wheel passes from the stock rail to the blade at x0. As the support moves outward on its tread it
/// sinks along `length` before x0 by `depth`, and rises along as much behind; the blade may be lower by
/// `height_difference`.
struct SwitchTransfer {
  double depth = 1e-3;           ///< [m], >= 0
  double length = 1;             ///< of the fall and of the rise [m], > 0
  double height_difference = 0;  ///< stock rail above blade at x0 [m], may be negative
  bool is_trailing = false;      ///< passed from blade to stock rail: the mirror image
};
std::shared_ptr<const Profile> switch_transfer(double x0, const SwitchTransfer& transfer = {});

/// Crossing: the wheel leaves the wing rail, which has let it sink by `wing_depth` along `wing_length`, at x0,
/// crosses a gap without support (0 where wing and nose overlap) and lands on the nose, `nose_depth` below the
/// level of the rail and rising to it along `nose_length`.
struct Crossing {
  double wing_depth = 2e-3;  ///< [m], >= 0
  double wing_length = 0.5;  ///< [m], > 0
  double gap = 0;            ///< [m], >= 0
  double nose_depth = 3e-3;  ///< [m], >= 0
  double nose_length = 0.5;  ///< [m], > 0
  bool is_trailing = false;  ///< passed from the nose to the wing: the mirror image
};
std::shared_ptr<const Profile> crossing(double x0, const Crossing& crossing = {});

}  // namespace easydyn::track
