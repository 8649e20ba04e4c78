#include "soil/surface_loads.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "easydyn/error.hpp"
#include "tests/temporary_folder.hpp"

namespace easydyn::soil {
namespace {

using easydyn::testing::message_of;
using easydyn::testing::TemporaryFolder;
using ::testing::HasSubstr;

// Two footprints, three times.
SurfaceLoads make_loads() {
  SurfaceLoads loads;
  loads.time = Eigen::Vector3d(0.5, 0.6, 0.7);
  loads.footprints = {{-1, 0.1, 0.3, 2.5}, {1, 0.2, 0.4, 2.6}};
  loads.force = (Eigen::MatrixXd(3, 2) << 1, 2, 3, 4, 5, -6).finished();
  return loads;
}

std::string fault_of(const std::function<void(SurfaceLoads&)>& spoil) {
  const TemporaryFolder folder;
  SurfaceLoads loads = make_loads();
  spoil(loads);
  const std::string message =
      message_of<ModelError>([&] { write_surface_loads(folder / "a.h5", loads, {}); });
  EXPECT_EQ(folder.count(), 0);
  return message;
}

TEST(SurfaceLoads, ComeBackAsWritten) {
  const TemporaryFolder folder;
  const SurfaceLoads loads = make_loads();
  write_surface_loads(folder / "a.h5", loads, {.program = "test"});
  const SurfaceLoads read = read_surface_loads(folder / "a.h5");
  EXPECT_EQ(read.time, loads.time);
  EXPECT_EQ(read.force, loads.force);
  ASSERT_EQ(read.footprints.size(), 2u);
  EXPECT_EQ(read.footprints[1].x, 1);
  EXPECT_EQ(read.footprints[1].y, 0.2);
  EXPECT_EQ(read.footprints[1].length, 0.4);
  EXPECT_EQ(read.footprints[1].width, 2.6);
}

TEST(SurfaceLoads, KeepTheirDirections) {
  const TemporaryFolder folder;
  SurfaceLoads loads = make_loads();
  loads.footprints[1].direction = LoadDirection::y;
  write_surface_loads(folder / "a.h5", loads, {});
  EXPECT_EQ(results::ResultReader(folder / "a.h5").read_names("/direction"),
            (std::vector<std::string>{"down", "y"}));
  const SurfaceLoads read = read_surface_loads(folder / "a.h5");
  EXPECT_EQ(read.footprints[0].direction, LoadDirection::down);
  EXPECT_EQ(read.footprints[1].direction, LoadDirection::y);
  // A file without directions, as all were written before, loads downward, and is still written so.
  write_surface_loads(folder / "b.h5", make_loads(), {});
  EXPECT_FALSE(results::ResultReader(folder / "b.h5").has("/direction"));
  EXPECT_EQ(read_surface_loads(folder / "b.h5").footprints[1].direction, LoadDirection::down);
}

TEST(SurfaceLoads, MayActAtPoints) {
  const TemporaryFolder folder;
  SurfaceLoads loads = make_loads();
  loads.footprints[0].length = loads.footprints[0].width = 0;
  write_surface_loads(folder / "a.h5", loads, {});
  EXPECT_TRUE(read_surface_loads(folder / "a.h5").footprints[0].is_point());
}

TEST(SurfaceLoads, OfSeveralFilesActTogether) {
  const TemporaryFolder folder;
  const SurfaceLoads first = make_loads();  // 0.5 to 0.7 s in steps of 0.1 s
  SurfaceLoads second;                      // 0.55 to 1 s in steps of 0.05 s, linear
  second.time = Eigen::VectorXd::LinSpaced(10, 0.55, 1.0);
  second.footprints = {{5, 3, 0, 0, LoadDirection::y}};
  second.force = 10 * second.time;
  write_surface_loads(folder / "a.h5", first, {});
  write_surface_loads(folder / "b.h5", second, {});

  const SurfaceLoads both = read_surface_loads({folder / "a.h5", folder / "b.h5"}, 0.1);
  ASSERT_EQ(both.time.size(), 11);
  EXPECT_NEAR((both.time - Eigen::VectorXd::LinSpaced(11, 0.5, 1.0)).cwiseAbs().maxCoeff(), 0, 1e-12);
  ASSERT_EQ(both.footprints.size(), 3u);
  EXPECT_EQ(both.footprints[0].source, 0);
  EXPECT_EQ(both.footprints[2].source, 1);
  EXPECT_EQ(both.footprints[2].direction, LoadDirection::y);
  EXPECT_NEAR(both.force(2, 0), 3, 1e-9);     // 0.6 s: a sample
  EXPECT_NEAR(both.force(10, 1), -6, 1e-9);   // held after its end
  EXPECT_NEAR(both.force(0, 2), 2.75, 1e-9);  // 0.5 s: half-way in over the 0.1 s before 0.55 s
  EXPECT_NEAR(both.force(6, 2), 8, 1e-9);
  // One file stays as it is.
  EXPECT_EQ(read_surface_loads(std::vector<std::filesystem::path>{folder / "a.h5"}).force, first.force);
}

TEST(SurfaceLoads, AcceptTimesThatAreUniformUpToRounding) {
  const TemporaryFolder folder;
  SurfaceLoads loads = make_loads();
  loads.time = Eigen::VectorXd::LinSpaced(3, 1e4, 1e4 + 2e-3);
  EXPECT_NO_THROW(write_surface_loads(folder / "a.h5", loads, {}));
}

TEST(SurfaceLoads, NameTheFault) {
  EXPECT_THAT(fault_of([](SurfaceLoads& loads) { loads.force(1, 1) = NAN; }),
              HasSubstr("\"/force\": value (1, 1) is nan N, must be finite"));
  EXPECT_THAT(fault_of([](SurfaceLoads& loads) { loads.force.conservativeResize(2, 2); }),
              HasSubstr("\"/force\" has the shape (2 x 2), must be (3 x 2)"));
  EXPECT_THAT(fault_of([](SurfaceLoads& loads) { loads.force.transposeInPlace(); }),
              HasSubstr("\"/force\" has the shape (2 x 3), must be (3 x 2)"));
  EXPECT_THAT(fault_of([](SurfaceLoads& loads) { loads.time(1) = 0.61; }),
              HasSubstr("must be 0.6 s (uniform step)"));
  EXPECT_THAT(fault_of([](SurfaceLoads& loads) { loads.time(2) = NAN; }), HasSubstr("\"/time\""));
  EXPECT_THAT(fault_of([](SurfaceLoads& loads) { loads.time.reverseInPlace(); }), HasSubstr("must increase"));
  EXPECT_THAT(fault_of([](SurfaceLoads& loads) { loads.time.conservativeResize(1); }),
              HasSubstr("at least 2"));
  EXPECT_THAT(fault_of([](SurfaceLoads& loads) { loads.footprints.clear(); }), HasSubstr("no footprint"));
  EXPECT_THAT(fault_of([](SurfaceLoads& loads) { loads.footprints[0].width = 0; }),
              HasSubstr("\"/size\": row 0 is 0.3 m x 0 m, must be > 0 (or both 0: a point)"));
  EXPECT_THAT(fault_of([](SurfaceLoads& loads) { loads.footprints[1].x = INFINITY; }),
              HasSubstr("\"/position\": row 1 is (inf, 0.2) m, must be finite"));
}

TEST(SurfaceLoadsFile, NamesFileAndDataset) {
  const TemporaryFolder folder;
  const auto message = [&] { return message_of<InputError>([&] { read_surface_loads(folder / "a.h5"); }); };
  EXPECT_THAT(message(), HasSubstr("a.h5: no such file"));

  // A file by a foreign program, whose matrices are transposed or hold NaN.
  const results::Meaning any{.units = "1", .description = "", .frame = ""};
  const auto write = [&](const Eigen::MatrixXd& force, const Eigen::MatrixXd& size,
                         const std::vector<std::string>& directions = {}) {
    results::ResultFile file(folder / "a.h5", {});
    file.write_vector("/time", Eigen::Vector3d(0, 1, 2), any);
    file.write_matrix("/force", force, any, /*allow_nan=*/true);
    file.write_matrix("/position", Eigen::MatrixXd::Zero(2, 2), any);
    if (size.size() > 0) {
      file.write_matrix("/size", size, any);
    }
    if (!directions.empty()) {
      file.write_names("/direction", directions, "");
    }
    file.commit();
  };
  const Eigen::MatrixXd ones = Eigen::MatrixXd::Ones(3, 2);
  write(ones, {});
  EXPECT_THAT(message(), HasSubstr("a.h5: \"/size\" is missing"));
  write(ones, Eigen::MatrixXd::Ones(3, 2));
  EXPECT_THAT(message(), HasSubstr("a.h5: \"/size\" has the shape (3 x 2), must be (2 x 2)"));
  write(ones, Eigen::MatrixXd::Ones(2, 2), {"x"});
  EXPECT_THAT(message(), HasSubstr("a.h5: \"/direction\" has 1 texts, must have 2"));
  write(ones, Eigen::MatrixXd::Ones(2, 2), {"x", "up"});
  EXPECT_THAT(message(),
              HasSubstr("a.h5: \"/direction\": text 1 is \"up\", must be \"x\", \"y\" or \"down\""));
  write(ones.transpose(), Eigen::MatrixXd::Ones(2, 2));
  EXPECT_THAT(message(), HasSubstr("a.h5: \"/force\" has the shape (2 x 3), must be (3 x 2)"));
  write(ones * NAN, Eigen::MatrixXd::Ones(2, 2));
  EXPECT_THAT(message(), HasSubstr("a.h5: \"/force\": value (0, 0) is nan N, must be finite"));
}

}  // namespace
}  // namespace easydyn::soil
