// The program `soil` from outside: what it prints, writes and returns.

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "soil/layered/layered_prediction.hpp"
#include "soil/surface_loads.hpp"
#include "soil/vibrations.hpp"
#include "tests/temporary_folder.hpp"

namespace easydyn::soil {
namespace {

using easydyn::testing::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

// A ground that is cheap to compute: long waves, two receivers.
const std::string tiny_site = R"(name = "tiny"
[[layer]]
name = "loam"
thickness = 9
density = 1800
damping = 0.03
cs = 200
nu = 0.33
[[layer]]
density = 2000
damping = 0.02
cs = 300
nu = 0.33
[[receiver]]
name = "10 m"
distance = 10
[[receiver]]
name = "20 m"
distance = 20
[solver]
highest_frequency = 10
damping_frequency = 5
points_per_wavelength = 4
margin = 0
[loads]
taper_length = 0
decay_time = 0.2
)";

// One footprint that is pressed once, for 0.4 s.
void write_tiny_loads(const std::filesystem::path& path) {
  SurfaceLoads loads;
  loads.time = Eigen::VectorXd::LinSpaced(121, 0, 0.6);
  loads.footprints = {{0, 0, 2, 2.5}};
  loads.force =
      1e4 * (std::numbers::pi * ((loads.time.array() - 0.1) / 0.4).min(1).max(0)).sin().square().matrix();
  write_surface_loads(path, loads, {.program = "test"});
}

struct Outcome {
  int status = -1;
  std::string out, err;
};

class SoilProgram : public ::testing::Test {
 protected:
  SoilProgram() { write_tiny_loads(folder_ / "loads.h5"); }

  Outcome call(const std::string& arguments) {
    const std::string out = (folder_ / "stdout").string(), err = (folder_ / "stderr").string();
    const int status =
        std::system((std::string(SOIL_PROGRAM) + " " + arguments + " >" + out + " 2>" + err).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, testing::read_whole_file(out),
            testing::read_whole_file(err)};
  }

  // `soil run` on a site file with this text.
  Outcome run(const std::string& site, const std::string& options = "") {
    folder_.write("site.toml", site);
    return call("run " + (folder_ / "site.toml").string() + " " + (folder_ / "loads.h5").string() +
                " --output " + (folder_ / "out").string() + " " + options);
  }
  Outcome run_replaced(const std::string& from, const std::string& to, const std::string& options = "") {
    std::string site = tiny_site;
    const std::size_t at = site.find(from);
    EXPECT_NE(at, std::string::npos);
    return run(site.replace(at, from.size(), to), options);
  }

  bool has_result() const { return std::filesystem::exists(folder_ / "out/vibrations.h5"); }

  void expect_refused(const Outcome& outcome, const std::string& message) {
    EXPECT_EQ(outcome.status, 1);
    EXPECT_THAT(outcome.err, AllOf(StartsWith("soil: "), HasSubstr(message)));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);  // one line
    EXPECT_FALSE(has_result());
  }

  TemporaryFolder folder_;
};

TEST_F(SoilProgram, ComputesVibrationsAndReportsThem) {
  const Outcome outcome = run(tiny_site);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  for (const char* part : {"mesh ", "memory ", "steps ", "expected ", "waves: 100 %", "waves: done in",
                           "10 m", "out/vibrations.h5"}) {
    EXPECT_THAT(outcome.out, HasSubstr(part));
  }

  const Vibrations v = read_vibrations(folder_ / "out/vibrations.h5");
  EXPECT_EQ(v.receivers.size(), 2u);
  EXPECT_EQ(v.site_text, tiny_site);
  EXPECT_EQ(v.highest_frequency, 10);
  EXPECT_GT(v.indicators[0].ppv[2], v.indicators[1].ppv[2]);
  EXPECT_GT(v.indicators[1].ppv[2], 0);
  EXPECT_GT(v.footprint_displacement.maxCoeff(), 0);
  const results::ResultReader reader(folder_ / "out/vibrations.h5");
  EXPECT_EQ(reader.read_text_attribute("program"), "soil");
  EXPECT_THAT(reader.read_text_attribute("command"), HasSubstr("site.toml"));

  const Outcome report = call("report " + (folder_ / "out").string());
  EXPECT_EQ(report.status, 0) << report.err;
  EXPECT_THAT(testing::read_whole_file(folder_ / "out/report.html"), HasSubstr("</html>"));
}

