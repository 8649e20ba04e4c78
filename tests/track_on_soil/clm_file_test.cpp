#include "track_on_soil/clm_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>
#include <limits>
#include <sstream>

#include "easydyn/error.hpp"
#include "soil/mobility_identity.hpp"
#include "tests/temporary_folder.hpp"
#include "tests/track_on_soil/small_sites.hpp"

namespace easydyn::track_on_soil {
namespace {

namespace fs = std::filesystem;
using easydyn::testing::half_space;
using easydyn::testing::layer_of;
using easydyn::testing::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

SiteClm example() {
  const std::string source = "C: fit to \"somewhere\" on C:\\disk";
  SiteClm clm;
  clm.layers = {layer_of(1.0 / 3, 109.1, 0.35, 1900, 0.03), half_space(270, 0.35, 0.02).layers[0]};
  constexpr double inf = std::numeric_limits<double>::infinity();
  clm.blocks = {{.name = "",
                 .x = {-inf, inf},
                 .y = {5, 5.4},
                 .z = {-4.1, 0},
                 .open = true,
                 .mirrored = true,
                 .material = {}},
                {.name = "",
                 .x = {-inf, 1.0 / 3},
                 .y = {-2, 2},
                 .z = {-1, 0},
                 .material = layer_of(0, 300, 0.3, 2000, 0.01)}};
  clm.damping_frequency = 20.1;
  clm.method = soil::element_method;
  clm.damping = soil::GroundDamping::maxwell_body;
  clm.row = {0.285, 2.5, 0.72};
  clm.lowest = 2;
  clm.highest = 50;
  clm.foundations = 9;
  track::ClmFit& fit = clm.fit;
  fit.clm = {{0.0, source}, {5.21e7 / 3, source}, {4.28e5, source}, {2.43e7 / 7, source}, {-1.07e5, source}};
  fit.frequency = Eigen::Vector3d(2, 20.0 / 3, 50);
  fit.ground_00 = Eigen::Vector3cd({1e-8 / 3, -1e-9}, {2e-8, -3e-9 / 7}, {1e-9, -1e-8});
  fit.ground_01 = 0.3 * fit.ground_00;
  fit.model_00 = 1.1 * fit.ground_00;
  fit.model_01 = 0.9 * fit.ground_01;
  fit.rms_00 = 0.1 / 3;
  fit.rms_01 = 0.2;
  fit.stiffness_margin = 3.1;
  fit.damping_margin = 0;
  fit.bounds = {"d_f + 4 d_c = 0", "m_f = 0"};
  fit.left_out = 0.27;
  fit.system = "chain of 9";
  return clm;
}

TEST(ClmFile, ComesBackAsItWas) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "site.clm.toml";
  const SiteClm written = example();
  write_clm(path, written);
  const SiteClm read = read_clm(path);
  EXPECT_EQ(read.layers.size(), 2u);
  EXPECT_EQ(read.layers[0].thickness, written.layers[0].thickness);
  EXPECT_EQ(read.layers[0].cp, written.layers[0].cp);
  EXPECT_TRUE(std::isinf(read.layers[1].thickness));
  EXPECT_EQ(read.damping_frequency, 20.1);
  soil::Site site;
  site.layers = written.layers;
  site.blocks = written.blocks;
  site.damping_frequency = 20.1;
  EXPECT_EQ(read.find_mismatch(site, written.row), "");  // the blocks bit by bit
  EXPECT_EQ(read.method, soil::element_method);
  EXPECT_EQ(read.damping, soil::GroundDamping::maxwell_body);
  EXPECT_EQ(read.revision, fit_revision);
  EXPECT_EQ(read.row, written.row);
  EXPECT_EQ(read.lowest, 2);
  EXPECT_EQ(read.highest, 50);
  EXPECT_EQ(read.foundations, 9);
  const track::Clm &a = read.fit.clm, &b = written.fit.clm;
  EXPECT_EQ(a.m_f.value, b.m_f.value);
  EXPECT_EQ(a.k_f.value, b.k_f.value);
  EXPECT_EQ(a.d_f.value, b.d_f.value);
  EXPECT_EQ(a.k_c.value, b.k_c.value);
  EXPECT_EQ(a.d_c.value, b.d_c.value);
  EXPECT_EQ(a.k_c.source, b.k_c.source);
  EXPECT_EQ(read.fit.frequency, written.fit.frequency);
  EXPECT_EQ(read.fit.ground_00, written.fit.ground_00);
  EXPECT_EQ(read.fit.ground_01, written.fit.ground_01);
  EXPECT_EQ(read.fit.model_00, written.fit.model_00);
  EXPECT_EQ(read.fit.model_01, written.fit.model_01);
  EXPECT_EQ(read.fit.rms_00, written.fit.rms_00);
  EXPECT_EQ(read.fit.rms_01, written.fit.rms_01);
  EXPECT_EQ(read.fit.stiffness_margin, 3.1);
  EXPECT_EQ(read.fit.damping_margin, 0);
  EXPECT_EQ(read.fit.bounds, written.fit.bounds);
  EXPECT_EQ(read.fit.left_out, 0.27);
  EXPECT_EQ(read.fit.system, "chain of 9");
  EXPECT_FALSE(fs::exists(path.string() + ".part"));
}

TEST(ClmFile, BelongsToGroundAndFootprints) {
  const SiteClm clm = example();
  soil::Site site;
  site.layers = clm.layers;
  site.blocks = clm.blocks;
  site.damping_frequency = 20.1;
  EXPECT_TRUE(clm.belongs_to(site, clm.row));
  site.blocks[0].name = "trench";
  site.layers[0].name = "another name";
  site.highest_frequency = 90;
  site.receivers = {{.name = "8 m", .position = {0, 8, 0}}};
  EXPECT_TRUE(clm.belongs_to(site, clm.row));
  EXPECT_FALSE(clm.belongs_to(site, {0.285, 2.5, 0.6}));
  const auto expect_other = [&](auto change) {
    soil::Site other = site;
    change(other);
    EXPECT_FALSE(clm.belongs_to(other, clm.row));
  };
  expect_other([](soil::Site& s) { s.layers[0].thickness += 1e-12; });
  expect_other([](soil::Site& s) { s.layers[0].density += 1; });
  expect_other([](soil::Site& s) { s.layers[1].cs += 1; });
  expect_other([](soil::Site& s) { s.layers[1].cp += 1; });
  expect_other([](soil::Site& s) { s.layers[1].damping += 0.01; });
  expect_other([](soil::Site& s) { s.damping_frequency = 21; });
  expect_other([](soil::Site& s) { s.layers.insert(s.layers.begin(), s.layers[0]); });
  expect_other([](soil::Site& s) { s.blocks.clear(); });
  expect_other([](soil::Site& s) { s.blocks[0].z[0] = -5; });
  expect_other([](soil::Site& s) { s.blocks[0].open = false; });
  expect_other([](soil::Site& s) { s.blocks[0].mirrored = false; });
  expect_other([](soil::Site& s) { s.blocks[1].material.cs += 1; });
}

TEST(ClmFile, HoldsForAConstantDampingRatioAndThisRevisionOfTheFitOnly) {
  soil::Site site;
  site.layers = example().layers;
  site.blocks = example().blocks;
  site.damping_frequency = 20.1;
  const auto find_mismatch = [&](auto change) {
    SiteClm clm = example();
    change(clm);
    return clm.find_mismatch(site, clm.row);
  };
  EXPECT_EQ(find_mismatch([](SiteClm& c) { c.damping = soil::GroundDamping::constant_q; }), "");
  EXPECT_EQ(find_mismatch([](SiteClm& c) { c.damping = soil::GroundDamping::none; }),
            "has the damping \"none\"");
  EXPECT_EQ(find_mismatch([](SiteClm& c) { c.damping = soil::GroundDamping::stiffness_proportional; }),
            "has the damping \"stiffness\"");
  EXPECT_THAT(find_mismatch([](SiteClm& c) { c.revision = fit_revision + 1; }), HasSubstr("of the fit, not"));
  EXPECT_EQ(find_mismatch([](SiteClm& c) { c.method = mixed_method; }), "");
  EXPECT_THAT(find_mismatch([](SiteClm& c) { c.method = "guess"; }), HasSubstr("unknown method \"guess\""));
}

TEST(ClmFile, KnowsTheBlocksOfFiniteElementsOnly) {
  SiteClm clm = example();
  EXPECT_TRUE(clm.knows_blocks());
  clm.method = soil::layered_method;
  EXPECT_FALSE(clm.knows_blocks());
}

TEST(ClmFile, OfAnEarlierFormatIsReadAndDoesNotHold) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "site.clm.toml";
  SiteClm clm = example();
  clm.blocks.clear();
  write_clm(path, clm);
  std::ostringstream written;
  written << std::ifstream(path).rdbuf();
  std::istringstream lines(written.str());
  std::ofstream earlier(path);
  for (std::string line; std::getline(lines, line);) {
    if (line == "format = 2") line = "format = 1";
    const auto is = [&](const char* key) { return line.rfind(key, 0) == 0; };
    if (!is("method = ") && !is("damping = \"") && !is("revision = ")) earlier << line << "\n";
  }
  earlier.close();
  soil::Site site;
  site.layers = clm.layers;
  site.damping_frequency = 20.1;
  EXPECT_TRUE(clm.belongs_to(site, clm.row));
  const SiteClm read = read_clm(path);
  EXPECT_EQ(read.fit.clm.k_f.value, clm.fit.clm.k_f.value);
  EXPECT_THAT(read.find_mismatch(site, clm.row), HasSubstr("is of revision 0 of the fit"));
}

