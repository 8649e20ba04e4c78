#include "easydyn/urdf/urdf_model.hpp"

#include <console_bridge/console.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <locale>

#include "easydyn/error.hpp"
#include "tests/temporary_folder.hpp"

namespace easydyn {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::message_of;
using ::testing::StartsWith;

// Two links and a joint; each test below changes one thing of it.
const std::string sound = R"(<?xml version="1.0"?>
<robot name="sound">
  <link name="base"/>
  <link name="arm">
    <inertial>
      <origin xyz="0 0 0.5" rpy="0 0 0"/>
      <mass value="2.5"/>
      <inertia ixx="0.3" ixy="0" ixz="0" iyy="0.3" iyz="0" izz="0.1"/>
    </inertial>
    <visual>
      <geometry><cylinder radius="0.1" length="1"/></geometry>
      <material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>
    </visual>
  </link>
  <joint name="elbow" type="revolute">
    <parent link="base"/>
    <child link="arm"/>
    <axis xyz="0 3 4"/>
    <limit lower="-1" upper="1" effort="10" velocity="2"/>
    <dynamics damping="0.1" friction="0.2"/>
  </joint>
</robot>
)";

const char* const lone_joint = R"(<link name="hand"/>
  <joint name="wrist" type="continuous"><parent link="arm"/><child link="hand"/>MIMIC</joint>
</robot>)";

std::string changed(const std::string& from, const std::string& to) {
  std::string text = sound;
  const std::size_t at = text.find(from);
  if (from.empty() || at == std::string::npos) {
    ADD_FAILURE() << from << " does not occur";
    return text;
  }
  return text.replace(at, from.size(), to);
}

TEST(UrdfModel, HoldsWhatTheFileSays) {
  const UrdfModel model = urdf_from_text(sound);
  EXPECT_EQ(model.name, "sound");
  ASSERT_EQ(model.links.size(), 2u);
  ASSERT_EQ(model.joints.size(), 1u);
  EXPECT_EQ(model.links[1].inertia.mass, 2.5);
  EXPECT_EQ(model.links[1].inertial.position.z(), 0.5);
  EXPECT_EQ(model.links[1].line, 4);
  EXPECT_EQ(model.joints[0].line, 15);
  EXPECT_EQ(model.joints[0].parent, 0);
  EXPECT_EQ(model.joints[0].child, 1);
  EXPECT_LT((model.joints[0].axis - Eigen::Vector3d(0, 0.6, 0.8)).norm(), 1e-15);
  EXPECT_EQ(model.joints[0].damping, 0.1);
  EXPECT_EQ(model.joints[0].friction, 0.2);
}

struct Malformed {
  const char* what;
  std::string from, to;
  std::vector<std::string> says;  // place, element, reason
};