TEST_F(SoilProgram, TakesSeveralFilesOfLoads) {
  folder_.write("site.toml", tiny_site);
  const std::string site = (folder_ / "site.toml").string(), loads = (folder_ / "loads.h5").string();
  const std::string one = (folder_ / "one").string(), two = (folder_ / "two").string();
  for (const std::string command : {"run --double", "predict"}) {
    const Outcome first = call(command + " " + site + " " + loads + " --output " + one);
    ASSERT_EQ(first.status, 0) << first.err;
    const Outcome second = call(command + " " + site + " " + loads + " " + loads + " --output " + two);
    ASSERT_EQ(second.status, 0) << second.err;
    const Vibrations a = read_vibrations(folder_ / "one/vibrations.h5");
    const Vibrations b = read_vibrations(folder_ / "two/vibrations.h5");
    EXPECT_LT((b.vz - 2 * a.vz).cwiseAbs().maxCoeff(), 1e-9 * a.vz.cwiseAbs().maxCoeff()) << command;
    EXPECT_EQ(b.footprint_x.size(), 2);
  }
  const Outcome missing = call("run " + site + " " + loads + " nowhere.h5 --output " + two);
  EXPECT_EQ(missing.status, 1);
  EXPECT_THAT(missing.err, HasSubstr("nowhere.h5"));
}

TEST_F(SoilProgram, PredictsFromImpulseResponsesAsFromTheSite) {
  folder_.write("site.toml", tiny_site);
  const std::string site = (folder_ / "site.toml").string(), loads = (folder_ / "loads.h5").string();
  const std::string file = (folder_ / "mobility.h5").string();
  const Outcome mobility = call("mobility " + site + " --loads " + loads + " --output " + file);
  ASSERT_EQ(mobility.status, 0) << mobility.err;
  EXPECT_THAT(mobility.out,
              AllOf(HasSubstr("2 m x 2.5 m"), HasSubstr("2 distances of receivers, 1 of footprints")));
  const Outcome stored = call("predict " + file + " " + loads + " --output " + (folder_ / "out").string());
  ASSERT_EQ(stored.status, 0) << stored.err;
  EXPECT_THAT(stored.out, AllOf(HasSubstr("PPV"), HasSubstr("10 m"), HasSubstr("out/vibrations.h5")));
  const Outcome direct = call("predict " + site + " " + loads + " --output " + (folder_ / "direct").string());
  ASSERT_EQ(direct.status, 0) << direct.err;
  const Vibrations a = read_vibrations(folder_ / "out/vibrations.h5"),
                   b = read_vibrations(folder_ / "direct/vibrations.h5");
  EXPECT_EQ(a.vz, b.vz);
  EXPECT_EQ(a.site_text, tiny_site);
  EXPECT_GT(a.footprint_displacement.maxCoeff(), 0);

  // Responses by the size of the footprint alone; loads of another size are refused.
  const std::string other = (folder_ / "other.h5").string();
  ASSERT_EQ(call("mobility " + site + " --footprint 1 2.5 --output " + other).status, 0);
  std::filesystem::remove_all(folder_ / "out");
  expect_refused(call("predict " + other + " " + loads + " --output " + (folder_ / "out").string()),
                 "footprint 1 is 2 m x 2.5 m, must be 1 m x 2.5 m");
  expect_refused(call("mobility " + site), "no footprint: give --loads");
}

