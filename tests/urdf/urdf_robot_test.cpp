// Robots from URDF texts against the same mechanisms written by hand on the kernel.
#include "easydyn/urdf/urdf_robot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "easydyn/easydyn.hpp"
#include "tests/temporary_folder.hpp"

namespace easydyn {
namespace {

using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;

// Every joint type, skew axes and origins, inertias in frames of their own, a chain of mimics that starts before the
// joint that it follows, and links without mass on the way.
const char* const every_joint = R"(<?xml version="1.0"?>
<robot name="every joint">
  <link name="base"><inertial><mass value="5"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="shoulder" type="revolute">
    <parent link="base"/> <child link="upper"/>
    <origin xyz="0.1 -0.2 0.5" rpy="0.3 -0.4 0.5"/> <axis xyz="1 2 2"/>
    <limit lower="-1" upper="2" effort="50" velocity="3"/> <dynamics damping="0.7" friction="0.4"/>
  </joint>
  <link name="upper"><inertial>
    <origin xyz="0.2 0.03 -0.04" rpy="0.1 0.2 -0.7"/> <mass value="3"/>
    <inertia ixx="0.04" ixy="0.003" ixz="-0.002" iyy="0.05" iyz="0.004" izz="0.03"/>
  </inertial></link>
  <joint name="finger" type="prismatic">
    <parent link="slider"/> <child link="finger link"/> <axis xyz="0 0 -2"/>
    <mimic joint="thumb" multiplier="-0.5" offset="0.1"/> <limit lower="0" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="slide" type="prismatic">
    <parent link="upper"/> <child link="slider"/> <origin xyz="0.4 0 0" rpy="0 1.2 0"/> <axis xyz="0.6 0 0.8"/>
    <limit lower="0" upper="1" effort="10" velocity="1"/> <dynamics damping="3" friction="2"/>
  </joint>
  <link name="slider"><inertial>
    <origin xyz="0 0 0.1"/> <mass value="1.5"/> <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.012" iyz="0" izz="0.009"/>
  </inertial></link>
  <link name="finger link"><inertial>
    <mass value="0.2"/> <inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/>
  </inertial></link>
  <joint name="thumb" type="revolute">
    <parent link="slider"/> <child link="thumb link"/> <origin xyz="0 0.1 0"/> <axis xyz="0 1 0"/>
    <mimic joint="spin" multiplier="3" offset="-0.2"/> <limit lower="0" upper="1" effort="1" velocity="1"/>
    <dynamics damping="0.3"/>
  </joint>
  <link name="thumb link"><inertial>
    <origin xyz="0.05 0 0"/> <mass value="0.3"/> <inertia ixx="1e-3" ixy="0" ixz="0" iyy="1e-3" iyz="0" izz="1e-3"/>
  </inertial></link>
  <joint name="mount" type="fixed">
    <parent link="upper"/> <child link="frame only"/> <origin xyz="0 0.3 0" rpy="1.57 0 0.2"/>
  </joint>
  <link name="frame only"/>
  <joint name="spin" type="continuous"> <parent link="frame only"/> <child link="rotor"/> </joint>
  <link name="rotor"><inertial>
    <origin xyz="0.02 0.01 0" rpy="0 0 0.3"/> <mass value="0.8"/>
    <inertia ixx="0.002" ixy="0" ixz="0" iyy="0.003" iyz="0" izz="0.0025"/>
  </inertial></link>
  <joint name="table" type="planar">
    <parent link="rotor"/> <child link="puck"/> <origin xyz="0 0 0.2" rpy="0.5 0 0"/> <axis xyz="0 0.6 0.8"/>
  </joint>
  <link name="puck"><inertial>
    <origin xyz="0.01 0.02 0.03"/> <mass value="0.4"/> <inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.0015"/>
  </inertial></link>
  <joint name="flight" type="floating"> <parent link="upper"/> <child link="drone"/> <origin xyz="0 0 1" rpy="0 0.3 0"/> </joint>
  <link name="drone"><inertial>
    <origin xyz="0 0 -0.05"/> <mass value="2"/> <inertia ixx="0.02" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.04"/>
  </inertial></link>
</robot>)";

// rpy of URDF: about the fixed axes x, y, z one after the other.
Frame turned(const Frame& frame, double roll, double pitch, double yaw) {
  return frame * rotate_z(yaw) * rotate_y(pitch) * rotate_x(roll);
}

Inertia with_products(double m, double xx, double xy, double xz, double yy, double yz, double zz) {
  Eigen::Matrix3d J;
  J << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return {m, J};
}

class Loaded : public System {
 public:
  explicit Loaded(const UrdfOptions& options = {}) : robot(*this, urdf_from_text(every_joint), options) {}
  UrdfRobot robot;

