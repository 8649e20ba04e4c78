#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "easydyn/error.hpp"
#include "vehicles/catalogue.hpp"

namespace {

using namespace easydyn::vehicles;
using testing::Contains;
using testing::HasSubstr;

std::vector<std::string> of_coach_with(const std::function<void(RailVehicle&)>& change) {
  RailVehicle coach = manchester_benchmark_1();
  change(coach);
  return unusual_values(coach);
}

TEST(UnusualValues, NameObjectValueAndRange) {
  EXPECT_THAT(
      of_coach_with([](RailVehicle& v) { v.bodies[0].mass = 70e3; }),
      Contains("vehicle \"Manchester benchmark 1\", body \"body\": mass = 70000 kg is unusual, mostly 8000 "
               "to 60000"));
  EXPECT_THAT(
      of_coach_with([](RailVehicle& v) { v.gears[1].frame_mass = 1500; }),
      Contains(HasSubstr("running gear \"rear bogie\": frame mass = 1500 kg is unusual, mostly 1700 to")));
  EXPECT_THAT(of_coach_with([](RailVehicle& v) { v.gears[0].wheel_pairs[1].mass = 2400; }),
              Contains(HasSubstr("wheel pair \"axle 2\": mass = 2400 kg")));
  EXPECT_THAT(of_coach_with([](RailVehicle& v) { v.gears[0].secondaries[0].stiffness = 7e6; }),
              Contains(HasSubstr("\"front bogie\": secondary stiffness = 7e+06 N/m")));
}

TEST(UnusualValues, GrantRubberPrimariesMoreStiffness) {
  const auto with = [](double stiffness, bool is_rubber) {
    return of_coach_with([=](RailVehicle& v) {
      for (RunningGear& gear : v.gears)
        for (WheelPair& pair : gear.wheel_pairs) {
          pair.primary_stiffness = stiffness;
          pair.has_rubber_primary = is_rubber;
        }
    });
  };
  // frame on 2 primaries of 20 MN/m and the secondary: sqrt(40.86e6 / 2615) / 2 pi = 19.9 Hz
  EXPECT_THAT(with(20e6, false),
              Contains(HasSubstr("primary stiffness = 2e+07 N/m is unusual, mostly 500000 to 5e+06")));
  EXPECT_THAT(with(20e6, false), Contains(HasSubstr("front bogie and rear bogie, bounce\" = 19.8")));
  EXPECT_THAT(with(20e6, true), testing::IsEmpty());
  EXPECT_THAT(with(50e6, true), Contains(HasSubstr("primary stiffness, rubber = 5e+07 N/m")));
}

TEST(UnusualValues, LookAtModesAndAtTheWheelPairOnTheTrack) {
  // body of 32 t on two secondaries of 0.1 MN/m: 0.39 Hz
  EXPECT_THAT(of_coach_with([](RailVehicle& v) {
                for (RunningGear& gear : v.gears) gear.secondaries[0].stiffness = 0.1e6;
              }),
              Contains(HasSubstr("frequency of the mode \"body, bounce\" = 0.39")));
  // sqrt(1e7 / 1813) / 2 pi = 11.82 Hz
  EXPECT_THAT(
      unusual_values(manchester_benchmark_1(), 1e7),
      Contains(HasSubstr("wheel pair \"axle 1\": frequency on a track of 1e+07 N/m = 11.82 Hz is unusual, "
                         "mostly 30 to 90")));
  EXPECT_THROW(unusual_values(manchester_benchmark_1(), 0), easydyn::ModelError);
}

}  // namespace