TEST_F(SoilProgram, KeepsImpulseResponsesOfFiniteElementsWhileTheyHold) {
  std::string text = tiny_site;
  text.replace(text.find("margin = 0"), 10, "margin = 20");
  text.replace(text.find("points_per_wavelength = 4"), 25, "points_per_wavelength = 8");
  folder_.write("site.toml", text);
  const std::string site = (folder_ / "site.toml").string(), loads = (folder_ / "loads.h5").string();
  const std::string file = (folder_ / "site.mobility.h5").string();  // beside the site file
  const std::string command = "mobility " + site + " --loads " + loads + " --method elements";
  const Outcome announced = call(command + " --dry-run");
  EXPECT_THAT(announced.out, AllOf(HasSubstr("quarter model"), HasSubstr("memory "), HasSubstr("expected ")));
  EXPECT_FALSE(std::filesystem::exists(file));
  // Half a second after the slowest wave is short at 10 Hz; the window that is chosen is long enough.
  const Outcome cut_off = call(command + " --window 0.625");
  ASSERT_EQ(cut_off.status, 0) << cut_off.err;
  EXPECT_THAT(cut_off.err,
              AllOf(HasSubstr("soil: warning: 2.9 % of the largest response of a receiver at (0, "),
                    HasSubstr("--window gives a longer one")));
  const Outcome first = call(command);
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_EQ(first.err, "");
  EXPECT_THAT(first.out, HasSubstr("does not hold any more: responses of 0.6"));
  EXPECT_THAT(first.out, AllOf(HasSubstr("waves: done in"), HasSubstr("finite elements")));
  EXPECT_EQ(call(command).out, file + ": up to date\n");

  // A comment, another name, fewer receivers: still that ground, and all distances are there.
  std::string fewer = "# a remark\n" + text;
  fewer.replace(fewer.find("[[receiver]]\nname = \"10 m\"\ndistance = 10\n"), 40, "");
  folder_.write("site.toml", fewer);
  EXPECT_EQ(call(command).out, file + ": up to date\n");
  const std::string predict = "predict " + file + " " + loads + " --output " + (folder_ / "out").string();
  ASSERT_EQ(call(predict).status, 0);
  EXPECT_EQ(read_vibrations(folder_ / "out/vibrations.h5").receivers.size(), 2u);  // of the file
  const Outcome verified = call(predict + " --verify --site " + site);
  ASSERT_EQ(verified.status, 0) << verified.err;
  EXPECT_THAT(verified.out, HasSubstr("difference from the layered half-space"));
  const Vibrations v = read_vibrations(folder_ / "out/vibrations.h5");
  ASSERT_EQ(v.receivers.size(), 1u);  // of the site file
  EXPECT_EQ(v.method, "superposition of impulse responses by: finite elements");
  EXPECT_LT(compare_with_semi_analytical(v)[0].l2[2], 0.1);  // the edge of a small model and low frequencies
  EXPECT_EQ(call("report " + (folder_ / "out").string()).status, 0);
  EXPECT_THAT(
      testing::read_whole_file(folder_ / "out/report.html"),
      AllOf(HasSubstr(v.method), HasSubstr("its own first of all, is semi-analytical in both curves")));

  // Another ground, a farther receiver, other options: computed anew; the earlier file is set aside.
  std::string other = text;
  folder_.write("site.toml", other.replace(other.find("cs = 200"), 8, "cs = 210"));
  std::filesystem::remove_all(folder_ / "out");
  expect_refused(call(predict + " --site " + site),
                 "layer 1: cs = 200 m/s there, layer 1: cs = 210 m/s here");
  const Outcome renewed = call(command);
  ASSERT_EQ(renewed.status, 0) << renewed.err;
  EXPECT_THAT(renewed.out, HasSubstr("does not hold any more: layer 1: cs = 200 m/s there"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "site.mobility.previous.h5"));
  EXPECT_THAT(call(command + " --degree 3 --dry-run").out,
              HasSubstr("degree of the elements = 4 there, degree of the elements = 3 here"));
  EXPECT_THAT(call("mobility " + site + " --loads " + loads + " --dry-run").out,
              HasSubstr("method = finite elements there, method = layered half-space here"));
  folder_.write("site.toml", other.replace(other.find("distance = 20"), 13, "distance = 21"));
  EXPECT_THAT(call(command + " --dry-run").out,
              HasSubstr("no receiver at (0, 21, 0) m from a footprint there"));
  expect_refused(call(command + " --damping constant-q"), "must be constant, stiffness or none");
  expect_refused(call("predict " + site + " " + loads + " --verify --output " + (folder_ / "out").string()),
                 "the responses are semi-analytical themselves");
}