TEST(UrdfModel, RefusesAMalformedFileWithPlaceElementAndReason) {
  const auto with_wrist = [](const std::string& mimic) {
    std::string text = lone_joint;
    return text.replace(text.find("MIMIC"), 5, mimic);
  };
  const std::vector<Malformed> files = {
      {"mass no number",
       "value=\"2.5\"",
       "value=\"abc\"",
       {":7:13:", "link \"arm\"", "<mass> value = \"abc\", must be a number >= 0"}},
      {"mass with a unit",
       "value=\"2.5\"",
       "value=\"2.5 kg\"",
       {":7:", "link \"arm\"", "\"2.5 kg\", must be a number"}},
      {"mass with a comma",
       "value=\"2.5\"",
       "value=\"2,5\"",
       {":7:", "link \"arm\"", "\"2,5\", must be a number"}},
      {"mass not finite", "value=\"2.5\"", "value=\"nan\"", {":7:", "link \"arm\"", "must be a number"}},
      {"mass negative",
       "value=\"2.5\"",
       "value=\"-1\"",
       {":7:", "link \"arm\"", "\"-1\", must be a number >= 0"}},
      {"no mass", "<mass value=\"2.5\"/>", "", {":5:", "link \"arm\"", "<inertial> has no element <mass>"}},
      {"inertia without mass",
       "value=\"2.5\"",
       "value=\"0\"",
       {":8:", "link \"arm\"", "mass = 0 kg with moments of inertia, must be > 0"}},
      {"inertia incomplete", "iyz=\"0\" ", "", {":8:", "link \"arm\"", "<inertia> has no attribute iyz"}},
      {"inertia not positive",
       "ixy=\"0\"",
       "ixy=\"0.4\"",
       {":8:", "link \"arm\"", "principal moments of inertia -0.1, 0.1, 0.7 kg m^2, must be >= 0"}},
      {"triangle inequality",
       "izz=\"0.1\"",
       "izz=\"0.7\"",
       {":8:", "link \"arm\"", "0.3, 0.3, 0.7 kg m^2: the largest exceeds the sum of the others by 0.1"}},
      {"two masses",
       "<mass value=\"2.5\"/>",
       "<mass value=\"2\"/><mass value=\"3\"/>",
       {":7:", "link \"arm\"", "second element <mass>"}},
      {"inertial misspelt",
       "<link name=\"base\"/>",
       "<link name=\"base\"><inertail/></link>",
       {":3:", "link \"base\"", "<link> has the unknown element <inertail>, accepted: <inertial>, <visual>"}},
      {"XML not closed", "<inertial>", "<inertail>", {":5:", "not well-formed XML"}},
      {"element misspelt",
       "<mass value=\"2.5\"/>",
       "<mas value=\"2.5\"/>",
       {":7:", "link \"arm\"", "unknown element <mas>, accepted: <origin>, <mass>, <inertia>"}},
      {"attribute misspelt",
       "rpy=\"0 0 0\"",
       "rpx=\"0 0 0\"",
       {":6:", "link \"arm\"", "<origin> has the unknown attribute rpx, accepted: xyz, rpy"}},
      {"two numbers",
       "xyz=\"0 0 0.5\"",
       "xyz=\"0 0.5\"",
       {":6:", "link \"arm\"", "\"0 0.5\", must be 3 numbers"}},
      {"no shape",
       "<cylinder radius=\"0.1\" length=\"1\"/>",
       "",
       {":11:", "link \"arm\"", "<geometry> has 0 shapes"}},
      {"two shapes",
       "<cylinder radius=\"0.1\" length=\"1\"/>",
       "<sphere radius=\"1\"/><box size=\"1 1 1\"/>",
       {":11:", "link \"arm\"", "<geometry> has 2 shapes"}},
      {"shape unknown",
       "<cylinder radius=\"0.1\" length=\"1\"/>",
       "<cone radius=\"1\"/>",
       {":11:", "link \"arm\"", "unknown element <cone>"}},
      {"radius",
       "radius=\"0.1\"",
       "radius=\"0\"",
       {":11:", "link \"arm\"", "radius = \"0\", must be a number > 0"}},
      {"colour",
       "0.5 0.5 0.5 1",
       "128 128 128 255",
       {":12:", "link \"arm\"", "must be 4 numbers from 0 to 1"}},
      {"colour undefined",
       "<color rgba=\"0.5 0.5 0.5 1\"/>",
       "",
       {":12:", "link \"arm\"", "the material \"grey\" has no <color> or <texture>, here or before"}},
      {"axis zero", "0 3 4", "0 0 0", {":18:", "joint \"elbow\"", "the axis has length 0, must be > 0"}},
      {"axis without xyz", "xyz=\"0 3 4\"", "", {":18:", "joint \"elbow\"", "<axis> has no attribute xyz"}},
      {"limits",
       "lower=\"-1\"",
       "lower=\"2\"",
       {":19:", "joint \"elbow\"", "lower = 2 exceeds upper = 1, must be <= it"}},
      {"effort",
       "effort=\"10\"",
       "effort=\"-10\"",
       {":19:", "joint \"elbow\"", "effort = \"-10\", must be a number >= 0"}},
      {"no limits",
       "<limit lower=\"-1\" upper=\"1\" effort=\"10\" velocity=\"2\"/>",
       "",
       {":15:", "joint \"elbow\"", "a revolute joint must have an element <limit>"}},
      {"damping",
       "damping=\"0.1\"",
       "damping=\"-0.1\"",
       {":20:", "joint \"elbow\"", "damping = \"-0.1\", must be a number >= 0"}},
      {"friction of a plane",
       "type=\"revolute\"",
       "type=\"planar\"",
       {":20:", "joint \"elbow\"", "friction = 0.2 of a planar joint act on no single coordinate"}},
      {"joint type",
       "type=\"revolute\"",
       "type=\"hinge\"",
       {":15:", "joint \"elbow\"", "type = \"hinge\", must be revolute, continuous"}},
      {"no joint type",
       "type=\"revolute\"",
       "",
       {":15:", "joint \"elbow\"", "<joint> has no attribute type"}},
      {"parent missing",
       "<parent link=\"base\"/>",
       "",
       {":15:", "joint \"elbow\"", "<joint> has no element <parent>"}},
      {"parent unknown",
       "<parent link=\"base\"/>",
       "<parent link=\"bass\"/>",
       {":16:", "joint \"elbow\"", "the parent link \"bass\" does not exist"}},
      {"child unknown",
       "<child link=\"arm\"/>",
       "<child link=\"harm\"/>",
       {":17:", "joint \"elbow\"", "the child link \"harm\" does not exist"}},
      {"two roots",
       "<link name=\"base\"/>",
       "<link name=\"base\"/><link name=\"foot\"/>",
       {":3:", "link \"foot\"", "must be one root"}},
      {"two parents",
       "</robot>",
       "<joint name=\"again\" type=\"fixed\"><parent link=\"base\"/><child link=\"arm\"/></joint></robot>",
       {":22:", "joint \"again\"", "the link \"arm\" is the child of the joint \"elbow\", too (line 15)"}},
      {"loop",
       "</robot>",
       R"(<link name="a"/><link name="b"/>
       <joint name="ab" type="fixed"><parent link="a"/><child link="b"/></joint>
       <joint name="ba" type="fixed"><parent link="b"/><child link="a"/></joint></robot>)",
       {":22:", "link \"a\"", "closed loop"}},
      {"link twice",
       "<link name=\"base\"/>",
       "<link name=\"base\"/>\n<link name=\"arm\"/>",
       {":5:", "link \"arm\"", "the name is used twice, first in line 4"}},
      {"joint twice",
       "</robot>",
       R"(<link name="c"/><joint name="elbow" type="fixed"><parent link="arm"/><child link="c"/></joint></robot>)",
       {":22:", "joint \"elbow\"", "the name is used twice, first in line 15"}},
      {"mimic unknown",
       "</robot>",
       with_wrist("<mimic joint=\"knee\"/>"),
       {":23:", "joint \"wrist\"", "it mimics the joint \"knee\", which does not exist"}},
      {"mimic itself",
       "</robot>",
       with_wrist("<mimic joint=\"wrist\"/>"),
       {":23:", "joint \"wrist\"", "it mimics \"wrist\", which leads back to it"}},
      {"mimic in a circle",
       "<axis xyz=\"0 3 4\"/>",
       "<axis xyz=\"0 3 4\"/><mimic joint=\"elbow\"/>",
       {":18:", "joint \"elbow\"", "leads back to it"}},
      {"mimic number",
       "<axis xyz=\"0 3 4\"/>",
       "<mimic joint=\"elbow\" multiplier=\"two\"/>",
       {":18:", "joint \"elbow\"", "multiplier = \"two\", must be a number"}},
      {"nameless", "<link name=\"base\"/>", "<link/>", {":3:", "link", "<link> has no attribute name"}},
      {"no robot", "name=\"sound\"", "", {":2:", "<robot> has no attribute name"}},
      {"macro", "<link name=\"base\"/>", "<xacro:arm/>", {":3:", "run xacro first"}},
      {"version", "name=\"sound\"", "name=\"sound\" version=\"2.0\"", {":2:", "robot \"sound\"", "version"}},
  };
  for (const Malformed& file : files) {
    const std::string message =
        message_of<InputError>([&] { urdf_from_text(changed(file.from, file.to), "robot.urdf"); });
    EXPECT_THAT(message, StartsWith("robot.urdf:")) << file.what;
    for (const std::string& part : file.says) EXPECT_THAT(message, HasSubstr(part)) << file.what;
  }
}

