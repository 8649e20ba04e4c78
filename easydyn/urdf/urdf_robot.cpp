#include "easydyn/urdf/urdf_robot.hpp"

#include <fmt/format.h>

#include <cmath>

#include "easydyn/error.hpp"
#include "easydyn/mbs/motion_tree.hpp"
#include "easydyn/require.hpp"
#include "easydyn/visu/stl_file.hpp"

namespace easydyn {

using Eigen::Vector3d;

namespace {

visu::Pose operator*(const visu::Pose& a, const visu::Pose& b) {
  return {a.position + a.orientation * b.position, a.orientation * b.orientation};
}

visu::Pose inverse(const visu::Pose& a) {
  const Eigen::Quaterniond back = a.orientation.conjugate();
  return {-(back * a.position), back};
}

bool has_one_coordinate(UrdfJointType type) {
  return type == UrdfJointType::revolute || type == UrdfJointType::continuous ||
         type == UrdfJointType::prismatic;
}

// Along a constant direction by an expression; components that stay 0 are no motions.
Motion along(const Vector3d& e, const Expr& q) {
  const auto part = [&](int i) { return e[i] == 0 ? Expr(0) : e[i] * q; };
  return translate(part(0), part(1), part(2));
}

// The file that a mesh reference means, empty if there is none: beside the URDF file, or in a folder above it.
std::filesystem::path find_mesh(std::string name, const std::filesystem::path& urdf) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  fs::path folder = fs::absolute(urdf, ignored).parent_path();
  if (name.rfind("file://", 0) == 0) name.erase(0, 7);
  if (name.rfind("package://", 0) != 0) {
    const fs::path path = folder / name;
    return fs::is_regular_file(path, ignored) ? path : fs::path();
  }
  name.erase(0, 10);
  for (; !folder.empty(); folder = folder.parent_path()) {
    if (fs::path path = folder / name; fs::is_regular_file(path, ignored)) return path;
    if (folder == folder.root_path()) break;
  }
  return {};
}

bool is_stl(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  return extension == ".stl" || extension == ".STL";
}

}  // namespace

UrdfRobot::Offset::Offset(const visu::Pose& pose)
    : shift(translate(pose.position)),
      turn([&] {
        const Eigen::AngleAxisd a(pose.orientation);
        return Motion::rotation(a.axis(), a.angle());
      }()),
      has_shift(!pose.position.isZero(0)),
      has_turn(!pose.orientation.vec().isZero(0)) {}

Frame UrdfRobot::Offset::after(const Frame& frame) const {
  if (has_shift) return has_turn ? frame * shift * turn : frame * shift;
  return has_turn ? frame * turn : frame;
}

UrdfRobot::UrdfRobot(System& system, const std::filesystem::path& file, const UrdfOptions& options)
    : UrdfRobot(system, read_urdf(file), options) {}

UrdfRobot::UrdfRobot(System& system, UrdfModel model, const UrdfOptions& options)
    : model_(std::move(model)), frames_(model_.links.size()) {
  for (const auto& [name, value] : options.initial)
    if (const UrdfJoint& joint = model_.joints[index_of_scalar_joint(name)]; joint.mimic)
      throw ModelError(fmt::format(
          "robot \"{}\": initial position {} of the joint \"{}\", which mimics \"{}\": give that",
          model_.name, value, name, model_.joints[static_cast<std::size_t>(joint.mimic->joint)].name));
  if (options.base == UrdfBase::floating) base_ = system.free_motion(options.prefix + model_.links[0].name);
  for (std::size_t k = 0; k < model_.joints.size(); ++k) add_joint(k, system, options);
  for (std::size_t k = 0; k < model_.joints.size(); ++k) {
    JointPart& part = joints_[k];
    const UrdfJoint* joint = &model_.joints[k];
    if (!joint->mimic) continue;
    for (; joint->mimic; joint = &model_.joints[static_cast<std::size_t>(joint->mimic->joint)]) {
      part.offset += part.multiplier * joint->mimic->offset;
      part.multiplier *= joint->mimic->multiplier;
    }
    part.coordinates = joints_[index_of_joint(joint->name)].coordinates;
  }
  add_bodies(system, options.prefix);
}

