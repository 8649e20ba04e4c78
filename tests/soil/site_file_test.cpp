#include "soil/site_file.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "easydyn/error.hpp"
#include "tests/temporary_folder.hpp"

namespace easydyn::soil {
namespace {

using easydyn::testing::message_of;
using easydyn::testing::TemporaryFolder;
using ::testing::AllOf;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;

// A correct file; the tests replace one line of it.
const std::string correct = R"(name = "Two layers"
source = "invented"

[[layer]]
name = "loam"
thickness = 2.0
density = 1800
damping = 0.03
cs = 150
nu = 0.33
source = "borehole 3"

[[layer]]
density = 2000
damping = 0.02
cs = 300
cp = 600

[[receiver]]
name = "8 m"
distance = 8

[[receiver]]
name = "deep"
position = [1, 2, -3]

[solver]
highest_frequency = 40
margin = 4

[loads]
taper_length = 6
)";

std::string replaced(const std::string& from, const std::string& to) {
  std::string text = correct;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

Site read(const std::string& text) {
  const TemporaryFolder folder;
  return read_site(folder.write("site.toml", text));
}

// The message without the folder: "site.toml:line:column: ..."
std::string fault_of(const std::string& text) {
  const std::string message = message_of<InputError>([&] { read(text); });
  return message.substr(std::min(message.size(), message.find("site.toml")));
}
std::string fault_of(const std::string& from, const std::string& to) {
  return fault_of(replaced(from, to));
}

TEST(SiteFile, BringsLayersReceiversAndSettings) {
  const Site site = read(correct);
  EXPECT_EQ(site.name, "Two layers");
  EXPECT_EQ(site.text, correct);
  ASSERT_EQ(site.layers.size(), 2u);
  EXPECT_EQ(site.layers[0].name, "loam");
  EXPECT_EQ(site.layers[0].thickness, 2);
  EXPECT_EQ(site.layers[0].density, 1800);
  EXPECT_EQ(site.layers[0].cs, 150);
  EXPECT_NEAR(site.layers[0].poisson_ratio(), 0.33, 1e-12);
  EXPECT_EQ(site.layers[0].damping, 0.03);
  EXPECT_EQ(site.layers[0].source, "borehole 3");
  EXPECT_TRUE(std::isinf(site.layers[1].thickness));
  EXPECT_EQ(site.layers[1].cp, 600);
  ASSERT_EQ(site.receivers.size(), 2u);
  EXPECT_EQ(site.receivers[0].name, "8 m");
  EXPECT_THAT(site.receivers[0].position, ElementsAre(0, 8, 0));
  EXPECT_THAT(site.receivers[1].position, ElementsAre(1, 2, -3));
  EXPECT_EQ(site.highest_frequency, 40);
  EXPECT_EQ(site.margin, 4);
  EXPECT_EQ(site.taper_length, 6);
  EXPECT_EQ(site.points_per_wavelength, Site().points_per_wavelength);
  EXPECT_EQ(site.decay_time, Site().decay_time);
}

TEST(SiteFile, TurnsYoungsModulusIntoWaveSpeeds) {
  const Site site = read(replaced("cs = 150", "E = 61e6"));
  const Layer& layer = site.layers[0];
  // E = mu (3 lambda + 2 mu) / (lambda + mu)
  const double mu = layer.shear_modulus(), lambda = layer.lame_lambda();
  EXPECT_NEAR(mu * (3 * lambda + 2 * mu) / (lambda + mu), 61e6, 1);
  EXPECT_NEAR(layer.poisson_ratio(), 0.33, 1e-12);
}

TEST(SiteFile, NeedsNoNameAndNoSettings) {
  const Site site = read(
      "[[layer]]\ndensity = 2000\ndamping = 0\ncs = 300\nnu = 0\n[[receiver]]\nname = \"a\"\ndistance = "
      "-8\n");
  EXPECT_EQ(site.name, "site");
  EXPECT_NEAR(site.layers[0].cp, 300 * std::sqrt(2), 1e-9);
  EXPECT_EQ(site.receivers[0].position[1], -8);
  EXPECT_EQ(site.highest_frequency, Site().highest_frequency);
}

TEST(SiteFile, PlacesASurfaceReceiverByTwoCoordinates) {
  EXPECT_THAT(read(replaced("[1, 2, -3]", "[1.5, 2]")).receivers[1].position, ElementsAre(1.5, 2, 0));
}

const std::string two_blocks = R"([[block]]
name = "trench"
y = [5, 6]
z = [-4, 0]
open = true
mirrored = true

[[block]]
x = [-inf, 2.5]
z = [-3, -2]
density = 2300
damping = 0.01
cs = 900
nu = 0.2
source = "drawing 7"

[[receiver]]
name = "8 m")";

TEST(SiteFile, BringsBlocks) {
  const Site site = read(replaced("[[receiver]]\nname = \"8 m\"", two_blocks));
  ASSERT_EQ(site.blocks.size(), 2u);
  const Block &trench = site.blocks[0], &slab = site.blocks[1];
  EXPECT_EQ(trench.name, "trench");
  EXPECT_TRUE(trench.open);
  EXPECT_TRUE(trench.mirrored);
  EXPECT_EQ(trench.x[0], -INFINITY);
  EXPECT_EQ(trench.x[1], INFINITY);
  EXPECT_THAT(trench.y, ElementsAre(5, 6));
  EXPECT_THAT(trench.z, ElementsAre(-4, 0));
  EXPECT_FALSE(slab.open);
  EXPECT_FALSE(slab.mirrored);
  EXPECT_THAT(slab.x, ElementsAre(-INFINITY, 2.5));
  EXPECT_EQ(slab.y[1], INFINITY);
  EXPECT_EQ(slab.material.density, 2300);
  EXPECT_EQ(slab.material.cs, 900);
  EXPECT_NEAR(slab.material.poisson_ratio(), 0.2, 1e-12);
  EXPECT_EQ(slab.material.damping, 0.01);
  EXPECT_EQ(slab.material.source, "drawing 7");
}

TEST(SiteFileFault, IsABlockThatCannotBe) {
  const auto fault = [](const std::string& from, const std::string& to) {
    std::string text = replaced("[[receiver]]\nname = \"8 m\"", two_blocks);
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return fault_of(text.replace(at, from.size(), to));
  };
  EXPECT_EQ(fault("y = [5, 6]", "y = [6, 5]"),
            "site.toml:21:5: block \"trench\": y = 6..5 m, must be ascending");
  EXPECT_EQ(fault("z = [-4, 0]", "z = [-inf, 0]"),
            "site.toml:22:5: block \"trench\": z = -inf..0 m, must be finite and ascending");
  EXPECT_THAT(fault("z = [-4, 0]", "z = [-4, 1]"), HasSubstr("z = -4..1 m, must be <= 0"));
  EXPECT_THAT(fault("y = [5, 6]", "y = [-5, 6]"), HasSubstr("y = -5..6 m contains y = 0"));
  EXPECT_THAT(fault("y = [5, 6]", "y = 5"), HasSubstr("y must be an array of two numbers [m]"));
  EXPECT_THAT(fault("open = true", "open = 1"), EndsWith("open is a number, must be true or false"));
  EXPECT_THAT(fault("open = true", "open = true\ncs = 100"), HasSubstr("both open = true and cs"));
  EXPECT_THAT(fault("density = 2300\n", ""), EndsWith("block 2: \"density\" is missing"));
  EXPECT_THAT(fault("z = [-3, -2]\n", ""), EndsWith("block 2: \"z\" is missing"));
  EXPECT_THAT(fault("cs = 900", "cs = -900"), EndsWith("block 2: cs = -900 m/s, must be > 0"));
  EXPECT_THAT(fault("open = true", "opened = true"), HasSubstr("did you mean \"open\"?"));
}

std::string with(const std::string& more) {
  return correct + more;
}

TEST(SiteFile, SpreadsReceiversOverALine) {
  Site site = read(with("[[receiver_line]]\nname = \"A\"\nfrom = [0, 5]\nto = [0, 11]\nspacing = 2\n"));
  ASSERT_EQ(site.receivers.size(), 6u);
  EXPECT_EQ(site.receivers[1].group, "");
  const char* const names[] = {"A (0, 5, 0)", "A (0, 7, 0)", "A (0, 9, 0)", "A (0, 11, 0)"};
  for (int i = 0; i < 4; ++i) {
    const Receiver& receiver = site.receivers[static_cast<std::size_t>(2 + i)];
    EXPECT_EQ(receiver.name, names[i]);
    EXPECT_EQ(receiver.group, "A");
    EXPECT_THAT(receiver.position, ElementsAre(0, 5 + 2 * i, 0));
  }
  // Down a borehole, by number; 0.1 does not become 0.30000000000000004.
  site = read(with("[[receiver_line]]\nfrom = [1, 2, 0]\nto = [1, 2, -0.4]\ncount = 5\n"));
  ASSERT_EQ(site.receivers.size(), 7u);
  EXPECT_EQ(site.receivers[2].name, "receiver_line 1 (1, 2, 0)");
  EXPECT_EQ(site.receivers[5].name, "receiver_line 1 (1, 2, -0.3)");
  EXPECT_EQ(site.receivers[6].position[2], -0.4);
}

TEST(SiteFile, SpreadsReceiversOverAGrid) {
  Site site = read(
      with("[[receiver_grid]]\nname = \"G\"\nfrom = [-1, 5, -2]\nto = [1, 8, 0]\nspacing = [1, 3, 2]\n"));
  ASSERT_EQ(site.receivers.size(), 2u + 3 * 2 * 2);
  EXPECT_EQ(site.receivers[2].name, "G (-1, 5, -2)");
  EXPECT_EQ(site.receivers[3].name, "G (0, 5, -2)");
  EXPECT_EQ(site.receivers[5].name, "G (-1, 8, -2)");
  EXPECT_EQ(site.receivers[13].name, "G (1, 8, 0)");
  EXPECT_EQ(site.receivers[13].group, "G");
  site = read(with("[[receiver_grid]]\nfrom = [0, 5]\nto = [0, 8]\ncount = [1, 4]\n"));
  EXPECT_EQ(site.receivers.size(), 6u);
  EXPECT_EQ(site.receivers[3].name, "receiver_grid 1 (0, 6, 0)");
}

TEST(SiteFile, NeedsNoSingleReceiver) {
  std::string text = correct;
  const std::size_t from = text.find("[[receiver]]"), to = text.find("[solver]");
  text.erase(from, to - from);
  EXPECT_EQ(read(text + "[[receiver_line]]\nfrom = [0, 5]\nto = [0, 8]\ncount = 2\n").receivers.size(), 2u);
  EXPECT_THAT(fault_of(text), HasSubstr("no receiver"));
}

TEST(SiteFile, BringsSnapshots) {
  const Site site =
      read(with("[[snapshot]]\nz = 0\nstep = 0.01\n[[snapshot]]\nx = -1.5\nstep = 0.02\nbegin = 0.1\nend "
                "= 0.5\n[[snapshot]]\nname = \"cut\"\ny = 3\nstep = 1\n"));
  ASSERT_EQ(site.snapshots.size(), 3u);
  EXPECT_EQ(site.snapshots[0].name, "surface");
  EXPECT_EQ(site.snapshots[0].axis, 2);
  EXPECT_EQ(site.snapshots[0].step, 0.01);
  EXPECT_TRUE(std::isinf(site.snapshots[0].begin) && std::isinf(site.snapshots[0].end));
  EXPECT_EQ(site.snapshots[1].name, "x=-1.5");
  EXPECT_EQ(site.snapshots[1].axis, 0);
  EXPECT_EQ(site.snapshots[1].place, -1.5);
  EXPECT_EQ(site.snapshots[1].begin, 0.1);
  EXPECT_EQ(site.snapshots[1].end, 0.5);
  EXPECT_EQ(site.snapshots[2].name, "cut");
  EXPECT_EQ(site.snapshots[2].axis, 1);
}

TEST(SiteFileFault, IsALineOfReceiversThatCannotBe) {
  const auto line = [](const std::string& rest) { return fault_of(with("[[receiver_line]]\n" + rest)); };
  EXPECT_EQ(line("name = \"A\"\nfrom = [0, 5]\nto = [0, 11]\nspacing = 4\n"),
            "site.toml:37:11: receiver_line \"A\": spacing = 4 m does not divide the 6 m, must be e.g. 3");
  EXPECT_EQ(line("from = [0, 5]\nto = [0, 11]\nspacing = -1\n"),
            "site.toml:36:11: receiver_line 1: spacing = -1 m, must be > 0");
  EXPECT_THAT(line("from = [0, 5]\nto = [0, 11]\nspacing = 1e-6\n"),
              HasSubstr("spacing = 1e-06 m gives 6e+06 receivers over 6 m, must be at most 100000"));
  EXPECT_EQ(line("from = [0, 5]\nto = [0, 11]\ncount = 1\n"),
            "site.toml:36:9: receiver_line 1: count = 1, must be a whole number, >= 2 and <= 100000");
  EXPECT_THAT(line("from = [0, 5]\nto = [0, 11]\ncount = 2.5\n"), HasSubstr("count = 2.5, must be a whole"));
  EXPECT_THAT(line("from = [0, 5]\nto = [0, 11]\n"), EndsWith("give count or spacing"));
  EXPECT_THAT(line("from = [0, 5]\nto = [0, 11]\ncount = 3\nspacing = 3\n"),
              EndsWith("both count and spacing are given, must be one of them"));
  EXPECT_THAT(line("from = [0, 5]\nto = [0, 5]\ncount = 3\n"), EndsWith("must have a length"));
  EXPECT_THAT(line("from = [0, 5, 1]\nto = [0, 5]\ncount = 3\n"),
              HasSubstr("34:8: receiver_line 1: z = 1 m, must be <= 0"));
  EXPECT_THAT(line("from = [0]\nto = [0, 5]\ncount = 3\n"), HasSubstr("from has 1 numbers, must have 2"));
  EXPECT_THAT(line("from = [0, 5]\nuntil = [0, 5]\ncount = 3\n"), HasSubstr("unknown key \"until\""));
  EXPECT_THAT(line("name = \"A\"\nfrom = [0, 5]\nto = [0, 7]\ncount = 2\n[[receiver_line]]\nname = \"A\"\n"
                   "from = [0, 7]\nto = [0, 9]\ncount = 2\n"),
              HasSubstr("39:8: receiver_line \"A\": a receiver \"A (0, 7, 0)\" is there already"));
}

TEST(SiteFileFault, IsAGridOfReceiversThatCannotBe) {
  const auto grid = [](const std::string& rest) { return fault_of(with("[[receiver_grid]]\n" + rest)); };
  EXPECT_EQ(grid("from = [0, 5]\nto = [4, 11]\nspacing = [3, 3]\n"),
            "site.toml:36:11: receiver_grid 1: spacing[0] = 3 m does not divide the 4 m, must be e.g. 4");
  EXPECT_THAT(grid("from = [0, 5]\nto = [4, 11]\nspacing = [2, 0]\n"),
              EndsWith("spacing[1] = 0 m, must be > 0"));
  EXPECT_THAT(grid("from = [0, 5]\nto = [4, 11]\ncount = [2]\n"),
              EndsWith("count has 1 numbers, must have 2: one for each of from"));
  EXPECT_THAT(grid("from = [0, 5]\nto = [0, 11]\ncount = [2, 2]\n"),
              EndsWith("count[0] = 2 where from and to are the same, must be 1"));
  EXPECT_THAT(grid("from = [0, 5]\nto = [4, 11]\ncount = [1000, 1000]\n"),
              EndsWith("count gives 1000000 receivers, must be at most 100000"));
  EXPECT_THAT(grid("from = [0, 5]\nto = [4, 11, -1]\ncount = [2, 2]\n"),
              HasSubstr("as many numbers as from"));
}

TEST(SiteFileFault, IsASnapshotThatCannotBe) {
  const auto snapshot = [](const std::string& rest) { return fault_of(with("[[snapshot]]\n" + rest)); };
  EXPECT_EQ(snapshot("step = 0.1\n"),
            "site.toml:33:1: snapshot 1: no plane: give x, y or z (z = 0 is the surface)");
  EXPECT_THAT(snapshot("x = 1\ny = 1\nstep = 0.1\n"), EndsWith("must be one of them"));
  EXPECT_EQ(snapshot("z = 1\nstep = 0.1\n"), "site.toml:34:5: snapshot 1: z = 1 m, must be <= 0");
  EXPECT_EQ(snapshot("z = 0\nstep = 0\n"), "site.toml:35:8: snapshot \"surface\": step = 0 s, must be > 0");
  EXPECT_THAT(snapshot("z = 0\n"), EndsWith("snapshot \"surface\": \"step\" is missing"));
  EXPECT_THAT(snapshot("z = 0\nstep = 1\nbegin = 2\nend = 1\n"),
              EndsWith("end = 1 s, must be > begin = 2 s"));
  EXPECT_THAT(snapshot("name = \"../a\"\nz = 0\nstep = 1\n"), HasSubstr("34:8: snapshot 1: name = \"../a\""));
  EXPECT_THAT(snapshot("z = 0\nstep = 1\n[[snapshot]]\nz = 0\nstep = 1\n"), HasSubstr("name appears twice"));
}

TEST(SiteFileFault, NamesFileLineColumnObjectKeyValueAndRange) {
  EXPECT_EQ(fault_of("cs = 150", "cs = -150"), "site.toml:9:6: layer \"loam\": cs = -150 m/s, must be > 0");
  EXPECT_EQ(fault_of("density = 2000", "density = -2e3"),
            "site.toml:14:11: layer 2: density = -2000 kg/m3, must be > 0");
  EXPECT_EQ(fault_of("cs = 150", "E = -61e6"),
            "site.toml:9:5: layer \"loam\": E = -61000000 Pa, must be > 0");
  EXPECT_EQ(fault_of("thickness = 2.0", "thickness = 0"),
            "site.toml:6:13: layer \"loam\": thickness = 0 m, must be > 0");
  EXPECT_EQ(fault_of("nu = 0.33", "nu = 0.5"),
            "site.toml:10:6: layer \"loam\": nu = 0.5, must be >= 0 and <= 0.4995");
  EXPECT_EQ(fault_of("nu = 0.33", "nu = -0.1"),
            "site.toml:10:6: layer \"loam\": nu = -0.1, must be >= 0 and <= 0.4995");
  EXPECT_EQ(fault_of("damping = 0.03", "damping = 0.2"),
            "site.toml:8:11: layer \"loam\": damping = 0.2, must be >= 0 and < 0.2");
  EXPECT_EQ(fault_of("highest_frequency = 40", "highest_frequency = 0"),
            "site.toml:28:21: [solver]: highest_frequency = 0 Hz, must be > 0");
  EXPECT_EQ(fault_of("margin = 4", "points_per_wavelength = 3"),
            "site.toml:29:25: [solver]: points_per_wavelength = 3, must be >= 4 and <= 50");
  EXPECT_EQ(fault_of("taper_length = 6", "taper_length = -6"),
            "site.toml:32:16: [loads]: taper_length = -6 m, must be >= 0");
}

TEST(SiteFileFault, IsANumberThatIsNotFinite) {
  EXPECT_EQ(fault_of("density = 1800", "density = nan"),
            "site.toml:7:11: layer \"loam\": density = nan kg/m3, must be a finite number, > 0");
  EXPECT_EQ(fault_of("thickness = 2.0", "thickness = inf"),
            "site.toml:6:13: layer \"loam\": thickness = inf m, must be a finite number, > 0");
  EXPECT_EQ(fault_of("distance = 8", "distance = nan"),
            "site.toml:21:12: receiver \"8 m\": distance = nan m, must be finite");
  EXPECT_EQ(fault_of("[1, 2, -3]", "[1, -inf, 0]"),
            "site.toml:25:16: receiver \"deep\": position[1] = -inf m, must be finite");
}

TEST(SiteFileFault, IsAnUnknownKeyWithTheNearestKnownOne) {
  EXPECT_EQ(fault_of("thickness = 2.0", "thicknes = 2.0"),
            "site.toml:6:1: layer 1: unknown key \"thicknes\", did you mean \"thickness\"?");
  EXPECT_EQ(fault_of("highest_frequency", "frequency_highest"),
            "site.toml:28:1: [solver]: unknown key \"frequency_highest\", known are highest_frequency, "
            "damping_frequency, points_per_wavelength, margin");
  EXPECT_EQ(fault_of("[solver]", "[slover]"),
            "site.toml:27:2: unknown key \"slover\", did you mean \"solver\"?");
  EXPECT_EQ(fault_of("taper_length", "taper_lenght"),
            "site.toml:32:1: [loads]: unknown key \"taper_lenght\", did you mean \"taper_length\"?");
  EXPECT_EQ(fault_of("name = \"deep\"", "nmae = \"deep\""),
            "site.toml:24:1: receiver 2: unknown key \"nmae\", did you mean \"name\"?");
}

TEST(SiteFileFault, IsAWrongType) {
  EXPECT_EQ(fault_of("density = 1800", "density = \"1800\""),
            "site.toml:7:11: layer \"loam\": density is a string, must be a number");
  EXPECT_EQ(fault_of("name = \"loam\"", "name = 7"),
            "site.toml:5:8: layer 1: name is a number, must be a string");
  EXPECT_EQ(fault_of("position = [1, 2, -3]", "position = 3"),
            "site.toml:25:12: receiver \"deep\": position is a number, must be an array of numbers");
  EXPECT_EQ(fault_of("[1, 2, -3]", "[1, \"2\", -3]"),
            "site.toml:25:16: receiver \"deep\": position[1] is a string, must be a number");
  EXPECT_THAT(fault_of("layer = 3\n[[receiver]]\nname = \"a\"\ndistance = 1\n"),
              EndsWith("layer is a number, must be [[layer]]"));
  EXPECT_THAT(fault_of("[layer]\ncs = 3\n"), EndsWith("layer is a table, must be [[layer]]"));
}

TEST(SiteFileFault, IsAMissingOrContradictingStiffness) {
  EXPECT_EQ(fault_of("cs = 150\n", "\n"),
            "site.toml:4:1: layer \"loam\": no stiffness: give cs with cp or nu, or E with nu");
  EXPECT_THAT(fault_of("cs = 150\n", "cs = 150\nE = 1e8\n"),
              EndsWith("both E and cs are given, must be one of them"));
  EXPECT_THAT(fault_of("cs = 150\n", "E = 1e8\ncp = 300\n"),
              EndsWith("both E and cp are given, must be E with nu"));
  EXPECT_THAT(fault_of("cs = 150\n", "cs = 150\ncp = 300\n"),
              EndsWith("both cp and nu are given, must be one of them"));
  EXPECT_THAT(fault_of("nu = 0.33\n", "\n"), EndsWith("no compression wave speed: give cp or nu beside cs"));
  EXPECT_THAT(fault_of("cs = 150\nnu = 0.33\n", "E = 1e8\n"), EndsWith("layer \"loam\": \"nu\" is missing"));
  EXPECT_THAT(fault_of("cp = 600", "cp = 400"),
              AllOf(HasSubstr("site.toml:17:6: layer 2: cp = 400 m/s, must be >= 424.264 and <= 9491.58"),
                    HasSubstr("cs = 300 m/s")));
  EXPECT_THAT(fault_of("cp = 600", "cp = 9600"), HasSubstr("cp = 9600 m/s"));
}

TEST(SiteFileFault, IsAMissingPart) {
  EXPECT_EQ(fault_of("thickness = 2.0\n", ""),
            "site.toml:4:1: layer \"loam\": \"thickness\" is missing: only the last layer, the half-space, "
            "has none");
  EXPECT_THAT(fault_of("density = 2000", "thickness = 3\ndensity = 2000"),
              EndsWith("layer 2: the last layer is the half-space, must have no thickness"));
  EXPECT_THAT(fault_of("damping = 0.03\n", ""), EndsWith("layer \"loam\": \"damping\" is missing"));
  EXPECT_THAT(fault_of("[[receiver]]\nname = \"a\"\ndistance = 1\n"), HasSubstr("no layer"));
  EXPECT_THAT(fault_of("[[layer]]\ndensity = 2000\ndamping = 0\ncs = 300\nnu = 0\n"),
              HasSubstr("no receiver"));
  EXPECT_THAT(fault_of(""), HasSubstr("no layer"));
}

TEST(SiteFileFault, IsAReceiverOutOfPlace) {
  EXPECT_EQ(fault_of("[1, 2, -3]", "[1, 2, 3]"),
            "site.toml:25:12: receiver \"deep\": z = 3 m, must be <= 0 (0 is the surface)");
  EXPECT_EQ(fault_of("name = \"deep\"", "name = \"8 m\""),
            "site.toml:24:8: receiver \"8 m\": the name appears twice");
  EXPECT_THAT(fault_of("name = \"deep\"\n", ""), EndsWith("receiver 2: \"name\" is missing"));
  EXPECT_THAT(fault_of("name = \"deep\"", "name = \"\""), EndsWith("receiver 2: name is empty"));
  EXPECT_THAT(fault_of("[1, 2, -3]", "[1]"),
              EndsWith("position has 1 numbers, must have 2 (x, y) or 3 (x, y, z)"));
  EXPECT_THAT(fault_of("distance = 8\n", ""), EndsWith("no place: give position = [x, y, z] or distance"));
  EXPECT_THAT(fault_of("distance = 8\n", "distance = 8\nposition = [1, 2]\n"),
              HasSubstr("both position and distance"));
}

TEST(SiteFileFault, IsTextThatIsNoToml) {
  EXPECT_THAT(fault_of("cs = 150", "cs = = 150"), HasSubstr("site.toml:9:6: "));
  EXPECT_THAT(fault_of("cs = 150", "density = 150"), HasSubstr("site.toml:9:"));  // the key a second time
}

TEST(SiteFileFault, IsAFileThatIsNotThere) {
  const TemporaryFolder folder;
  EXPECT_THAT(message_of<InputError>([&] { read_site(folder / "none.toml"); }),
              HasSubstr("none.toml: cannot be read"));
  EXPECT_THROW(read_site(folder.path()), InputError);
}

}  // namespace
}  // namespace easydyn::soil