TEST_F(SoilProgram, WritesIntoTheCurrentFolderByNameAlone) {
  folder_.write("site.toml", tiny_site);
  const std::string here = "cd " + folder_.path().string() + " && " + SOIL_PROGRAM;
  EXPECT_EQ(std::system(
                (here + " mobility site.toml --loads loads.h5 --method elements -o a.h5 --dry-run >log 2>&1")
                    .c_str()),
            0)
      << testing::read_whole_file(folder_ / "log");
  EXPECT_THAT(testing::read_whole_file(folder_ / "log"), HasSubstr("checkpoint "));
  EXPECT_EQ(std::system((here + " run site.toml loads.h5 --output . --dry-run >log 2>&1").c_str()), 0)
      << testing::read_whole_file(folder_ / "log");
}

TEST_F(SoilProgram, RefusesAModuleForRanksOfAnotherVersion) {
  // As a launcher would start it; the first module has another version, the second one is older than versions.
  for (const auto& [module, version] :
       {std::pair{WRONG_MODULE, "1.9.0, interface 1"}, {OLD_MODULE, "an earlier version"}}) {
    const std::string folder = std::filesystem::path(module).parent_path().string();
    setenv("OMPI_COMM_WORLD_SIZE", "2", 1);
    setenv("LD_LIBRARY_PATH", folder.c_str(), 1);
    const Outcome outcome = run(tiny_site);
    unsetenv("OMPI_COMM_WORLD_SIZE");
    unsetenv("LD_LIBRARY_PATH");
    expect_refused(outcome, std::string("libsoil_mpi.so: is of ") + version + ", must be of ");
    EXPECT_THAT(outcome.err, HasSubstr(folder));
  }
}

TEST_F(SoilProgram, ComputesResponsesAnewThatAreTooShort) {
  folder_.write("site.toml", tiny_site);
  const std::string command =
      "mobility " + (folder_ / "site.toml").string() + " --loads " + (folder_ / "loads.h5").string();
  const std::string file = (folder_ / "site.mobility.h5").string();
  const Outcome cut_off = call(command + " --window 0.1");  // before the waves are at 20 m
  ASSERT_EQ(cut_off.status, 0) << cut_off.err;
  EXPECT_THAT(cut_off.err, AllOf(HasSubstr("soil: warning: "), HasSubstr(" m from the footprint are left"),
                                 HasSubstr("--window")));
  EXPECT_EQ(call(command + " --window 0.1").out, file + ": up to date\n");
  const Outcome whole = call(command);
  ASSERT_EQ(whole.status, 0) << whole.err;
  EXPECT_EQ(whole.err, "");
  EXPECT_THAT(whole.out, HasSubstr("does not hold any more: responses of 0.2 s there, 1.1875 s here"));
  EXPECT_EQ(call(command).out, file + ": up to date\n");
  EXPECT_EQ(call(command + " --window 0.1").out, file + ": up to date\n");
}

TEST_F(SoilProgram, RefusesOptionsThatWouldDoNothing) {
  folder_.write("site.toml", tiny_site);
  const std::string command = "mobility " + (folder_ / "site.toml").string(),
                    loads = " --loads " + (folder_ / "loads.h5").string();
  for (const std::string option : {"--degree 3", "--double", "--crossover 5"}) {
    expect_refused(call(command + loads + " " + option), "is for --method elements, the method is layered");
  }
  for (const std::string option : {"--spacing 0.7", "--count 3", "--footprint 1 2"}) {
    const Outcome outcome = call(command + loads + " " + option);
    expect_refused(outcome, "the footprints are those of --loads");
    EXPECT_THAT(outcome.err, HasSubstr(option.substr(0, option.find(' '))));
  }
}

