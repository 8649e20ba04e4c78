#include "easydyn/visu/stl_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <limits>

#include "easydyn/error.hpp"
#include "easydyn/visu/scene.hpp"
#include "tests/temporary_folder.hpp"

using namespace easydyn;
using namespace easydyn::visu;
using easydyn::testing::message_of;
using easydyn::testing::TemporaryFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

namespace {

const char* const one_triangle =
    "solid tip\n  facet normal 0 0 1\n    outer loop\n      vertex 0 0 0\n      vertex +1 0 0\n      vertex "
    "0 2e0 3\n"
    "    endloop\n  endfacet\nendsolid tip\n";

// 80 bytes, the count, and for each triangle its normal, corners and two bytes.
std::string binary(const std::vector<float>& corners) {
  std::string bytes(80, 's');
  const auto append = [&](const auto& value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  };
  append(static_cast<std::uint32_t>(corners.size() / 9));
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (i % 9 == 0)
      for (int k = 0; k < 3; ++k) append(0.0f);
    append(corners[i]);
    if (i % 9 == 8) append(std::uint16_t{0});
  }
  return bytes;
}

}  // namespace

TEST(StlFile, IsReadAsTextAndAsBinary) {
  const TemporaryFolder folder;
  EXPECT_THAT(read_stl(folder.write("t.stl", one_triangle)), ElementsAre(0, 0, 0, 1, 0, 0, 0, 2, 3));
  const std::vector<float> corners = {0, 0, 0, 1, 0, 0, 0, 2, 3, 5, 0, 0, 1, 6, 0, 0, 2, 7};
  EXPECT_EQ(read_stl(folder.write("b.stl", binary(corners))), corners);
}

TEST(StlFile, IsScaledAndAMirroredOneKeepsItsOutside) {
  const TemporaryFolder folder;
  const auto file = folder.write("t.stl", one_triangle);
  EXPECT_THAT(read_stl(file, {2, 3, 10}), ElementsAre(0, 0, 0, 2, 0, 0, 0, 6, 30));
  EXPECT_THAT(read_stl(file, {-1, 1, 1}), ElementsAre(-1, 0, 0, 0, 0, 0, 0, 2, 3));
}

TEST(StlFile, IsRefusedWhereItIsDamaged) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& text) {
    const auto file = folder.write("x.stl", text);
    return message_of<InputError>([&] { read_stl(file); });
  };
  EXPECT_THAT(message_of<InputError>([&] { read_stl(folder / "none.stl"); }),
              HasSubstr("none.stl: empty or cannot be read"));
  EXPECT_THAT(refused(""), HasSubstr("x.stl: empty or cannot be read"));
  EXPECT_THAT(refused("text"), HasSubstr("neither a binary nor a text STL file"));
  EXPECT_THAT(refused("solid\nendsolid\n"), HasSubstr("0 corners of triangles"));
  EXPECT_THAT(refused("solid\nvertex 0 0 0\n"), HasSubstr("1 corners of triangles"));
  EXPECT_THAT(refused("solid\nvertex 0 zero 0\n"), HasSubstr("vertex 1: \"zero\" is no number"));
  EXPECT_THAT(refused(binary({0, 0, 0, 1, 0, 0, 0, 2, 3}).substr(0, 100)), HasSubstr("neither a binary"));
  EXPECT_THAT(refused(binary({0, 0, 0, 1, 0, 0, 0, 2, std::numeric_limits<float>::infinity()})),
              HasSubstr("triangle 1: inf is not finite"));
}

TEST(SceneMesh, IsCheckedAndReadsBack) {
  Scene scene;
  scene.name = "mesh";
  scene.time = Eigen::VectorXd::Zero(1);
  scene.items = {
      {.name = "tip", .frame = "", .shape = Shape::mesh, .triangles = {0, 0, 0, 1, 0, 0, 0, 2, 3}}};
  const Scene back = scene_from_json(to_json(scene));
  EXPECT_EQ(back.items[0].shape, Shape::mesh);
  EXPECT_EQ(back.items[0].triangles, scene.items[0].triangles);
  scene.items[0].triangles.pop_back();
  EXPECT_THAT(message_of<ModelError>([&] { check(scene); }),
              HasSubstr("\"tip\" has 8 numbers for triangles"));
  scene.items[0].shape = Shape::box;
  EXPECT_THAT(message_of<ModelError>([&] { check(scene); }), HasSubstr("must be 0: it is no mesh"));
}