void UrdfRobot::add_joint(std::size_t k, System& system, const UrdfOptions& options) {
  const UrdfJoint& joint = model_.joints[k];
  const std::string name = options.prefix + joint.name;
  JointPart& part = joints_.emplace_back(JointPart{.origin = Offset(joint.origin), .coordinates = {}});
  switch (joint.type) {
    case UrdfJointType::revolute:
    case UrdfJointType::continuous:
    case UrdfJointType::prismatic: {
      if (joint.mimic) break;
      const auto initial = options.initial.find(joint.name);
      part.coordinates = {system.coordinate(name, initial == options.initial.end() ? 0 : initial->second)};
      break;
    }
    case UrdfJointType::planar: {
      const Vector3d& n = joint.axis;
      const Vector3d x = std::abs(n.x()) > 0.9 ? Vector3d::UnitY() : Vector3d::UnitX();
      part.e1 = (x - n.dot(x) * n).normalized();
      part.e2 = n.cross(part.e1);
      part.coordinates = {system.coordinate(name + ".x"), system.coordinate(name + ".y"),
                          system.coordinate(name + ".a")};
      break;
    }
    case UrdfJointType::floating: {
      const FreeMotion motion = system.free_motion(name);
      part.coordinates = {motion.x, motion.y, motion.z, motion.a, motion.b, motion.c};
      part.floating = motion;
      break;
    }
    case UrdfJointType::fixed:
      break;
  }
}

void UrdfRobot::add_bodies(System& system, const std::string& prefix) {
  struct Carrier {
    Body* body = nullptr;  // null: not rigidly on any body
    visu::Pose link = {};  // of the link in the axes of the body
  };
  std::vector<Carrier> carriers;
  for (std::size_t i = 0; i < model_.links.size(); ++i) {
    const UrdfLink& link = model_.links[i];
    Carrier carrier;
    if (i > 0 && model_.joints[i - 1].type == UrdfJointType::fixed) {
      const UrdfJoint& joint = model_.joints[i - 1];
      carrier = carriers[static_cast<std::size_t>(joint.parent)];
      carrier.link = carrier.link * joint.origin;
    }
    if (link.inertia.mass > 0 || (!carrier.body && !link.visuals.empty())) {
      carrier = {&system.body(prefix + link.name, link.inertia), inverse(link.inertial)};
      bodies_.push_back({carrier.body, i, Offset(link.inertial)});
    }
    carriers.push_back(carrier);
    for (const UrdfVisual& visual : link.visuals) {
      visu::Item item = visual.item;
      item.name = prefix + item.name;
      item.frame = carrier.body->name();
      item.offset = carrier.link * item.offset;
      if (item.opacity == 0) continue;
      if (!visual.mesh.empty()) {
        const std::filesystem::path file = find_mesh(visual.mesh, model_.file);
        if (file.empty() || !is_stl(file)) {
          meshes_not_shown_.push_back(visual.mesh);
          continue;
        }
        item.shape = visu::Shape::mesh;
        item.triangles = visu::read_stl(file, visual.mesh_scale);
      }
      items_.push_back(std::move(item));
    }
  }
}

void UrdfRobot::place(const Frame& base) {
  frames_[0] = base_ ? base_->frame(base) : base;
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    const UrdfJoint& joint = model_.joints[k];
    const JointPart& part = joints_[k];
    const Frame origin = part.origin.after(frames_[static_cast<std::size_t>(joint.parent)]);
    Frame& moved = frames_[k + 1];
    switch (joint.type) {
      case UrdfJointType::revolute:
      case UrdfJointType::continuous:
        moved = origin * Motion::rotation(joint.axis, part.multiplier * part.coordinates[0] + part.offset);
        break;
      case UrdfJointType::prismatic:
        moved = origin * along(joint.axis, part.multiplier * part.coordinates[0] + part.offset);
        break;
      case UrdfJointType::planar:
        moved = origin * along(part.e1, part.coordinates[0]) * along(part.e2, part.coordinates[1]) *
                Motion::rotation(joint.axis, part.coordinates[2]);
        break;
      case UrdfJointType::floating:
        moved = part.floating->frame(origin);
        break;
      case UrdfJointType::fixed:
        moved = origin;
        break;
    }
  }
  for (const BodyPart& part : bodies_) *part.body = part.inertial.after(frames_[part.link]);
}