TEST_F(SoilProgram, EndsLayeredWorkOnTheFirstSignal) {
  std::string text = tiny_site;
  text.replace(text.find("highest_frequency = 10\n"), 23, "highest_frequency = 200\n");  // minutes
  folder_.write("site.toml", text);
  const std::string arguments = "mobility " + (folder_ / "site.toml").string() +
                                " --footprint 1 2.5 --count 200 --window 100 --threads 1";
  const int status = std::system(("timeout --preserve-status -s TERM 0.5 " + std::string(SOIL_PROGRAM) + " " +
                                  arguments + " >/dev/null 2>&1")
                                     .c_str());
  EXPECT_EQ(WEXITSTATUS(status), 143);  // 128 + SIGTERM
  EXPECT_FALSE(std::filesystem::exists(folder_ / "site.mobility.h5"));
}

TEST_F(SoilProgram, TakesPicturesWithoutAWordInTheSiteFile) {
  const Outcome outcome = run(tiny_site, "--snapshot-step 0.2");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/snapshots/surface.pvd"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/snapshots/section.pvd"));
}

TEST_F(SoilProgram, VerifiesFiniteElementsByTheLayeredHalfSpace) {
  const Outcome outcome = run_replaced("margin = 0", "margin = 30", "--verify");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("difference from the layered half-space"));
  const Vibrations v = read_vibrations(folder_ / "out/vibrations.h5");
  ASSERT_TRUE(v.semi_analytical);
  // A coarse mesh, long waves and a boundary near by: at 10 m, less than an element away, nothing is claimed.
  const auto differences = compare_with_semi_analytical(v);
  ASSERT_EQ(differences.size(), 2u);
  EXPECT_LT(differences[1].l2[2], 0.1);           // measured: 0.027
  EXPECT_TRUE(std::isnan(differences[1].l2[0]));  // x = 0 by symmetry
  const Outcome report = call("report " + (folder_ / "out").string());
  ASSERT_EQ(report.status, 0) << report.err;
  EXPECT_THAT(testing::read_whole_file(folder_ / "out/report.html"),
              HasSubstr("Check: finite elements against the semi-analytical solution"));
}

TEST_F(SoilProgram, DrawsALineOfReceiversAsACurve) {
  const Outcome outcome =
      run(tiny_site +
          "[[receiver_line]]\nname = \"row\"\nfrom = [0, 3]\nto = [0, 20]\ncount = 35\n"
          "[[receiver_grid]]\nname = \"field\"\nfrom = [0, 3]\nto = [2, 5]\ncount = [2, 2]\n");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("41 receivers"), HasSubstr("row (0, 3, 0)"), HasSubstr("row (0, 20, 0)"),
                    HasSubstr("the others are in vibrations.h5"), Not(HasSubstr("row (0, 10, 0)"))));
  const Vibrations v = read_vibrations(folder_ / "out/vibrations.h5");
  ASSERT_EQ(v.receivers.size(), 41u);
  EXPECT_EQ(v.receivers[0].group, "");
  EXPECT_EQ(v.receivers[2].group, "row");
  EXPECT_EQ(v.receivers[40].group, "field");
  EXPECT_EQ(v.receivers[36].name, "row (0, 20, 0)");
  // The end of the line and the receiver "20 m" are one point.
  EXPECT_EQ(v.vz.col(36), v.vz.col(1));

  EXPECT_EQ(call("report " + (folder_ / "out").string()).status, 0);
  const std::string page = testing::read_whole_file(folder_ / "out/report.html");
  for (const char* part : {"Indicators along row", "35 receivers from (0, 3, 0) m to (0, 20, 0) m", "field",
                           "6 of 41 receivers", "10 m"}) {
    EXPECT_THAT(page, HasSubstr(part));
  }
  EXPECT_THAT(page, Not(HasSubstr("row (0, 10, 0)")));
}

