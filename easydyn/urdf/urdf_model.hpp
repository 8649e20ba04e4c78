#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "easydyn/math/inertia.hpp"
#include "easydyn/visu/scene.hpp"

namespace easydyn {

/// What a visual element of a link looks like. A mesh is a reference: `mesh` names its file, `mesh_scale` its factors,
/// and the item has neither shape nor size; of the others both are empty.
struct UrdfVisual {
  visu::Item item;  ///< its frame is the link, its offset the pose in the link frame
  std::string mesh;
  Eigen::Vector3d mesh_scale = Eigen::Vector3d::Ones();
};

/// A link: a rigid body, or without mass only a frame.
struct UrdfLink {
  std::string name;
  int line = 0;         ///< where the file describes it
  Inertia inertia;      ///< about the centre of mass, in the axes of `inertial`; mass 0: none
  visu::Pose inertial;  ///< centre of mass and axes of the inertia, in the link frame
  std::vector<UrdfVisual> visuals;
};

enum class UrdfJointType { revolute, continuous, prismatic, fixed, floating, planar };

/// The limits of a joint, as the file gives them: data for a controller, nothing enforces them.
struct UrdfLimits {
  double lower = 0, upper = 0;      ///< [rad or m]
  double effort = 0, velocity = 0;  ///< largest magnitudes [N m or N], [rad/s or m/s]
};

/// A joint carries the frame of its child link: from the frame of the parent link by `origin`, then by its motion.
struct UrdfJoint {
  std::string name;
  int line = 0;  ///< where the file describes it
  UrdfJointType type = UrdfJointType::fixed;
  int parent = 0, child = 0;                        ///< links
  visu::Pose origin;                                ///< of the joint frame in the frame of the parent link
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< in the joint frame, unit length; planar: the normal
  std::optional<UrdfLimits> limits;
  double damping = 0;   ///< [N m s/rad or N s/m], >= 0
  double friction = 0;  ///< dry friction [N m or N], >= 0
  /// q = multiplier q_joint + offset
  struct Mimic {
    int joint;
    double multiplier, offset;
  };
  std::optional<Mimic> mimic;
};

/// A robot as its URDF file describes it, checked. Links and joints are in the order of the tree, depth first, siblings
/// as in the file: link 0 is the root, and the child of joint k is link k + 1.
struct UrdfModel {
  std::string name;
  std::filesystem::path file;
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;
};

/// Reads and checks a URDF file (docs/formats.md: what is read, what is ignored, what is refused).
///
/// @throws InputError with file, line, column, the link or joint, and the reason: a misspelt or repeated element or
///         attribute, a number that is none or out of its range, masses and moments that no rigid body has, names that
///         are used twice or missing, links that form no tree
UrdfModel read_urdf(const std::filesystem::path& file);

/// The same from a text; `source` stands for the file in errors, and relative mesh files are beside it.
UrdfModel urdf_from_text(std::string_view text, const std::filesystem::path& source = "urdf");

}  // namespace easydyn
