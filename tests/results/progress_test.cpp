#include "easydyn/results/progress.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

namespace easydyn::results {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::StartsWith;

// What `use` prints.
template <typename Use>
std::string output_of(bool is_terminal, Use use) {
  std::FILE* file = std::tmpfile();
  {
    Progress progress("waves", file, is_terminal);
    use(progress);
  }
  std::string text(static_cast<std::size_t>(std::ftell(file)), '\0');
  std::rewind(file);
  text.resize(std::fread(text.data(), 1, text.size(), file));
  std::fclose(file);
  return text;
}

TEST(Duration, ReadsAsPeopleSayIt) {
  EXPECT_EQ(format_duration(0.04), "0.0 s");
  EXPECT_EQ(format_duration(0.44), "0.4 s");
  EXPECT_EQ(format_duration(9.97), "10 s");
  EXPECT_EQ(format_duration(59.4), "59 s");
  EXPECT_EQ(format_duration(59.6), "1 min 00 s");
  EXPECT_EQ(format_duration(185), "3 min 05 s");
  EXPECT_EQ(format_duration(7800), "2 h 10 min");
}

TEST(Progress, PrintsALineForEveryTenthIntoAFile) {
  const std::string text = output_of(false, [](Progress& progress) {
    for (int i = 0; i <= 1000; ++i) {
      progress.update(i / 1000.0);
    }
    progress.finish();
  });
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 11);
  EXPECT_THAT(text, StartsWith("waves: 10 %, 0.0 s left\nwaves: 20 %"));
  EXPECT_THAT(text, HasSubstr("\nwaves: 100 %\nwaves: done in 0.0 s\n"));
}

TEST(Progress, RenewsOneLineOnATerminal) {
  const std::string text = output_of(true, [](Progress& progress) {
    progress.update(0.42);
    progress.update(1);
    progress.finish();
  });
  EXPECT_EQ(text, "\rwaves: 42 %, 0.0 s left\033[K\rwaves: 100 %\033[K\rwaves: done in 0.0 s\033[K\n");
}

TEST(Progress, CountsOnlyWhatIsDoneSinceARestart) {
  const std::string text = output_of(false, [](Progress& progress) {
    progress.start_at(0.55);
    progress.update(0.55);  // nothing known yet, nothing new
    progress.update(0.65);
    progress.update(1);
  });
  EXPECT_EQ(text, "waves: 65 %, 0.0 s left\nwaves: 100 %\n");
  EXPECT_EQ(output_of(true,
                      [](Progress& progress) {
                        progress.start_at(0.5);
                        progress.update(0.5);
                      }),
            "\rwaves: 50 %\033[K\n");
}

TEST(Progress, TakesTheRestToLastInProportionToWhatIsDone) {
  // A fifth of the run in 0.4 s, then the other two fifths in 0.8 s; a busy machine makes it longer, not shorter.
  const std::string text = output_of(true, [](Progress& progress) {
    progress.start_at(0.4);
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    progress.update(0.6);
  });
  double left = 0;
  ASSERT_EQ(std::sscanf(text.c_str(), "\rwaves: 60 %%, %lf s left", &left), 1) << text;
  EXPECT_GE(left, 0.8);
  EXPECT_LT(left, 8);
}

TEST(Progress, EndsItsLineWhenTheComputationFails) {
  EXPECT_EQ(output_of(true, [](Progress& progress) { progress.update(0.5); }).back(), '\n');
  EXPECT_EQ(output_of(true, [](Progress&) {}), "");
}

}  // namespace
}  // namespace easydyn::results