 protected:
  void positions() override { robot.place(); }
  void forces() override {
    gravity();
    robot.apply_damping_and_friction(0.1);
    robot.apply_effort("shoulder", 7);
    robot.apply_effort("slide", -11);
    robot.apply_effort("finger", 5);
  }
};

// The same by hand, the coordinates in the order of the tree.
class ByHand : public System {
 public:
  Coordinate shoulder = coordinate("shoulder"), slide = coordinate("slide"), spin = coordinate("spin");
  Coordinate tx = coordinate("table.x"), ty = coordinate("table.y"), ta = coordinate("table.a");
  Coordinate fx = coordinate("flight.x"), fy = coordinate("flight.y"), fz = coordinate("flight.z");
  Coordinate fa = coordinate("flight.a"), fb = coordinate("flight.b"), fc = coordinate("flight.c");
  Body& base = body("base", {5, 1, 1, 1});
  Body& upper = body("upper", with_products(3, 0.04, 0.003, -0.002, 0.05, 0.004, 0.03));
  Body& slider = body("slider", {1.5, 0.01, 0.012, 0.009});
  Body& finger = body("finger", 0.2);
  Body& thumb = body("thumb", {0.3, 1e-3});
  Body& rotor = body("rotor", {0.8, 0.002, 0.003, 0.0025});
  Body& puck = body("puck", {0.4, 0.001, 0.001, 0.0015});
  Body& drone = body("drone", {2, 0.02, 0.03, 0.04});
  Frame upper_link, slider_link, thumb_link, finger_link, fork;

