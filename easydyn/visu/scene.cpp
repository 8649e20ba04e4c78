#include "easydyn/visu/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "easydyn/error.hpp"
#include "easydyn/visu/json.hpp"

namespace easydyn::visu {

namespace {

using json::Value;

constexpr const char* format_name = "easydyn-scene-1";
constexpr std::array<const char*, 5> shape_names = {"box", "cylinder", "wheel", "sphere", "mesh"};
constexpr std::array<const char*, 2> link_names = {"line", "spring"};

template <typename Enum, size_t n>
Enum named(const std::array<const char*, n>& names, const std::string& name) {
  for (size_t i = 0; i < n; ++i)
    if (name == names[i]) return static_cast<Enum>(i);
  throw InputError(fmt::format("unknown shape \"{}\"", name));
}

bool is_finite(const Pose& pose) {
  return pose.position.allFinite() && pose.orientation.coeffs().allFinite() && pose.orientation.norm() > 0.5;
}

// -- C++ to JSON

Value numbers(const Eigen::VectorXd& values) {
  return Value::Array(values.begin(), values.end());
}

/// x y z and the quaternion x y z w
std::array<double, 7> components(const Pose& pose) {
  const Eigen::Vector3d& p = pose.position;
  const Eigen::Vector4d q = pose.orientation.normalized().coeffs();
  return {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
}

Value to_value(const Pose& pose) {
  const auto values = components(pose);
  return Value::Array(values.begin(), values.end());
}

Value to_value(const Anchor& anchor) {
  return json::object({{"frame", anchor.frame}, {"point", numbers(anchor.point)}});
}

Value to_value(const MovingFrame& frame) {
  std::vector<float> values;
  values.reserve(frame.poses.size() * 7);
  for (const Pose& pose : frame.poses)
    for (const double value : components(pose)) values.push_back(float(value));
  Value::Object object = {{"name", frame.name}, {"poses", json::base64(values)}};
  if (frame.rest) object.emplace_back("rest", to_value(*frame.rest));
  return object;
}

Value to_value(const Item& item) {
  Value::Object object = {
      {"name", item.name},          {"frame", item.frame},   {"shape", shape_names[size_t(item.shape)]},
      {"size", numbers(item.size)}, {"colour", item.colour}, {"offset", to_value(item.offset)},
      {"opacity", item.opacity}};
  if (item.shape == Shape::mesh) object.emplace_back("triangles", json::base64(item.triangles));
  return object;
}

Value to_value(const Link& link) {
  return json::object({{"name", link.name},
                       {"a", to_value(link.a)},
                       {"b", to_value(link.b)},
                       {"shape", link_names[size_t(link.shape)]},
                       {"radius", link.radius},
                       {"colour", link.colour}});
}

std::string encoded(const Eigen::MatrixXd& values) {  // row by row
  std::vector<float> floats;
  floats.reserve(size_t(values.size()));
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    for (Eigen::Index j = 0; j < values.cols(); ++j) floats.push_back(float(values(i, j)));
  return json::base64(floats);
}

Value to_value(const DeformingLine& line) {
  Value::Object object = {{"name", line.name},    {"x", encoded(line.x)},
                          {"y", line.y},          {"height", line.height},
                          {"width", line.width},  {"deflection", encoded(line.deflection)},
                          {"colour", line.colour}};
  if (line.block) object.emplace_back("block", numbers(*line.block));
  return object;
}

// -- JSON to C++

Eigen::Vector3d vector3(const Value& value) {
  const auto& array = value.array();
  if (array.size() != 3) throw InputError(fmt::format("expected 3 numbers, found {}", array.size()));
  return {array[0].number(), array[1].number(), array[2].number()};
}

template <typename Numbers>
Pose pose_from(const Numbers& v) {
  return {Eigen::Vector3d(v[0], v[1], v[2]), Eigen::Quaterniond(v[6], v[3], v[4], v[5])};
}

Pose pose(const Value& value) {
  const auto& array = value.array();
  if (array.size() != 7)
    throw InputError(fmt::format("expected a pose of 7 numbers, found {}", array.size()));
  std::array<double, 7> v;
  for (size_t i = 0; i < 7; ++i) v[i] = array[i].number();
  return pose_from(v);
}

Anchor anchor(const Value& value) {
  return {value.at("frame").string(), vector3(value.at("point"))};
}

MovingFrame moving_frame(const Value& value) {
  MovingFrame frame{value.at("name").string(), {}, {}};
  const auto values = json::floats_from_base64(value.at("poses").string());
  if (values.size() % 7 != 0)
    throw InputError(
        fmt::format("frame \"{}\": {} numbers are no whole number of poses", frame.name, values.size()));
  for (size_t i = 0; i < values.size(); i += 7) frame.poses.push_back(pose_from(&values[i]));
  if (value.has("rest")) frame.rest = pose(value.at("rest"));
  return frame;
}

Item item(const Value& value) {
  return {value.at("name").string(),
          value.at("frame").string(),
          named<Shape>(shape_names, value.at("shape").string()),
          vector3(value.at("size")),
          value.at("colour").string(),
          pose(value.at("offset")),
          value.at("opacity").number(),
          value.has("triangles") ? json::floats_from_base64(value.at("triangles").string())
                                 : std::vector<float>()};
}

Link link(const Value& value) {
  return {value.at("name").string(),   anchor(value.at("a")),
          anchor(value.at("b")),       named<LinkShape>(link_names, value.at("shape").string()),
          value.at("radius").number(), value.at("colour").string()};
}

Eigen::VectorXd vector(const Value& value) {
  const auto values = json::floats_from_base64(value.string());
  return Eigen::Map<const Eigen::VectorXf>(values.data(), Eigen::Index(values.size())).cast<double>();
}

DeformingLine deforming_line(const Value& value) {
  DeformingLine line;
  line.name = value.at("name").string();
  line.x = vector(value.at("x"));
  line.y = value.at("y").number();
  line.height = value.at("height").number();
  line.width = value.at("width").number();
  line.colour = value.at("colour").string();
  if (value.has("block")) line.block = vector3(value.at("block"));
  const Eigen::VectorXd flat = vector(value.at("deflection"));
  if (line.x.size() == 0 || flat.size() % line.x.size() != 0)
    throw InputError(fmt::format("line \"{}\": {} deflections do not fit {} points", line.name, flat.size(),
                                 line.x.size()));
  line.deflection = flat.reshaped<Eigen::RowMajor>(flat.size() / line.x.size(), line.x.size());
  return line;
}

Camera camera(const Value& value) {
  return {vector3(value.at("target")), value.at("width").number(), value.at("azimuth").number(),
          value.at("elevation").number(), value.at("follow").string()};
}

template <typename Convert, typename List>
Value::Array converted(const List& list, Convert convert) {
  Value::Array array;
  array.reserve(list.size());
  for (const auto& entry : list) array.push_back(convert(entry));
  return array;
}

void require(bool condition, const std::string& message) {
  if (!condition) throw ModelError(message);
}

void check_line(const DeformingLine& line, Eigen::Index times) {
  const Eigen::Index n = line.x.size();
  require(line.deflection.rows() == times && line.deflection.cols() == n,
          fmt::format("scene: line \"{}\" has {} x {} deflections, must be {} times x {} points", line.name,
                      line.deflection.rows(), line.deflection.cols(), times, n));
  require(n >= 1 && line.x.allFinite() && line.deflection.allFinite() && std::isfinite(line.y + line.height),
          fmt::format("scene: line \"{}\" has no points or a value that is not finite", line.name));
  for (Eigen::Index i = 1; i < n; ++i)
    require(line.x(i) > line.x(i - 1),
            fmt::format("scene: line \"{}\": x must ascend, but x[{}] = {} follows {}", line.name, i,
                        line.x(i), line.x(i - 1)));
  require(line.width > 0,
          fmt::format("scene: line \"{}\": width = {} m, must be > 0", line.name, line.width));
  require(!line.block || (line.block->array() > 0).all(),
          fmt::format("scene: line \"{}\": the block's lengths must be > 0", line.name));
}

}  // namespace

void check(const Scene& scene) {
  const Eigen::Index times = scene.time.size();
  require(times >= 1, "scene: no times");
  require(scene.time.allFinite(), "scene: a time is not finite");
  for (Eigen::Index i = 1; i < times; ++i)
    require(scene.time(i) > scene.time(i - 1),
            fmt::format("scene: time must ascend, but time[{}] = {} s follows {} s", i, scene.time(i),
                        scene.time(i - 1)));
  require(scene.exaggeration > 0 && std::isfinite(scene.exaggeration),
          fmt::format("scene: exaggeration = {}, must be > 0", scene.exaggeration));

  std::set<std::string> names = {""};
  for (const MovingFrame& frame : scene.frames) {
    require(names.insert(frame.name).second,
            fmt::format("scene: frame name \"{}\" is empty or used twice", frame.name));
    require(
        Eigen::Index(frame.poses.size()) == times,
        fmt::format("scene: frame \"{}\" has {} poses, must be {}", frame.name, frame.poses.size(), times));
    for (const Pose& p : frame.poses)
      require(is_finite(p), fmt::format("scene: frame \"{}\" has a pose that is not finite", frame.name));
  }
  const auto require_frame = [&](const std::string& user, const std::string& frame) {
    require(names.count(frame) == 1, fmt::format("scene: {} names the unknown frame \"{}\"", user, frame));
  };
  for (const Item& i : scene.items) {
    require_frame(fmt::format("item \"{}\"", i.name), i.frame);
    const bool is_mesh = i.shape == Shape::mesh;
    const int used = is_mesh ? 0 : i.shape == Shape::box ? 3 : i.shape == Shape::sphere ? 1 : 2;
    require((i.size.head(used).array() > 0).all(),
            fmt::format("scene: item \"{}\" has a size that is not > 0", i.name));
    require(is_mesh ? !i.triangles.empty() && i.triangles.size() % 9 == 0 : i.triangles.empty(),
            fmt::format("scene: item \"{}\" has {} numbers for triangles, must be {}", i.name,
                        i.triangles.size(), is_mesh ? "9, 18, 27, ..." : "0: it is no mesh"));
    require(std::all_of(i.triangles.begin(), i.triangles.end(), [](float x) { return std::isfinite(x); }),
            fmt::format("scene: item \"{}\" has a triangle that is not finite", i.name));
    require(i.opacity > 0 && i.opacity <= 1,
            fmt::format("scene: item \"{}\": opacity = {}, must be in (0, 1]", i.name, i.opacity));
    require(is_finite(i.offset), fmt::format("scene: item \"{}\": its offset is not finite", i.name));
  }
  for (const Link& l : scene.links) {
    require_frame(fmt::format("link \"{}\"", l.name), l.a.frame);
    require_frame(fmt::format("link \"{}\"", l.name), l.b.frame);
    require(l.radius > 0, fmt::format("scene: link \"{}\": radius = {} m, must be > 0", l.name, l.radius));
  }
  for (const DeformingLine& line : scene.lines) check_line(line, times);
  require_frame("the camera", scene.camera.follow);
}

Scene thinned(const Scene& scene, int max_times) {
  const Eigen::Index from = scene.time.size(), to = std::max(2, max_times);
  if (from <= to) return scene;
  const auto source = [&](Eigen::Index i) { return (i * (from - 1) + (to - 1) / 2) / (to - 1); };

  Scene out = scene;
  out.time.resize(to);
  for (Eigen::Index i = 0; i < to; ++i) out.time(i) = scene.time(source(i));
  for (size_t f = 0; f < scene.frames.size(); ++f) {
    out.frames[f].poses.resize(size_t(to));
    for (Eigen::Index i = 0; i < to; ++i)
      out.frames[f].poses[size_t(i)] = scene.frames[f].poses[size_t(source(i))];
  }
  for (size_t l = 0; l < scene.lines.size(); ++l) {
    out.lines[l].deflection.resize(to, scene.lines[l].x.size());
    for (Eigen::Index i = 0; i < to; ++i)
      out.lines[l].deflection.row(i) = scene.lines[l].deflection.row(source(i));
  }
  return out;
}

std::string to_json(const Scene& scene, int max_times) {
  check(scene);
  const Scene s = thinned(scene, max_times);
  const auto value = [](const auto& entry) { return to_value(entry); };
  Value::Object object = {{"format", format_name},
                          {"name", s.name},
                          {"time", encoded(s.time)},
                          {"exaggeration", s.exaggeration},
                          {"frames", converted(s.frames, value)},
                          {"items", converted(s.items, value)},
                          {"links", converted(s.links, value)},
                          {"lines", converted(s.lines, value)},
                          {"camera", json::object({{"target", numbers(s.camera.target)},
                                                   {"width", s.camera.width},
                                                   {"azimuth", s.camera.azimuth},
                                                   {"elevation", s.camera.elevation},
                                                   {"follow", s.camera.follow}})}};
  if (s.ground) object.emplace_back("ground", *s.ground);
  return Value(std::move(object)).text();
}

Scene scene_from_json(std::string_view text, const std::string& source) {
  const Value value = json::parse(text, source);
  Scene scene;
  try {
    if (const std::string& format = value.at("format").string(); format != format_name)
      throw InputError(fmt::format("format \"{}\", expected \"{}\"", format, format_name));
    scene.name = value.at("name").string();
    scene.time = vector(value.at("time"));
    scene.exaggeration = value.at("exaggeration").number();
    for (const Value& v : value.at("frames").array()) scene.frames.push_back(moving_frame(v));
    for (const Value& v : value.at("items").array()) scene.items.push_back(item(v));
    for (const Value& v : value.at("links").array()) scene.links.push_back(link(v));
    for (const Value& v : value.at("lines").array()) scene.lines.push_back(deforming_line(v));
    if (value.has("ground")) scene.ground = value.at("ground").number();
    scene.camera = camera(value.at("camera"));
    check(scene);
  } catch (const Error& error) {
    throw InputError(fmt::format("{}: {}", source, error.what()));
  }
  return scene;
}

}  // namespace easydyn::visu