TEST(UrdfModel, RefusesMimicsThatGoRound) {
  std::string text = changed("<axis xyz=\"0 3 4\"/>", "<mimic joint=\"wrist\"/>");
  std::string wrist = lone_joint;
  wrist.replace(wrist.find("MIMIC"), 5, "<mimic joint=\"elbow\"/>");
  text.replace(text.find("</robot>"), 8, wrist);
  EXPECT_THAT(message_of<InputError>([&] { urdf_from_text(text); }),
              AllOf(HasSubstr("joint \"elbow\""), HasSubstr("it mimics \"wrist\", which leads back to it")));
}

TEST(UrdfModel, RefusesWhatIsNoRobot) {
  const testing::TemporaryFolder folder;
  EXPECT_THAT(message_of<InputError>([&] { read_urdf(folder / "none.urdf"); }),
              HasSubstr("none.urdf: empty or cannot be read"));
  EXPECT_THAT(message_of<InputError>([&] { read_urdf(folder.path()); }),
              HasSubstr("empty or cannot be read"));
  const auto text = folder.write("text.urdf", "mass = 3\n");
  EXPECT_THAT(message_of<InputError>([&] { read_urdf(text); }), HasSubstr("text.urdf:"));
  const auto empty = folder.write("empty.urdf", "");
  EXPECT_THAT(message_of<InputError>([&] { read_urdf(empty); }),
              HasSubstr("empty.urdf: empty or cannot be read"));
  const auto cut = folder.write("cut.urdf", sound.substr(0, sound.size() / 2));
  EXPECT_THAT(message_of<InputError>([&] { read_urdf(cut); }), HasSubstr("not well-formed XML"));
  EXPECT_THAT(message_of<InputError>([] { urdf_from_text("<sdf version=\"1.6\"/>"); }),
              HasSubstr("the root element is <sdf>, must be <robot>"));
  EXPECT_THAT(message_of<InputError>([] { urdf_from_text("<robot name=\"empty\"/>"); }),
              HasSubstr("there is no <link>"));
}