 protected:
  void positions() override {
    base = Frame();
    upper_link = turned(translate(0.1, -0.2, 0.5), 0.3, -0.4, 0.5) * rotate({1, 2, 2}, shoulder);
    upper = turned(upper_link * translate(0.2, 0.03, -0.04), 0.1, 0.2, -0.7);
    slider_link = upper_link * translate(0.4, 0, 0) * rotate_y(1.2) * translate(0.6 * slide, 0, 0.8 * slide);
    slider = slider_link * translate(0, 0, 0.1);
    const Expr thumb_angle = 3 * spin - 0.2;
    finger_link = slider_link * translate(0, 0, -(-0.5 * thumb_angle + 0.1));
    finger = finger_link;
    thumb_link = slider_link * translate(0, 0.1, 0) * rotate_y(thumb_angle);
    thumb = thumb_link * translate(0.05, 0, 0);
    fork = turned(upper_link * translate(0, 0.3, 0), 1.57, 0, 0.2);
    const Frame rotor_link = fork * rotate_x(spin);
    rotor = rotor_link * translate(0.02, 0.01, 0) * rotate_z(0.3);
    // e1 = x, e2 = n x e1 = (0, 0.8, -0.6)
    const Frame puck_link = rotor_link * translate(0, 0, 0.2) * rotate_x(0.5) *
                            translate(tx, 0.8 * ty, -0.6 * ty) * rotate({0, 0.6, 0.8}, ta);
    puck = puck_link * translate(0.01, 0.02, 0.03);
    const Frame drone_link = upper_link * translate(0, 0, 1) * rotate_y(0.3) * translate(fx, fy, fz) *
                             rotate_x(fa) * rotate_y(fb) * rotate_z(fc);
    drone = drone_link * translate(0, 0, -0.05);
  }
  void forces() override {
    gravity();
    const auto couple = [](const Frame& child, const Vector3d& axis, double u, const Frame& parent) {
      child.add_moment(u * child.direction(axis.normalized()));
      parent.add_moment(-u * child.direction(axis.normalized()));
    };
    const auto pair = [](const Frame& child, const Vector3d& axis, double u, const Frame& parent) {
      child.add_force(u * child.direction(axis.normalized()), child.origin());
      parent.add_force(-u * child.direction(axis.normalized()), child.origin());
    };
    couple(upper_link, {1, 2, 2}, 7 - 0.7 * shoulder.rate() - 0.4 * std::tanh(shoulder.rate() / 0.1),
           Frame());
    pair(slider_link, {0.6, 0, 0.8}, -11 - 3 * slide.rate() - 2 * std::tanh(slide.rate() / 0.1), upper_link);
    pair(finger_link, {0, 0, -1}, 5, slider_link);
    couple(thumb_link, {0, 1, 0}, -0.3 * 3 * spin.rate(), slider_link);
  }
};

// Largest difference of mass matrix, bias and energies at random states, relative to the largest entry of each.
double largest_difference(System& a, System& b) {
  EXPECT_EQ(a.size(), b.size());
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> number(-1.3, 1.3);
  double largest = 0;
  for (int sample = 0; sample < 20; ++sample) {
    State s = a.initial_state(), r = b.initial_state();
    for (Eigen::Index i = 0; i < s.q.size(); ++i) {
      s.q[i] = r.q[i] = number(generator);
      s.qd[i] = r.qd[i] = number(generator);
    }
    const auto compare = [&](const auto& x, const auto& y) {
      largest = std::max(largest, (x - y).cwiseAbs().maxCoeff() / y.cwiseAbs().maxCoeff());
    };
    compare(a.compute_mass_matrix(s), b.compute_mass_matrix(r));
    compare(a.compute_bias(s), b.compute_bias(r));
    const EnergyBalance e = a.compute_energy(s), f = b.compute_energy(r);
    compare(Vector3d(e.kinetic, e.potential, 0), Vector3d(f.kinetic, f.potential, 0));
  }
  return largest;
}

// The required bound; measured 8e-16.
constexpr double round_trip = 1e-12;

TEST(UrdfRobot, HasTheEquationsOfTheModelWrittenByHand) {
  Loaded loaded;
  ByHand by_hand;
  for (int i = 0; i < by_hand.size(); ++i) EXPECT_EQ(loaded.coordinate_name(i), by_hand.coordinate_name(i));
  EXPECT_EQ(loaded.bodies().size(), by_hand.bodies().size());
  EXPECT_LT(largest_difference(loaded, by_hand), round_trip);
}

TEST(UrdfRobot, AccountsForThePowerOfItsJoints) {
  Loaded loaded;
  State s = loaded.initial_state();
  s.q.setConstant(0.2);
  s.qd << 0.3, 0.5, -0.7, Eigen::VectorXd::Zero(9);
  const EnergyBalance e = loaded.compute_energy(s);
  // From the rates of the joints: finger = -0.5 * 3 * spin, thumb = 3 * spin.
  EXPECT_NEAR(e.supplied, 7 * 0.3 - 11 * 0.5 + 5 * (-1.5 * -0.7), 1e-14);
  EXPECT_NEAR(e.dissipated,
              0.7 * 0.09 + 0.4 * std::tanh(3) * 0.3 + 3 * 0.25 + 2 * std::tanh(5) * 0.5 + 0.3 * 9 * 0.49,
              1e-14);
}

TEST(UrdfRobot, GivesItsParts) {
  Loaded loaded({.prefix = "left ", .base = UrdfBase::fixed, .initial = {{"slide", 0.25}}});
  UrdfRobot& robot = loaded.robot;
  EXPECT_EQ(loaded.initial_state().q[robot.coordinate("slide").index()], 0.25);
  EXPECT_EQ(loaded.coordinate_name(robot.coordinate("flight", 5).index()), "left flight.c");
  EXPECT_EQ(robot.body("upper").name(), "left upper");
  EXPECT_EQ(robot.body("upper").mass(), 3);
  EXPECT_EQ(robot.model().joints[0].limits->upper, 2);
  EXPECT_EQ(robot.model().joints[0].limits->effort, 50);
  EXPECT_THAT(message_of<ModelError>([&] { (void)robot.coordinate("thumb"); }),
              HasSubstr("it mimics \"spin\""));
  EXPECT_THAT(message_of<ModelError>([&] { (void)robot.coordinate("slide", 1); }), HasSubstr("which has 1"));
  EXPECT_THAT(message_of<ModelError>([&] { (void)robot.coordinate("knee"); }),
              HasSubstr("no joint \"knee\""));
  EXPECT_THAT(message_of<ModelError>([&] { (void)robot.link("leg"); }), HasSubstr("no link \"leg\""));
  EXPECT_THAT(message_of<ModelError>([&] { (void)robot.body("frame only"); }), HasSubstr("it is no body"));
  EXPECT_THAT(message_of<ModelError>([&] { robot.apply_effort("table", 1); }),
              HasSubstr("\"table\" must be revolute"));
  EXPECT_THAT(message_of<ModelError>([&] { robot.apply_damping_and_friction(0); }), HasSubstr("must be > 0"));
  EXPECT_THAT(message_of<ModelError>([] {
                Loaded({.initial = {{"spine", 1.0}}});
              }),
              HasSubstr("no joint \"spine\""));
  EXPECT_THAT(message_of<ModelError>([] {
                Loaded({.initial = {{"thumb", 1.0}}});
              }),
              HasSubstr("mimics \"spin\""));
}

TEST(UrdfRobot, StandsTwiceInOneSystemOnMovingBases) {
  class Pair : public System {
   public:
    Coordinate x = coordinate("x");
    UrdfRobot a{*this, urdf_from_text(every_joint), {.prefix = "a "}},
        b{*this, urdf_from_text(every_joint), {.prefix = "b "}};

   protected:
    void positions() override {
      a.place(translate(x, 0, 0));
      b.place(translate(x, 2, 0) * rotate_z(0.5));
    }
  } pair;
  State s = pair.initial_state();
  s.qd[0] = 3;
  // Both move as one: twice the mass, 13.2 kg each.
  EXPECT_NEAR(pair.compute_energy(s).kinetic, 0.5 * 26.4 * 9, 1e-12);
}

// Two links in the x-z plane, for mixing with bodies written by hand.
const char* const planar_arm = R"(<robot name="planar arm">
  <link name="ground"/>
  <joint name="a" type="continuous"> <parent link="ground"/> <child link="upper"/> <axis xyz="0 1 0"/> </joint>
  <link name="upper"><inertial>
    <origin xyz="0.5 0 0"/> <mass value="2"/> <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.2"/>
  </inertial></link>
  <joint name="b" type="continuous">
    <parent link="upper"/> <child link="fore"/> <origin xyz="1 0 0"/> <axis xyz="0 1 0"/>
  </joint>
  <link name="fore"><inertial>
    <origin xyz="0.4 0 0"/> <mass value="1"/> <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/>
  </inertial></link>
</robot>)";

