#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace easydyn::visu {

/// Position [m] and orientation of one set of axes in another.
struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// Axes that move: one pose in the ground frame for every Scene::time.
///
/// Small motions are invisible at true scale. If `rest` is given, the deviation from it along y and z and its
/// rotation are shown multiplied by Scene::exaggeration; x is the direction of travel and stays true.
struct MovingFrame {
  std::string name;  ///< unique in the scene
  std::vector<Pose> poses;
  std::optional<Pose> rest = {};
};

enum class Shape { box, cylinder, wheel, sphere, mesh };

/// A rigid body's look, fixed in a moving frame or in the ground.
struct Item {
  std::string name;
  std::string frame;  ///< name of the frame that carries it; empty: the ground
  Shape shape = Shape::box;
  Eigen::Vector3d size{1, 1, 1};  ///< box: lengths along x, y, z; cylinder and wheel: radius, length along
                                  ///< the axis y, unused; sphere: radius, unused, unused [m];
                                  ///< mesh: unused
  std::string colour = "#4477aa";
  Pose offset = {};    ///< of the item in its frame
  double opacity = 1;  ///< 0 < opacity <= 1
  /// Of a mesh: x y z of the three corners of each triangle, counterclockwise seen from outside [m].
  std::vector<float> triangles = {};
};

/// A point fixed in a moving frame (empty name: the ground).
struct Anchor {
  std::string frame;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
};

enum class LinkShape { line, spring };

/// Something stretched between two points: a rod, a cable (line) or a spring.
struct Link {
  std::string name;
  Anchor a, b;
  LinkShape shape = LinkShape::line;
  double radius = 0.02;  ///< of the line or of the coil [m]
  std::string colour = "#555555";
};

/// A row of points with fixed x that move vertically: a deflecting rail, or the sleepers below it.
/// Shown at z = height + Scene::exaggeration * deflection.
struct DeformingLine {
  std::string name;
  Eigen::VectorXd x = {};                     ///< n positions, ascending [m]
  Eigen::MatrixXd deflection = {};            ///< times x n, **upward** [m]
  double y = 0, height = 0;                   ///< of the undeformed line [m]
  double width = 0.06;                        ///< of the line [m]
  std::optional<Eigen::Vector3d> block = {};  ///< a box of this size at each point, not a line
  std::string colour = "#333333";
};

/// Where the viewer stands at first. The view encloses everything if `width` is 0.
struct Camera {
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  double width = 0;         ///< visible width at the target [m]
  double azimuth = -60;     ///< of the viewer, from x towards y [deg]; -90 looks along +y
  double elevation = 15;    ///< above the horizon [deg]
  std::string follow = {};  ///< name of a frame whose x motion the camera follows; empty: it stands still
};

/// An animated scene as plain data; it knows no mechanics. Right-handed axes, z up.
struct Scene {
  std::string name;
  Eigen::VectorXd time;  ///< ascending [s]
  std::vector<MovingFrame> frames;
  std::vector<Item> items;
  std::vector<Link> links;
  std::vector<DeformingLine> lines;
  double exaggeration = 1;            ///< of small motions; stated beside the picture
  std::optional<double> ground = {};  ///< height of a grid that stands for the ground [m]
  Camera camera;
};

/// @throws ModelError naming the frame, item, link or line that does not fit: sizes that disagree with the
///         number of times, an unknown frame, a size that is not positive, a value that is not finite
void check(const Scene& scene);

/// The scene with at most `max_times` of its times, evenly chosen, first and last kept.
Scene thinned(const Scene& scene, int max_times);

/// Text for the dataset `/scene` of results.h5 and for the viewer, thinned to `max_times`: a JSON object whose
/// members bear the names of Scene's. `time`, `x`, `deflection` (row by row) and `poses` (x y z and quaternion
/// x y z w per time) are base64 of little-endian float32.
/// @throws ModelError as check()
std::string to_json(const Scene& scene, int max_times = 600);

/// Reads what to_json() wrote. @throws InputError with `source:line:column:` or the member that is wrong
Scene scene_from_json(std::string_view text, const std::string& source = "scene");

}  // namespace easydyn::visu
