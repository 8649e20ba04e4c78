#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "easydyn/mbs/system.hpp"
#include "easydyn/urdf/urdf_model.hpp"
#include "easydyn/visu/scene.hpp"

namespace easydyn {

/// How the root link of a robot is carried by its base frame.
enum class UrdfBase {
  fixed,    ///< rigidly
  floating  ///< by a free motion, named after the root link
};

struct UrdfOptions {
  std::string prefix = {};  ///< of the names of coordinates and bodies: for several robots in one system
  UrdfBase base = UrdfBase::fixed;
  std::map<std::string, double> initial =
      {};  ///< of joints with one coordinate: position at the start [rad or m]
};

/// A robot from a URDF file, built into a system; it can be given forces and mixed with bodies written by hand.
///
///     class Cell : public System {
///       UrdfRobot arm{*this, "arm.urdf"};
///       Body& payload = body("payload", 2.0);
///       void positions() override {
///         arm.place();
///         payload = arm.link("tool") * translate(0, 0, 0.1);
///       }
///       void forces() override {
///         gravity();
///         arm.apply_effort("elbow", 12);
///       }
///     };
///
/// Coordinates are declared in the order of the tree, under the name of the joint: of a planar joint `joint.x`,
/// `joint.y` and `joint.a`, of a floating one those of a FreeMotion. A joint that mimics has none: it moves by
/// q = multiplier q_joint + offset, whatever the chain. A planar joint moves along e1 and e2 and turns about its normal
/// n, with e1 the x axis of the joint frame projected on the plane (its y axis where |n_x| > 0.9) and e2 = n x e1.
///
/// A link with mass is a body of its name: the origin of its frame is the centre of mass, its axes are those of the
/// inertial frame. A link without mass is a frame only, unless it is seen and no link with a body carries it rigidly:
/// then it is a body of mass 0. A joint after which nothing has mass leaves the mass matrix singular.
class UrdfRobot {
 public:
  /// @throws InputError as read_urdf(); ModelError if an initial position names no joint with a coordinate, or a name
  ///         is taken in the system
  UrdfRobot(System& system, const std::filesystem::path& file, const UrdfOptions& options = {});
  UrdfRobot(System& system, UrdfModel model, const UrdfOptions& options = {});

  const UrdfModel& model() const { return model_; }

  /// Places all links, in positions().
  void place(const Frame& base = {});
  /// Applies the effort u along or about the axis of a joint to its child link, and the reaction to its parent link, in
  /// forces(): [N or N m]. Counts as power supplied.
  void apply_effort(std::string_view joint, double u);
  /// Applies damping and dry friction of all joints, in forces():
  ///
  ///   u = -damping q. - friction tanh(q. / v0)
  ///
  /// The regularised friction does not stick: below v0 it is viscous.
  /// @param v0  [rad/s or m/s], > 0
  /// @throws ModelError if v0 is not positive
  void apply_damping_and_friction(double v0 = 1e-3);

  /// Coordinate i of a joint. @throws ModelError if the joint does not exist or has not so many: none if it mimics
  Coordinate coordinate(std::string_view joint, int i = 0) const;
  /// Position and rate of a joint with one degree of freedom, which may mimic; in positions() after place() and in
  /// forces() [rad or m].
  Expr position(std::string_view joint) const;
  /// The frame of a link as the last place() has left it. @throws ModelError if the link does not exist
  const Frame& link(std::string_view name) const;
  /// @throws ModelError if the link does not exist or is no body
  Body& body(std::string_view link) const;

  /// What the links look like, carried by the frames that Recorder::scene() has. Meshes in STL files are read, looked
  /// for beside the URDF file; `package://name/` is the folder `name` among those that contain it.
  const std::vector<visu::Item>& items() const { return items_; }
  /// Mesh files that are not in items(): not found, or in another format.
  const std::vector<std::string>& meshes_not_shown() const { return meshes_not_shown_; }

 private:
  // A constant pose, as motions made once.
  struct Offset {
    explicit Offset(const visu::Pose& pose);
    Frame after(const Frame& frame) const;
    Motion shift, turn;
    bool has_shift, has_turn;
  };
  struct JointPart {
    Offset origin;
    std::vector<Coordinate> coordinates;  // its own, or the one that it mimics
    double multiplier = 1, offset = 0;    // q = multiplier * coordinate + offset
    std::optional<FreeMotion> floating = {};
    Eigen::Vector3d e1 = Eigen::Vector3d::Zero(), e2 = e1;  // of a planar joint
  };
  struct BodyPart {
    Body* body;
    std::size_t link;
    Offset inertial;
  };

  void add_joint(std::size_t k, System& system, const UrdfOptions& options);
  void add_bodies(System& system, const std::string& prefix);
  std::size_t index_of_joint(std::string_view name) const;
  std::size_t index_of_link(std::string_view name) const;
  std::size_t index_of_scalar_joint(std::string_view name) const;
  void apply_effort(std::size_t k, double u) const;
  double rate(std::size_t k) const { return joints_[k].multiplier * joints_[k].coordinates[0].rate(); }

  UrdfModel model_;
  std::optional<FreeMotion> base_;
  std::vector<JointPart> joints_;
  std::vector<BodyPart> bodies_;
  std::vector<Frame> frames_;  // of the links
  std::vector<visu::Item> items_;
  std::vector<std::string> meshes_not_shown_;
};

}  // namespace easydyn