class ArmFromUrdf {
 public:
  explicit ArmFromUrdf(System& system) : robot_(system, urdf_from_text(planar_arm)) {}
  void place() { robot_.place(); }
  const Frame& link(const char* name) const { return robot_.link(name); }

 private:
  UrdfRobot robot_;
};

class ArmByHand {
 public:
  explicit ArmByHand(System& system)
      : a_(system.coordinate("a")),
        b_(system.coordinate("b")),
        upper_body_(system.body("upper", {2, 0.01, 0.2, 0.2})),
        fore_body_(system.body("fore", {1, 0.01, 0.1, 0.1})) {}
  void place() {
    upper_ = rotate_y(a_);
    fore_ = upper_ * translate(1, 0, 0) * rotate_y(b_);
    upper_body_ = upper_ * translate(0.5, 0, 0);
    fore_body_ = fore_ * translate(0.4, 0, 0);
  }
  const Frame& link(const char* name) const { return name[0] == 'u' ? upper_ : fore_; }

 private:
  Coordinate a_, b_;
  Body &upper_body_, &fore_body_;
  Frame upper_, fore_;
};

// A pendulum hangs on the fore link, a spring pulls it to the ground, and a telescope from the ground closes a loop with
// a point of the upper link.
template <class Arm>
class Mixed : public System {
 public:
  Arm arm{*this};
  Coordinate swing = coordinate("swing", 0.4);
  Body& pendulum = body("pendulum", {0.7, 0.02});
  Body& cylinder = body("cylinder", {1.2, 0.05});
  Body& rod = body("rod", {0.6, 0.01});
  SpringDamper spring{"spring", 200, 5, 0.3};
  Loop<2> telescope = loop<2>("telescope", {0.5, 2.0});

