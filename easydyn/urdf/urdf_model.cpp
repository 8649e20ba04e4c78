#include "easydyn/urdf/urdf_model.hpp"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <fstream>
#include <map>
#include <mutex>
#include <set>
#include <sstream>

#include "easydyn/error.hpp"
#include "easydyn/urdf/urdf_syntax.hpp"

namespace easydyn {

using Eigen::Vector3d;
using urdf_syntax::label_of;
using urdf_syntax::refuse;

namespace {

// urdfdom reports what it could not read to a global handler only: this one keeps it.
class Messages : public console_bridge::OutputHandler {
 public:
  Messages()
      : lock_(mutex()), handler_(console_bridge::getOutputHandler()), level_(console_bridge::getLogLevel()) {
    console_bridge::useOutputHandler(this);
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_WARN);
  }
  ~Messages() override {
    console_bridge::useOutputHandler(handler_);
    console_bridge::setLogLevel(level_);
  }
  Messages(const Messages&) = delete;

  void log(const std::string& text, console_bridge::LogLevel, const char*, int) override {
    text_ += (text_.empty() ? "" : "; ") + text;
  }
  const std::string& text() const { return text_; }

 private:
  static std::mutex& mutex() {
    static std::mutex one_reader_at_a_time;
    return one_reader_at_a_time;
  }
  std::lock_guard<std::mutex> lock_;
  console_bridge::OutputHandler* handler_;
  console_bridge::LogLevel level_;
  std::string text_;
};

Vector3d vector_of(const urdf::Vector3& v) {
  return {v.x, v.y, v.z};
}

visu::Pose pose_of(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  return {vector_of(pose.position), Eigen::Quaterniond(r.w, r.x, r.y, r.z)};
}

const std::map<std::string, UrdfJointType>& joint_types() {
  static const std::map<std::string, UrdfJointType> types = {
      {"revolute", UrdfJointType::revolute},   {"continuous", UrdfJointType::continuous},
      {"prismatic", UrdfJointType::prismatic}, {"fixed", UrdfJointType::fixed},
      {"floating", UrdfJointType::floating},   {"planar", UrdfJointType::planar}};
  return types;
}

// The element <tag> below another one, or the other one where there is none: a place for an error.
const TiXmlElement& place_of(const TiXmlElement& element, const char* tag) {
  const TiXmlElement* const e = element.FirstChildElement(tag);
  return e ? *e : element;
}

// Reads one file: the document gives places and order, urdfdom the values.
class Reader {
 public:
  Reader(const std::string& text, const std::filesystem::path& file) : file_(file) {
    urdf_syntax::parse(document_, text, file);
    robot_ = document_.RootElement();
    find_names();
    check_joint_types();
    check_tree();
    check_materials();
    Messages messages;
    source_ = urdf::parseURDF(text);
    if (!source_ || !messages.text().empty())
      refuse(file_, *robot_, label_of(*robot_),
             messages.text().empty() ? "urdfdom cannot read it" : messages.text());
  }

  UrdfModel read() {
    model_.name = source_->getName();
    model_.file = file_;
    add_link(*root_);
    for (std::size_t k = 0; k < model_.joints.size(); ++k) read_mimic(k);
    return std::move(model_);
  }

 private:
  using Elements = std::map<std::string, const TiXmlElement*>;

  static std::string name_of(const TiXmlElement& e) { return e.Attribute("name"); }
  static std::string link_of(const TiXmlElement& joint, const char* tag) {
    return joint.FirstChildElement(tag)->Attribute("link");
  }

  void find_names() {
    for (const TiXmlElement* e = robot_->FirstChildElement(); e; e = e->NextSiblingElement()) {
      const bool is_link = e->ValueStr() == "link", is_joint = e->ValueStr() == "joint";
      if (!is_link && !is_joint) continue;
      const auto [at, is_new] = (is_link ? links_ : joints_).emplace(name_of(*e), e);
      if (!is_new)
        refuse(file_, *e, label_of(*e),
               fmt::format("the name is used twice, first in line {}", at->second->Row()));
    }
    if (links_.empty()) refuse(file_, *robot_, label_of(*robot_), "there is no <link>");
  }

