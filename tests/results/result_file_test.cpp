#include "easydyn/results/result_file.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "easydyn/error.hpp"
#include "easydyn/results/pending_file.hpp"
#include "tests/temporary_folder.hpp"

namespace easydyn::results {
namespace {

using easydyn::testing::message_of;
using easydyn::testing::TemporaryFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const Provenance provenance{.program = "test", .command = "test --all", .convention = "z up"};
const Meaning metres{.units = "m", .description = "a length", .frame = "downward"};
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(ResultFile, BringsBackWhatWasWritten) {
  const TemporaryFolder folder;
  const Eigen::VectorXd vector = Eigen::VectorXd::LinSpaced(4, 0, 1) / 3;
  const Eigen::MatrixXd matrix = (Eigen::MatrixXd(2, 3) << 1, 2, 3, 4, 5, 6).finished() / 7;
  ResultFile file(folder / "a.h5", provenance);
  file.write_vector("/time", vector, metres);
  file.write_matrix("/deep/group/matrix", matrix, metres);
  file.write_text("/text", "größer als\n\"JSON\"", "a text");
  file.write_names("/names", {"front gear, driven", "", "hintere Achse: ä"}, "some names");
  file.write_attribute("highest_frequency", 50);
  file.write_attribute("site", "Ath");
  file.commit();

  const ResultReader reader(folder / "a.h5");
  EXPECT_EQ(reader.read_vector("/time"), vector);
  EXPECT_EQ(reader.read_matrix("/deep/group/matrix"), matrix);
  EXPECT_EQ(reader.read_text("/text"), "größer als\n\"JSON\"");
  EXPECT_THAT(reader.read_names("/names"), ElementsAre("front gear, driven", "", "hintere Achse: ä"));
  EXPECT_EQ(reader.read_meaning("/time").units, "m");
  EXPECT_EQ(reader.read_meaning("/time").description, "a length");
  EXPECT_EQ(reader.read_meaning("/deep/group/matrix").frame, "downward");
  EXPECT_EQ(reader.read_meaning("/names").units, "");
  EXPECT_EQ(reader.read_number_attribute("highest_frequency"), 50);
  EXPECT_EQ(reader.read_text_attribute("site"), "Ath");
  EXPECT_TRUE(reader.has("/deep"));
  EXPECT_FALSE(reader.has("/deep/other/matrix"));
  EXPECT_EQ(folder.count(), 1);
}

TEST(ResultFile, SaysWhoMadeIt) {
  const TemporaryFolder folder;
  ResultFile(folder / "a.h5", provenance).commit();
  const ResultReader reader(folder / "a.h5");
  EXPECT_EQ(reader.read_text_attribute("program"), "test");
  EXPECT_EQ(reader.read_text_attribute("command"), "test --all");
  EXPECT_EQ(reader.read_text_attribute("convention"), "z up");
  EXPECT_EQ(reader.read_text_attribute("version"), library_version());
  EXPECT_THAT(reader.read_text_attribute("created"), ::testing::MatchesRegex("....-..-..T..:..:..Z"));
}

TEST(ResultFile, HoldsEmptyData) {
  const TemporaryFolder folder;
  ResultFile file(folder / "a.h5", provenance);
  file.write_vector("/vector", Eigen::VectorXd(), metres);
  file.write_matrix("/matrix", Eigen::MatrixXd(3, 0), metres);
  file.write_names("/names", {}, "no names");
  file.write_text("/text", "", "no text");
  file.commit();
  const ResultReader reader(folder / "a.h5");
  EXPECT_EQ(reader.read_vector("/vector").size(), 0);
  EXPECT_EQ(reader.read_matrix("/matrix").rows(), 3);
  EXPECT_EQ(reader.read_matrix("/matrix").cols(), 0);
  EXPECT_TRUE(reader.read_names("/names").empty());
  EXPECT_EQ(reader.read_text("/text"), "");
}

TEST(ResultFile, ReadsAVectorStoredAsAMatrixWithOneColumn) {
  const TemporaryFolder folder;
  ResultFile file(folder / "a.h5", provenance);
  file.write_matrix("/column", Eigen::MatrixXd::Ones(3, 1), metres);
  file.write_matrix("/row", Eigen::MatrixXd::Ones(1, 3), metres);
  file.commit();
  const ResultReader reader(folder / "a.h5");
  EXPECT_EQ(reader.read_vector("/column"), Eigen::VectorXd::Ones(3));
  EXPECT_EQ(reader.read_vector("/row"), Eigen::VectorXd::Ones(3));
}

TEST(ResultFile, LeavesNothingBehindWithoutCommit) {
  const TemporaryFolder folder;
  {
    ResultFile file(folder / "a.h5", provenance);
    file.write_vector("/time", Eigen::VectorXd::Ones(3), metres);
    EXPECT_FALSE(std::filesystem::exists(folder / "a.h5"));
  }
  EXPECT_EQ(folder.count(), 0);
}

TEST(ResultFile, KeepsAnEarlierFileUntilItIsComplete) {
  const TemporaryFolder folder;
  ResultFile(folder / "a.h5", {.program = "first"}).commit();
  { const ResultFile abandoned(folder / "a.h5", {.program = "second"}); }
  EXPECT_EQ(ResultReader(folder / "a.h5").read_text_attribute("program"), "first");
  ResultFile(folder / "a.h5", {.program = "third"}).commit();
  EXPECT_EQ(ResultReader(folder / "a.h5").read_text_attribute("program"), "third");
}

TEST(ResultFile, RefusesNumbersThatAreNotFinite) {
  const TemporaryFolder folder;
  ResultFile file(folder / "a.h5", provenance);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(2, 3);
  matrix(1, 2) = nan;
  EXPECT_EQ(message_of<ModelError>([&] { file.write_matrix("/force", matrix, metres); }),
            "dataset \"/force\": value (1, 2) is nan, must be finite");
  EXPECT_NO_THROW(file.write_matrix("/force", matrix, metres, /*allow_nan=*/true));
  EXPECT_THROW(file.write_vector("/v", Eigen::VectorXd::Constant(1, infinity), metres, true), ModelError);
  EXPECT_THROW(file.write_attribute("number", infinity), ModelError);
}

TEST(ResultFile, NamesTheFileItCannotWrite) {
  const TemporaryFolder folder;
  EXPECT_THAT(message_of<InputError>([&] { ResultFile(folder / "none/a.h5", provenance); }),
              HasSubstr("a.h5: cannot be written, no folder"));
  EXPECT_THAT(message_of<InputError>([&] { ResultFile(folder.path(), provenance); }),
              HasSubstr("is a folder"));
}

TEST(ResultFile, RefusesTheSameNameTwice) {
  const TemporaryFolder folder;
  ResultFile file(folder / "a.h5", provenance);
  file.write_vector("/time", Eigen::VectorXd::Ones(3), metres);
  EXPECT_THAT(message_of<InputError>([&] { file.write_vector("/time", Eigen::VectorXd::Ones(3), metres); }),
              HasSubstr("a.h5: \"/time\" cannot be written"));
}

TEST(ResultReader, NamesFileAndDatasetAndWhatWasExpected) {
  const TemporaryFolder folder;
  ResultFile file(folder / "a.h5", provenance);
  file.write_matrix("/matrix", Eigen::MatrixXd::Ones(2, 3), metres);
  file.write_names("/names", {"a", "b"}, "names");
  file.commit();
  const ResultReader reader(folder / "a.h5");
  const auto vector = [&](const char* name) {
    return message_of<InputError>([&] { reader.read_vector(name); });
  };
  EXPECT_THAT(vector("/matrix"), HasSubstr("a.h5: \"/matrix\" has the shape (2 x 3), must be a vector"));
  EXPECT_THAT(vector("/names"), HasSubstr("\"/names\" must hold numbers"));
  EXPECT_THAT(vector("/none"), HasSubstr("\"/none\" is missing"));
  EXPECT_THAT(vector("/none/deep"), HasSubstr("\"/none/deep\" is missing"));
  EXPECT_THROW(reader.read_text("/matrix"), InputError);
  EXPECT_THROW(reader.read_text("/names"), InputError);
  EXPECT_THROW(reader.read_number_attribute("program"), InputError);
  EXPECT_THROW(reader.read_text_attribute("none"), InputError);
}

TEST(ResultReader, RefusesWhatIsNoResultFile) {
  const TemporaryFolder folder;
  EXPECT_THAT(message_of<InputError>([&] { ResultReader(folder / "none.h5"); }),
              HasSubstr("none.h5: no such file"));
  const auto text = folder.write("text.h5", "not HDF5");
  EXPECT_THAT(message_of<InputError>([&] { ResultReader reader(text); }),
              HasSubstr("is not a readable HDF5 file"));
}

TEST(Provenance, QuotesTheCommandLineForAShell) {
  const char* const arguments[] = {"soil", "run", "my site.toml", "it's", "", "--output=a/b"};
  EXPECT_EQ(join_command_line(6, arguments), R"(soil run 'my site.toml' 'it'\''s' '' --output=a/b)");
}

}  // namespace
}  // namespace easydyn::results