 protected:
  void positions() override {
    arm.place();
    pendulum = arm.link("fore") * translate(0.8, 0, 0) * rotate_y(swing) * translate(0, 0, -0.3);
    const Frame foot = translate(-1, 0, -1.5);
    const auto p = telescope.solve([&](const auto& u) {
      const ExprVector end = (foot * rotate_y(-u[0]) * translate(u[1], 0, 0)).express_point({0, 0, 0});
      const ExprVector point = arm.link("upper").express_point({0.3, 0, 0.1});
      return std::array{end.x() - point.x(), end.z() - point.z()};
    });
    cylinder = foot * rotate_y(-p[0]) * translate(0.2, 0, 0);
    rod = foot * rotate_y(-p[0]) * translate(p[1], 0, 0) * translate(-0.2, 0, 0);
  }
  void forces() override {
    gravity();
    spring.apply(arm.link("fore"), {0.8, 0, 0}, Frame(translate(2, 0, 1)), {0, 0, 0});
  }
};

TEST(UrdfRobot, MixesWithBodiesAndLoopsWrittenByHand) {
  Mixed<ArmFromUrdf> loaded;
  Mixed<ArmByHand> by_hand;
  EXPECT_LT(largest_difference(loaded, by_hand), round_trip);
}

TEST(UrdfRobot, KeepsItsEnergyInFreeFlight) {
  class Falling : public System {
   public:
    UrdfRobot robot{*this, urdf_from_text(planar_arm), {.base = UrdfBase::floating, .initial = {{"b", 1.0}}}};
    Body& hull = body("hull", {4, 0.3, 0.4, 0.5});

   protected:
    void positions() override {
      robot.place(translate(0, 0, 10));
      hull = robot.link("ground");
    }
    void forces() override { gravity(); }
  } falling;
  State start = falling.initial_state();
  // It turns through the singular angle of its chart.
  start.qd << 1, 0.5, 2, 0.3, 5, -0.4, 6, -8;
  set_consistent_accelerations(falling, start);
  const EnergyBalance before = falling.compute_energy(start);
  RungeKutta integrator(falling, start, {.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12});
  bool has_changed_chart = false;
  integrator.advance(1, [&](const State& s) { has_changed_chart |= s.charts[0] != start.charts[0]; });
  const EnergyBalance after = falling.compute_energy(integrator.state());
  EXPECT_TRUE(has_changed_chart);
  // The local error times what a second of tumbling makes of it (AdaptiveOptions: up to 15).
  EXPECT_NEAR((after.kinetic + after.potential) / (before.kinetic + before.potential), 1, 15e-10);
}