TEST(ClmFile, LiesBesideTheSiteFile) {
  EXPECT_EQ(clm_file_of("examples/sites/tram.toml"), fs::path("examples/sites/tram.clm.toml"));
}

TEST(ClmFile, IsRefusedWhereItIsNotWhatItShouldBe) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "site.clm.toml";
  write_clm(path, example());
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  const auto expect_refusal = [&](const std::string& from, const std::string& to,
                                  const std::string& message) {
    std::string changed = text.str();
    const std::size_t at = changed.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    std::ofstream(path) << changed.replace(at, from.size(), to);
    EXPECT_THAT([&] { read_clm(path); }, ThrowsMessage<Error>(HasSubstr(message)));
  };
  expect_refusal("format = 2", "format = 3", "format = 3, must be");
  expect_refusal("damping = \"constant\"", "damping = \"some\"",
                 "damping = some, must be none, stiffness, constant");
  expect_refusal(fmt::format("revision = {}", fit_revision), "revision = -1", "revision = -1, must be");
  expect_refusal("d_c = -107000", "d_c = -108000",
                 "site.clm.toml: not passive: d_f + 4 d_c = 428000 + 4 x -108000");
  expect_refusal("d_f = 428000", "df = 428000", "unknown key \"df\"");
  expect_refusal("damping = 0.03", "damping = -0.03", "damping = -0.03, must be >= 0");
  expect_refusal("frequency = [2, ", "frequency = [", "3 and 3 values, must be 2, one per frequency");
  expect_refusal("[fit]", "[fit", "site.clm.toml:");
  EXPECT_THAT([&] { read_clm(folder.path() / "none.toml"); },
              ThrowsMessage<InputError>(HasSubstr("none.toml")));
  EXPECT_THAT([&] { write_clm(folder.path() / "none" / "site.clm.toml", example()); },
              ThrowsMessage<InputError>(HasSubstr("cannot be written")));
}

}  // namespace
}  // namespace easydyn::track_on_soil