  void check_joint_types() const {
    for (const auto& [name, e] : joints_) {
      const std::string type = e->Attribute("type");
      if (joint_types().count(type) == 0)
        refuse(
            file_, *e, label_of(*e),
            fmt::format("type = \"{}\", must be revolute, continuous, prismatic, fixed, floating or planar",
                        type));
      if ((type == "revolute" || type == "prismatic") && !e->FirstChildElement("limit"))
        refuse(file_, *e, label_of(*e), fmt::format("a {} joint must have an element <limit>", type));
    }
  }

  // Every joint joins two links, every link but one is the child of one joint, and all hang on that one.
  void check_tree() {
    Elements parents;  // of the links: their joints
    for (const TiXmlElement* j = robot_->FirstChildElement("joint"); j; j = j->NextSiblingElement("joint")) {
      for (const char* tag : {"parent", "child"})
        if (links_.count(link_of(*j, tag)) == 0)
          refuse(file_, place_of(*j, tag), label_of(*j),
                 fmt::format("the {} link \"{}\" does not exist", tag, link_of(*j, tag)));
      const auto [at, is_new] = parents.emplace(link_of(*j, "child"), j);
      if (!is_new)
        refuse(
            file_, place_of(*j, "child"), label_of(*j),
            fmt::format(
                "the link \"{}\" is the child of the joint \"{}\", too (line {}); closed loops are no URDF",
                at->first, name_of(*at->second), at->second->Row()));
      children_[link_of(*j, "parent")].push_back(j);
    }
    for (const TiXmlElement* e = robot_->FirstChildElement("link"); e; e = e->NextSiblingElement("link")) {
      if (parents.count(name_of(*e)) != 0) continue;
      if (root_)
        refuse(file_, *e, label_of(*e),
               fmt::format("no joint leads to it, as none leads to \"{}\" (line {}): must be one root",
                           name_of(*root_), root_->Row()));
      root_ = e;
    }
    for (const auto& [name, e] : links_) {
      const TiXmlElement* at = e;
      for (std::size_t steps = 0; at != root_; ++steps) {
        if (steps > links_.size())
          refuse(file_, *e, label_of(*e), "it hangs on itself: the joints form a closed loop");
        at = links_.at(link_of(*parents.at(name_of(*at)), "parent"));
      }
    }
  }

  // A material is described for all, or in the first visual that uses it.
  void check_materials() const {
    std::set<std::string> known;
    const auto check = [&](const TiXmlElement& owner, const TiXmlElement& e) {
      if (e.FirstChildElement("color") || e.FirstChildElement("texture"))
        known.insert(name_of(e));
      else if (known.count(name_of(e)) == 0)
        refuse(file_, e, label_of(owner),
               fmt::format("the material \"{}\" has no <color> or <texture>, here or before", name_of(e)));
    };
    for (const TiXmlElement* e = robot_->FirstChildElement("material"); e;
         e = e->NextSiblingElement("material"))
      check(*robot_, *e);
    for (const TiXmlElement* e = robot_->FirstChildElement("link"); e; e = e->NextSiblingElement("link"))
      for (const TiXmlElement* v = e->FirstChildElement("visual"); v; v = v->NextSiblingElement("visual"))
        if (const TiXmlElement* const m = v->FirstChildElement("material")) check(*e, *m);
  }

  // The link, then its joints in the order of the file, each followed by what it carries.
  void add_link(const TiXmlElement& e) {
    const int parent = static_cast<int>(model_.links.size());
    model_.links.push_back(read_link(e));
    for (const TiXmlElement* j : children_[name_of(e)]) {
      UrdfJoint joint = read_joint(*j);
      joint.parent = parent;
      joint.child = static_cast<int>(model_.links.size());
      model_.joints.push_back(std::move(joint));
      add_link(*links_.at(link_of(*j, "child")));
    }
  }

