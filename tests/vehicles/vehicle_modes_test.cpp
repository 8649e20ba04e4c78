#include "vehicles/vehicle_modes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "vehicles/catalogue.hpp"
#include "vehicles/vehicle_tables.hpp"

namespace {

using namespace easydyn::vehicles;
using Part = VehicleMode::Part;

/// Pole of least size of M x.. + C x. + K x = 0 of two masses, upper half plane: mass m_1 on (k_1, d_1), m_2 on it by
/// (k_2, d_2).
std::complex<double> lowest_pole(double m_1, double k_1, double d_1, double m_2, double k_2, double d_2) {
  Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
  A.topRightCorner<2, 2>().setIdentity();
  A.row(2) << -(k_1 + k_2) / m_1, k_2 / m_1, -(d_1 + d_2) / m_1, d_2 / m_1;
  A.row(3) << k_2 / m_2, -k_2 / m_2, d_2 / m_2, -d_2 / m_2;
  std::complex<double> lowest(1e9, 0);
  for (const std::complex<double>& pole : Eigen::Vector4cd(A.eigenvalues()))
    if (pole.imag() >= 0 && std::abs(pole) < std::abs(lowest)) lowest = pole;
  return lowest;
}

TEST(VehicleModes, OfTheManchesterCoachAreThoseOfItsHalves) {
  const std::vector<VehicleMode> modes = compute_vehicle_modes(manchester_benchmark_1());
  // A symmetric car bounces as half of its body on one bogie frame, and pitches as J / a^2 of its body at each of its
  // ends, a = 9.5 m: half of it each. Bogies pitch alone: their secondaries stand at their centres.
  const std::complex<double> bounce = lowest_pole(2615, 4.8e6, 16e3, 16000, 0.86e6, 40e3);
  const std::complex<double> pitch = lowest_pole(2615, 4.8e6, 16e3, 1.97e6 / (9.5 * 9.5) / 2, 0.86e6, 40e3);
  ASSERT_EQ(modes[0].motion, "body, bounce");
  ASSERT_EQ(modes[1].motion, "body, pitch");
  // fourth-order differences of linear forces, steps of 1e-5: rounding 1e-7
  EXPECT_LT(std::abs(modes[0].pole - bounce), 1e-6 * std::abs(bounce));
  EXPECT_LT(std::abs(modes[1].pole - pitch), 1e-6 * std::abs(pitch));
  EXPECT_EQ(modes[0].part, Part::body);
  EXPECT_FALSE(modes[0].is_pitch);
  EXPECT_TRUE(modes[1].is_pitch);
  EXPECT_GT(modes[0].energy_share, 0.95);
  // frame pitch: 2 k_p (w / 2)^2 / J = 2 x 2.4e6 x 1.28^2 / 1476, twice
  const double frame_pitch = std::sqrt(2 * 2.4e6 * 1.28 * 1.28 / 1476) / (2 * std::numbers::pi);
  const auto found = std::ranges::find_if(
      modes, [](const VehicleMode& mode) { return mode.part == Part::frame && mode.is_pitch; });
  ASSERT_NE(found, modes.end());
  EXPECT_EQ(found->count, 2);
  EXPECT_EQ(found->motion, "front bogie and rear bogie, pitch");
  EXPECT_NEAR(found->frequency / frame_pitch, 1, 1e-6);
  // 6 coordinates, all of them oscillate
  int count = 0;
  for (const VehicleMode& mode : modes) count += mode.count;
  EXPECT_EQ(count, 6);
}

TEST(VehicleModes, GroupEqualCarsOfATrain) {
  const std::vector<VehicleMode> modes = compute_vehicle_modes(ice3_like());
  int count = 0;
  for (const VehicleMode& mode : modes) count += mode.count;
  EXPECT_EQ(count, 8 * 6);
  // 6 heavy and 2 light cars
  EXPECT_EQ(modes[0].count, 6);
  EXPECT_EQ(modes[0].motion, "car 1 body and 5 others, bounce");
  EXPECT_EQ(modes[1].count, 2);
  EXPECT_EQ(modes[1].motion, "car 4 body and car 5 body, bounce");
}

TEST(VehicleModes, OfEveryBundledVehicleAreStable) {
  for (const CatalogueEntry& entry : vehicle_catalogue())
    for (const VehicleMode& mode : compute_vehicle_modes(entry.make())) {
      EXPECT_LT(mode.pole.real(), 0) << entry.name << ", " << mode.motion;
      EXPECT_LE(mode.energy_share, 1 + 1e-12);
    }
}

TEST(VehicleTables, HoldTheMassBalanceOfTheCoach) {
  const RailVehicle coach = manchester_benchmark_1();
  const easydyn::visu::Table table = mass_balance_table(coach);
  // 32 000; 2 x 2615; 4 x 1813; 44 482 kg
  const std::vector<std::vector<std::string>> expected = {{"bodies", "1", "32.000", "71.9"},
                                                          {"bogie frames", "2", "5.230", "11.8"},
                                                          {"wheel pairs", "4", "7.252", "16.3"},
                                                          {"total", "", "44.482", "100.0"}};
  ASSERT_EQ(table.rows.size(), 5u);
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(table.rows[i], expected[i]);
  EXPECT_EQ(table.rows[4][0], "per axle");
  EXPECT_NEAR(compute_mass_balance(coach).per_axle(), 11120.5, 1e-9);
}

TEST(VehicleTables, HoldAxleLoadsAndModes) {
  const RailVehicle coach = manchester_benchmark_1();
  const easydyn::visu::Table loads = axle_load_table(coach, compute_axle_loads(coach));
  ASSERT_EQ(loads.rows.size(), 4u);
  // x = 9.5 + 1.28; 11120.5 x 9.81 N; less 1813 x 9.81 N
  EXPECT_EQ(loads.rows[0],
            (std::vector<std::string>{"axle 1", "front bogie", "10.780", "109.09", "11.120", "91.31"}));
  const easydyn::visu::Table modes = mode_table(compute_vehicle_modes(coach));
  EXPECT_EQ(modes.rows[0][3], "body, bounce");
  EXPECT_EQ(modes.rows[0].size(), modes.header.size());
}

}  // namespace