TEST_F(SoilProgram, ComparesSeveralResultsOnOnePage) {
  folder_.write("site.toml", tiny_site);
  std::string other_site = tiny_site;
  other_site.replace(other_site.find("distance = 20"), 13, "distance = 30");
  folder_.write("other.toml", other_site);
  const auto path = [&](const char* name) { return (folder_ / name).string(); };
  ASSERT_EQ(
      call("predict " + path("site.toml") + " " + path("loads.h5") + " --output " + path("a/out")).status, 0);
  const std::string twice = path("loads.h5") + " " + path("loads.h5");
  ASSERT_EQ(call("predict " + path("other.toml") + " " + twice + " --output " + path("b/out")).status, 0);
  const std::string both = path("a/out") + " " + path("b/out");

  const Outcome named = call("report " + both + " --output " + path("page.html"));
  ASSERT_EQ(named.status, 0) << named.err;
  EXPECT_EQ(named.out, path("page.html") + "\n");
  const std::string page = testing::read_whole_file(folder_ / "page.html");
  for (const char* part : {"a/out \u00b7 b/out", "Insertion loss, b/out against a/out",
                           "Vertical velocity at 10 m", ">+6.0<", "layered half-space", "</html>"}) {
    EXPECT_THAT(page, HasSubstr(part));
  }
  EXPECT_THAT(page, Not(HasSubstr("Vertical velocity at 20 m")));  // in one of them only
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a/out/report.html"));
  const std::string here =
      "cd " + folder_.path().string() + " && " + SOIL_PROGRAM + " report a/out b/out >log";
  EXPECT_EQ(std::system(here.c_str()), 0);
  EXPECT_EQ(testing::read_whole_file(folder_ / "log"), "comparison.html\n");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "comparison.html"));

  // One folder: its report, where it has always been or under another name.
  EXPECT_EQ(call("report " + path("a/out")).out, path("a/out/report.html") + "\n");
  EXPECT_EQ(call("report " + path("a/out") + " -o " + path("one.html")).out, path("one.html") + "\n");
  EXPECT_THAT(testing::read_whole_file(folder_ / "one.html"), HasSubstr("Ground vibration: prediction"));

  std::filesystem::remove(folder_ / "page.html");
  const auto expect_no_page = [&](const std::string& folders, const std::string& message) {
    expect_refused(call("report " + folders + " --output " + path("page.html")), message);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "page.html"));
  };
  expect_no_page(path("a/out") + " " + path("a"), "/a: holds no vibrations.h5");
  expect_no_page(path("a/out") + " " + path("a/out"), "a/out: given twice");
  other_site.replace(other_site.find("distance = 10"), 13, "distance = 15");
  folder_.write("other.toml", other_site);
  ASSERT_EQ(call("predict " + path("other.toml") + " " + twice + " --output " + path("b/out")).status, 0);
  expect_no_page(both, "no two results have a receiver in common");
}