  UrdfLink read_link(const TiXmlElement& e) const {
    const urdf::LinkConstSharedPtr source = source_->getLink(name_of(e));
    UrdfLink link{.name = source->name, .line = e.Row(), .inertia = {}, .inertial = {}, .visuals = {}};
    if (source->inertial) {
      const urdf::Inertial& i = *source->inertial;
      Eigen::Matrix3d J;
      J << i.ixx, i.ixy, i.ixz, i.ixy, i.iyy, i.iyz, i.ixz, i.iyz, i.izz;
      link.inertia = {i.mass, J};
      link.inertial = pose_of(i.origin);
      check_inertia(e, link.inertia);
    }
    for (const auto& visual : source->visual_array) link.visuals.push_back(read_visual(*visual, link));
    return link;
  }

  // What a rigid body can have. The allowance is that of Body: rounding in the last digits of a double.
  void check_inertia(const TiXmlElement& e, const Inertia& inertia) const {
    const TiXmlElement& place = place_of(*e.FirstChildElement("inertial"), "inertia");
    if (inertia.mass == 0) {
      if (!inertia.J.isZero(0))
        refuse(file_, place, label_of(e), "mass = 0 kg with moments of inertia, must be > 0");
      return;
    }
    const Vector3d J = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia.J).eigenvalues();
    const double slack = 1e-9 * J.cwiseAbs().maxCoeff();
    if (J[0] < -slack)
      refuse(file_, place, label_of(e),
             fmt::format("principal moments of inertia {:g}, {:g}, {:g} kg m^2, must be >= 0", J[0], J[1],
                         J[2]));
    if (J[0] + J[1] < J[2] - slack)
      refuse(file_, place, label_of(e),
             fmt::format(
                 "principal moments of inertia {:g}, {:g}, {:g} kg m^2: the largest exceeds the sum of the "
                 "others by {:g}, must be <= their sum",
                 J[0], J[1], J[2], J[2] - J[0] - J[1]));
  }

