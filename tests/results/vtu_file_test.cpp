#include "easydyn/results/vtu_file.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "easydyn/error.hpp"
#include "tests/vtu_reader.hpp"

namespace easydyn::results {
namespace {

using easydyn::testing::message_of;
using easydyn::testing::read_vtu;
using easydyn::testing::read_whole_file;
using easydyn::testing::TemporaryFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Two squares side by side.
QuadMesh two_quads() {
  return {{0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0}, {0, 1, 4, 3, 1, 2, 5, 4}};
}
std::vector<float> ramp(std::size_t n, float factor) {
  std::vector<float> values(n);
  for (std::size_t i = 0; i < n; ++i) values[i] = factor * static_cast<float>(i);
  return values;
}

TEST(VtuFile, BringsBackMeshVectorsAndTime) {
  const TemporaryFolder folder;
  const QuadMesh mesh = two_quads();
  write_vtu(folder / "a.vtu", mesh, {{"velocity", ramp(18, 0.1f)}, {"a < b & \"c\"", ramp(18, -3e-30f)}},
            0.125);
  const auto content = read_vtu(folder / "a.vtu");
  EXPECT_EQ(content.points, 6u);
  EXPECT_EQ(content.cells, 2u);
  EXPECT_EQ(content.time, 0.125);
  EXPECT_EQ(content.values<float>("Points"), mesh.points);
  EXPECT_EQ(content.values<float>("velocity"), ramp(18, 0.1f));
  EXPECT_EQ(content.values<float>("a &lt; b &amp; &quot;c&quot;"), ramp(18, -3e-30f));
  EXPECT_EQ(content.values<std::int32_t>("connectivity"), mesh.quads);
  EXPECT_THAT(content.values<std::int32_t>("offsets"), ElementsAre(4, 8));
  EXPECT_THAT(content.values<std::uint8_t>("types"), ElementsAre(9, 9));  // VTK_QUAD
  EXPECT_EQ(folder.count(), 1);
}

TEST(VtuFile, HasTheSizeThatWasAnnounced) {
  const TemporaryFolder folder;
  for (const std::size_t columns : {2u, 3u, 50u, 301u}) {
    QuadMesh mesh;
    mesh.points = ramp(3 * 2 * columns, 1.0f);
    for (std::size_t i = 0; i + 1 < columns; ++i)
      for (const std::size_t point : {i, i + 1, columns + i + 1, columns + i})
        mesh.quads.push_back(static_cast<std::int32_t>(point));
    write_vtu(folder / "a.vtu", mesh, {{"velocity", mesh.points}, {"displacement", mesh.points}}, 1.0 / 3);
    EXPECT_NEAR(compute_vtu_size(2 * columns, columns - 1, 2),
                static_cast<double>(std::filesystem::file_size(folder / "a.vtu")), 1000);
  }
}

TEST(VtuFile, RefusesWhatIsNotFiniteAndLeavesNothing) {
  const TemporaryFolder folder;
  std::vector<float> broken = ramp(18, 1);
  broken[7] = std::nanf("");
  EXPECT_THAT(message_of<ModelError>([&] {
                write_vtu(folder / "a.vtu", two_quads(), {{"velocity", broken}}, 0);
              }),
              HasSubstr("velocity of point 2 is nan, must be finite"));
  EXPECT_THAT(message_of<ModelError>([&] {
                write_vtu(folder / "a.vtu", two_quads(), {{"velocity", {1, 2}}}, 0);
              }),
              HasSubstr("velocity has 2 numbers, must have 18"));
  EXPECT_EQ(folder.count(), 0);
  EXPECT_THAT(message_of<InputError>([&] { write_vtu(folder / "none/a.vtu", two_quads(), {}, 0); }),
              HasSubstr("a.vtu: cannot be written"));
}

TEST(PvdFile, ListsFilesWithTheirTimes) {
  const TemporaryFolder folder;
  write_pvd(folder / "a.pvd", {{0, "a/0.vtu"}, {0.1, "a&b/1.vtu"}});
  const auto elements = easydyn::testing::parse_xml(read_whole_file(folder / "a.pvd"));
  ASSERT_EQ(elements.size(), 4u);
  EXPECT_EQ(elements[0].attributes.at("type"), "Collection");
  EXPECT_EQ(elements[2].parent, "Collection");
  EXPECT_EQ(elements[2].attributes.at("file"), "a/0.vtu");
  EXPECT_EQ(elements[3].attributes.at("file"), "a&amp;b/1.vtu");
  EXPECT_EQ(std::stod(elements[3].attributes.at("timestep")), 0.1);
}

}  // namespace
}  // namespace easydyn::results