TEST(UrdfModel, IgnoresExtensionsOfOtherPrograms) {
  const UrdfModel model = urdf_from_text(changed(
      "</robot>",
      R"(<transmission name="t"><type>simple</type></transmission> <gazebo reference="arm"><mu1>0.2</mu1></gazebo>
      <ros2_control name="r" type="system"/> </robot>)"));
  EXPECT_EQ(model.links.size(), 2u);
  EXPECT_NO_THROW(urdf_from_text(changed("<dynamics",
                                         "<drake:rotor_inertia value=\"1\"/><safety_controller "
                                         "k_velocity=\"1\"/><calibration rising=\"0\"/><dynamics")));
  EXPECT_NO_THROW(urdf_from_text(changed("</inertial>",
                                         "</inertial><collision name=\"c\"><geometry><box size=\"1 1 1\"/>"
                                         "</geometry></collision>")));
}

TEST(UrdfModel, ReadsNumbersInAnyLocale) {
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
  UrdfModel model;
  EXPECT_NO_THROW(model = urdf_from_text(sound));
  std::locale::global(before);
  ASSERT_EQ(model.links.size(), 2u);
  EXPECT_EQ(model.links[1].inertia.mass, 2.5);
  EXPECT_EQ(model.joints[0].limits->velocity, 2);
}

TEST(UrdfModel, LeavesTheMessagesOfOthersAlone) {
  class Kept : public console_bridge::OutputHandler {
   public:
    void log(const std::string&, console_bridge::LogLevel, const char*, int) override { ++count; }
    int count = 0;
  } kept;
  console_bridge::useOutputHandler(&kept);
  EXPECT_THROW(urdf_from_text(changed("name=\"sound\"", "name=\"sound\" version=\"2.0\"")), InputError);
  EXPECT_EQ(console_bridge::getOutputHandler(), &kept);
  EXPECT_EQ(kept.count, 0);
  console_bridge::noOutputHandler();
}

}  // namespace
}  // namespace easydyn