  static UrdfVisual read_visual(const urdf::Visual& source, const UrdfLink& link) {
    UrdfVisual visual;
    visu::Item& item = visual.item;
    const std::size_t number = link.visuals.size() + 1;
    item.name = !source.name.empty() ? source.name
                : number == 1        ? link.name
                                     : fmt::format("{} ({})", link.name, number);
    item.frame = link.name;
    item.offset = pose_of(source.origin);
    switch (source.geometry->type) {
      case urdf::Geometry::BOX:
        item.shape = visu::Shape::box;
        item.size = vector_of(dynamic_cast<const urdf::Box&>(*source.geometry).dim);
        break;
      case urdf::Geometry::SPHERE: {
        const double radius = dynamic_cast<const urdf::Sphere&>(*source.geometry).radius;
        item.shape = visu::Shape::sphere;
        item.size = {radius, radius, radius};
        break;
      }
      case urdf::Geometry::CYLINDER: {  // along z here, along y in a scene
        const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(*source.geometry);
        item.shape = visu::Shape::cylinder;
        item.size = {cylinder.radius, cylinder.length, cylinder.radius};
        item.offset.orientation *= Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitY(), Vector3d::UnitZ());
        break;
      }
      case urdf::Geometry::MESH: {
        const auto& mesh = dynamic_cast<const urdf::Mesh&>(*source.geometry);
        visual.mesh = mesh.filename;
        visual.mesh_scale = vector_of(mesh.scale);
        break;
      }
    }
    if (source.material && source.material->texture_filename.empty()) {
      const urdf::Color& c = source.material->color;
      const auto level = [](float part) { return static_cast<int>(std::lround(255 * part)); };
      item.colour = fmt::format("#{:02x}{:02x}{:02x}", level(c.r), level(c.g), level(c.b));
      item.opacity = c.a;
    }
    return visual;
  }

  UrdfJoint read_joint(const TiXmlElement& e) const {
    const urdf::JointConstSharedPtr source = source_->getJoint(name_of(e));
    UrdfJoint joint;
    joint.name = source->name;
    joint.line = e.Row();
    joint.type = joint_types().at(e.Attribute("type"));
    joint.origin = pose_of(source->parent_to_joint_origin_transform);
    if (joint.type != UrdfJointType::fixed && joint.type != UrdfJointType::floating) {
      const Vector3d axis = vector_of(source->axis);
      if (!(axis.norm() > 0))
        refuse(file_, place_of(e, "axis"), label_of(e), "the axis has length 0, must be > 0");
      joint.axis = axis.normalized();
    }
    if (source->limits) {
      const urdf::JointLimits& l = *source->limits;
      if (l.lower > l.upper)
        refuse(file_, place_of(e, "limit"), label_of(e),
               fmt::format("lower = {:g} exceeds upper = {:g}, must be <= it", l.lower, l.upper));
      joint.limits = {l.lower, l.upper, l.effort, l.velocity};
    }
    if (source->dynamics) {
      joint.damping = source->dynamics->damping;
      joint.friction = source->dynamics->friction;
      const bool has_many = joint.type == UrdfJointType::floating || joint.type == UrdfJointType::planar;
      if (has_many && (joint.damping != 0 || joint.friction != 0))
        refuse(file_, place_of(e, "dynamics"), label_of(e),
               fmt::format(
                   "damping = {:g}, friction = {:g} of a {} joint act on no single coordinate, must be 0",
                   joint.damping, joint.friction, e.Attribute("type")));
    }
    return joint;
  }

  static bool has_one_coordinate(const UrdfJoint& joint) {
    return joint.type == UrdfJointType::revolute || joint.type == UrdfJointType::continuous ||
           joint.type == UrdfJointType::prismatic;
  }

  // After all joints are known. The chain of the joints that it mimics must end.
  void read_mimic(std::size_t k) {
    const TiXmlElement& e = *joints_.at(model_.joints[k].name);
    const auto& source = source_->getJoint(model_.joints[k].name)->mimic;
    if (!source) return;
    const auto refuse_mimic = [&](const std::string& reason) {
      refuse(file_, place_of(e, "mimic"), label_of(e), reason);
    };
    if (!has_one_coordinate(model_.joints[k]))
      refuse_mimic(fmt::format("a {} joint cannot mimic, must be revolute, continuous or prismatic",
                               e.Attribute("type")));
    int followed = -1;
    for (std::size_t i = 0; i < model_.joints.size(); ++i)
      if (model_.joints[i].name == source->joint_name) followed = static_cast<int>(i);
    if (followed < 0)
      refuse_mimic(fmt::format("it mimics the joint \"{}\", which does not exist", source->joint_name));
    if (!has_one_coordinate(model_.joints[static_cast<std::size_t>(followed)]))
      refuse_mimic(fmt::format("it mimics the joint \"{}\", which must be revolute, continuous or prismatic",
                               source->joint_name));
    model_.joints[k].mimic = {followed, source->multiplier, source->offset};
    urdf::JointConstSharedPtr next = source_->getJoint(source->joint_name);
    for (std::size_t steps = 0; next && steps < joints_.size(); ++steps) {
      if (next->name == model_.joints[k].name)
        refuse_mimic(fmt::format("it mimics \"{}\", which leads back to it", source->joint_name));
      next = next->mimic ? source_->getJoint(next->mimic->joint_name) : nullptr;
    }
  }

  const std::filesystem::path& file_;
  TiXmlDocument document_;
  const TiXmlElement *robot_ = nullptr, *root_ = nullptr;
  Elements links_, joints_;
  std::map<std::string, std::vector<const TiXmlElement*>>
      children_;  // joints by parent link, in the file's order
  urdf::ModelInterfaceSharedPtr source_;
  UrdfModel model_;
};

}  // namespace

UrdfModel read_urdf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (!(stream && text << stream.rdbuf()))
    throw InputError(fmt::format("{}: empty or cannot be read", file.string()));
  return urdf_from_text(text.str(), file);
}

UrdfModel urdf_from_text(std::string_view text, const std::filesystem::path& source) {
  return Reader(std::string(text), source).read();
}

}  // namespace easydyn
