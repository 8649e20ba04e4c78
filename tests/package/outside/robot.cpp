// A robot from a URDF text against the installed package: a pendulum of 2 kg at 0.5 m.
#include <easydyn/easydyn.hpp>
#include <easydyn/urdf/urdf_robot.hpp>

using namespace easydyn;

class Pendulum : public System {
  UrdfRobot robot{*this, urdf_from_text(R"(<robot name="pendulum">
    <link name="ground"/>
    <joint name="hinge" type="continuous"><parent link="ground"/><child link="rod"/></joint>
    <link name="rod"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
      <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0"/></inertial></link>
  </robot>)")};

  void positions() override { robot.place(); }
  void forces() override { gravity(); }
};

int main() {
  Pendulum pendulum;
  return pendulum.compute_mass_matrix(pendulum.initial_state())(0, 0) == 0.6 ? 0 : 1;
}