TEST_F(SoilProgram, WritesSnapshotsAndAnnouncesThem) {
  const std::string site = tiny_site + "[[snapshot]]\nz = 0\nstep = 0.1\n[[snapshot]]\nx = 1\nstep = 0.1\n";
  const Outcome announced = run(site, "--dry-run");
  EXPECT_THAT(announced.out,
              AllOf(HasSubstr("snapshots "), HasSubstr("out/snapshots"), HasSubstr("\"surface\": ")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
  ASSERT_EQ(run(site).status, 0);
  for (const char* file : {"surface.pvd", "surface/00000.vtu", "x=1.pvd", "x=1/00000.vtu"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out/snapshots" / file)) << file;
  }
  // The next run without snapshots leaves none that look like its own.
  ASSERT_EQ(run(tiny_site).status, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/snapshots"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/snapshots.previous/surface.pvd"));
  expect_refused(run(tiny_site + "[[snapshot]]\nx = 500\nstep = 0.1\n"),
                 "snapshot \"x=500\": x = 500 m, must be in");
}

TEST_F(SoilProgram, StopsBeforeTheRunWhenAsked) {
  const Outcome outcome = run(tiny_site, "--dry-run");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("expected "));
  EXPECT_FALSE(has_result());
}

TEST_F(SoilProgram, NamesTheLayerThatMakesTheStepShort) {
  EXPECT_THAT(run(tiny_site, "--dry-run").out, Not(HasSubstr("so short because of")));
  std::string thin = tiny_site;
  thin.replace(thin.find("thickness = 9"), 13, "thickness = 0.3");
  EXPECT_THAT(run(thin, "--dry-run").out,
              HasSubstr("so short because of layer 1 \"loam\", which is only 0.3 m thick"));
}

TEST_F(SoilProgram, SetsAnEarlierResultAsideWhenItFails) {
  std::filesystem::create_directory(folder_ / "out");
  folder_.write("out/vibrations.h5", "earlier");
  expect_refused(run(""), "no layer");
  EXPECT_EQ(testing::read_whole_file(folder_ / "out/vibrations.previous.h5"), "earlier");
}

TEST_F(SoilProgram, RefusesAMissingFile) {
  const std::string output = " --output " + (folder_ / "out").string();
  expect_refused(call("run none.toml " + (folder_ / "loads.h5").string() + output),
                 "none.toml: cannot be read");
  folder_.write("site.toml", tiny_site);
  expect_refused(call("run " + (folder_ / "site.toml").string() + " none.h5" + output),
                 "none.h5: no such file");
  folder_.write("text.h5", "not HDF5");
  expect_refused(
      call("run " + (folder_ / "site.toml").string() + " " + (folder_ / "text.h5").string() + output),
      "text.h5: is not a readable HDF5 file");
}

TEST_F(SoilProgram, RefusesAWrongKey) {
  expect_refused(run_replaced("thickness = 9", "thicknes = 9"),
                 "site.toml:4:1: layer 1: unknown key \"thicknes\", did you mean \"thickness\"?");
}

TEST_F(SoilProgram, RefusesANegativeStiffness) {
  expect_refused(run_replaced("cs = 200", "cs = -200"),
                 "site.toml:7:6: layer \"loam\": cs = -200 m/s, must be > 0");
  expect_refused(run_replaced("cs = 200", "E = -61e6"),
                 "site.toml:7:5: layer \"loam\": E = -61000000 Pa, must be > 0");
}

TEST_F(SoilProgram, WarnsOfValuesThatLookLikeAWrongUnit) {
  std::string site = tiny_site;
  site.replace(site.find("density = 1800"), 14, "density = 1.8");
  const Outcome outcome = run(site, "--dry-run");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("site.toml: layer 1 \"loam\": density = 1.8 kg/m3 is unusual"),
                                 HasSubstr("is the unit right?")));
}

TEST_F(SoilProgram, RefusesANumberThatIsNotFinite) {
  expect_refused(run_replaced("density = 1800", "density = nan"),
                 "site.toml:5:11: layer \"loam\": density = nan kg/m3, must be a finite number, > 0");
}

TEST_F(SoilProgram, RefusesALayerOfZeroThickness) {
  expect_refused(run_replaced("thickness = 9", "thickness = 0"),
                 "site.toml:4:13: layer \"loam\": thickness = 0 m, must be > 0");
}

TEST_F(SoilProgram, RefusesAReceiverOutsideTheGround) {
  expect_refused(run_replaced("distance = 20", "position = [0, 20, 1]"),
                 "site.toml:19:12: receiver \"20 m\": z = 1 m, must be <= 0");
}

TEST_F(SoilProgram, RefusesAGroundThatNeedsMoreMemoryThanThereIs) {
  expect_refused(run_replaced("highest_frequency = 10", "highest_frequency = 20000"), "site.toml");
}

TEST_F(SoilProgram, ReturnsTwoForWrongOptions) {
  EXPECT_EQ(call("").status, 2);
  EXPECT_EQ(call("run").status, 2);
  const Outcome misspelt = call("rum");
  EXPECT_EQ(misspelt.status, 2);
  EXPECT_THAT(misspelt.err, HasSubstr("no command \"rum\", did you mean \"run\"?"));
  EXPECT_EQ(run(tiny_site, "--degree 12").status, 2);
  EXPECT_EQ(run(tiny_site, "--colour").status, 2);
  EXPECT_FALSE(has_result());
}

TEST_F(SoilProgram, ExplainsItself) {
  const Outcome help = call("run --help");
  EXPECT_EQ(help.status, 0);
  for (const char* part : {"Example:", "SITE.toml", "SURFACE_LOADS.h5", "vibrations.h5", "--output"}) {
    EXPECT_THAT(help.out, HasSubstr(part));
  }
  EXPECT_THAT(call("--version").out, StartsWith("soil 2."));
}

}  // namespace
}  // namespace easydyn::soil