TEST(UrdfRobot, ShowsWhatItsLinksLookLike) {
  const testing::TemporaryFolder folder;
  std::filesystem::create_directories(folder / "my_robot/urdf");
  std::filesystem::create_directories(folder / "my_robot/meshes");
  const std::string stl =
      "solid tip\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1000 0 0\nvertex 0 2000 0\n"
      "endloop\nendfacet\nendsolid\n";
  folder.write("my_robot/meshes/tip.stl", stl);
  const auto file = folder.write("my_robot/urdf/robot.urdf", R"(<robot name="looks">
    <material name="red"><color rgba="1 0 0 0.5"/></material>
    <link name="base"><visual><geometry><box size="1 2 3"/></geometry></visual></link>
    <joint name="j" type="continuous"> <parent link="base"/> <child link="arm"/> <origin xyz="0 0 1"/> </joint>
    <link name="arm">
      <inertial><origin xyz="0.5 0 0" rpy="0 0 1.5707963267948966"/> <mass value="1"/>
        <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
      <visual name="tube"><origin xyz="0.5 0.25 0"/> <geometry><cylinder radius="0.1" length="1"/></geometry>
        <material name="red"/></visual>
      <visual><geometry><sphere radius="0.2"/></geometry>
        <material name="blue"><color rgba="0 0.2 1 1"/></material></visual>
      <visual><geometry><sphere radius="0.3"/></geometry> <material name="none"><color rgba="0 0 0 0"/></material></visual>
    </link>
    <joint name="f" type="fixed"> <parent link="arm"/> <child link="tip"/> <origin xyz="1 0 0"/> </joint>
    <link name="tip">
      <visual><geometry><mesh filename="package://my_robot/meshes/tip.stl" scale="0.001 0.001 0.001"/></geometry></visual>
      <visual><geometry><mesh filename="../meshes/tip.dae"/></geometry></visual>
    </link>
  </robot>)");
  class Shown : public System {
   public:
    explicit Shown(const std::filesystem::path& path) : robot(*this, path, {.prefix = "my "}) {}
    UrdfRobot robot;

   protected:
    void positions() override { robot.place(); }
  } shown(file);
  const std::vector<visu::Item>& items = shown.robot.items();
  ASSERT_EQ(items.size(), 4u);
  EXPECT_EQ(items[0].frame, "my base");  // without mass, but seen: a body without mass
  EXPECT_EQ(shown.robot.body("base").mass(), 0);
  EXPECT_EQ(items[0].shape, visu::Shape::box);
  EXPECT_EQ(items[0].size, Vector3d(1, 2, 3));
  EXPECT_EQ(items[1].name, "my tube");
  EXPECT_EQ(items[1].shape, visu::Shape::cylinder);
  EXPECT_EQ(items[1].size.head(2), Eigen::Vector2d(0.1, 1));
  EXPECT_EQ(items[1].colour, "#ff0000");
  EXPECT_EQ(items[1].opacity, 0.5);
  // In the axes of the body, which are turned by 90 degrees about z; the axis of the cylinder stays vertical.
  EXPECT_LT((items[1].offset.position - Vector3d(0.25, 0, 0)).norm(), 1e-15);
  EXPECT_LT((items[1].offset.orientation * Vector3d::UnitY() - Vector3d::UnitZ()).norm(), 1e-15);
  EXPECT_EQ(items[2].name, "my arm (2)");
  EXPECT_EQ(items[2].shape, visu::Shape::sphere);
  EXPECT_EQ(items[2].size[0], 0.2);
  EXPECT_EQ(items[2].colour, "#0033ff");
  EXPECT_EQ(items[3].frame, "my arm");  // carried rigidly
  EXPECT_EQ(items[3].shape, visu::Shape::mesh);
  EXPECT_THAT(items[3].triangles, ElementsAre(0, 0, 0, 1, 0, 0, 0, 2, 0));
  EXPECT_LT((items[3].offset.position - Vector3d(0, -0.5, 0)).norm(), 1e-15);
  EXPECT_THAT(shown.robot.meshes_not_shown(), ElementsAre("../meshes/tip.dae"));
  Recorder recorder(shown, 0.1);
  recorder(shown.initial_state());
  visu::Scene scene = recorder.scene();
  scene.items = items;
  EXPECT_NO_THROW(visu::check(scene));
}

}  // namespace
}  // namespace easydyn