void UrdfRobot::apply_effort(std::string_view joint, double u) {
  const std::size_t k = index_of_scalar_joint(joint);
  apply_effort(k, u);
  if (MotionTree* const tree = frames_[k + 1].tree()) tree->energy().supplied += u * rate(k);
}

void UrdfRobot::apply_effort(std::size_t k, double u) const {
  const UrdfJoint& joint = model_.joints[k];
  const Frame &child = frames_[k + 1], &parent = frames_[static_cast<std::size_t>(joint.parent)];
  const Vector3d action = u * child.direction(joint.axis);  // a rotation about the axis leaves it where it is
  if (joint.type == UrdfJointType::prismatic) {
    child.add_force(action, child.origin());
    parent.add_force(-action, child.origin());
  } else {
    child.add_moment(action);
    parent.add_moment(-action);
  }
}

void UrdfRobot::apply_damping_and_friction(double v0) {
  require_positive("robot \"" + model_.name + "\"", "speed v0 of the regularised friction", v0,
                   "rad/s or m/s");
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    const UrdfJoint& joint = model_.joints[k];
    if (!has_one_coordinate(joint.type) || (joint.damping == 0 && joint.friction == 0)) continue;
    const double v = rate(k), u = -joint.damping * v - joint.friction * std::tanh(v / v0);
    apply_effort(k, u);
    if (MotionTree* const tree = frames_[k + 1].tree()) tree->energy().dissipated -= u * v;
  }
}

Coordinate UrdfRobot::coordinate(std::string_view joint, int i) const {
  const std::size_t k = index_of_joint(joint);
  const auto& own = joints_[k].coordinates;
  if (model_.joints[k].mimic)
    throw ModelError(
        fmt::format("robot \"{}\": the joint \"{}\" has no coordinate, it mimics \"{}\"", model_.name, joint,
                    model_.joints[static_cast<std::size_t>(model_.joints[k].mimic->joint)].name));
  if (i < 0 || i >= static_cast<int>(own.size()))
    throw ModelError(fmt::format("robot \"{}\": coordinate {} of the joint \"{}\", which has {}", model_.name,
                                 i, joint, own.size()));
  return own[static_cast<std::size_t>(i)];
}

Expr UrdfRobot::position(std::string_view joint) const {
  const JointPart& part = joints_[index_of_scalar_joint(joint)];
  return part.multiplier * part.coordinates[0] + part.offset;
}

const Frame& UrdfRobot::link(std::string_view name) const {
  return frames_[index_of_link(name)];
}

Body& UrdfRobot::body(std::string_view link) const {
  const std::size_t i = index_of_link(link);
  for (const BodyPart& part : bodies_)
    if (part.link == i) return *part.body;
  throw ModelError(
      fmt::format("robot \"{}\": the link \"{}\" has no mass, it is no body", model_.name, link));
}

std::size_t UrdfRobot::index_of_joint(std::string_view name) const {
  for (std::size_t k = 0; k < model_.joints.size(); ++k)
    if (model_.joints[k].name == name) return k;
  throw ModelError(fmt::format("robot \"{}\": there is no joint \"{}\"", model_.name, name));
}

std::size_t UrdfRobot::index_of_scalar_joint(std::string_view name) const {
  const std::size_t k = index_of_joint(name);
  if (!has_one_coordinate(model_.joints[k].type))
    throw ModelError(fmt::format("robot \"{}\": the joint \"{}\" must be revolute, continuous or prismatic",
                                 model_.name, name));
  return k;
}

std::size_t UrdfRobot::index_of_link(std::string_view name) const {
  for (std::size_t i = 0; i < model_.links.size(); ++i)
    if (model_.links[i].name == name) return i;
  throw ModelError(fmt::format("robot \"{}\": there is no link \"{}\"", model_.name, name));
}

}  // namespace easydyn
