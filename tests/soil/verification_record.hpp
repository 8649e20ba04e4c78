#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace easydyn::soil::test {

/// A measured figure for the page of verification (`./run verify-soil`), in the unit that verification_cases.txt gives
/// the case. A case measured more than once keeps its worst figure, the largest. Appends one line to the file that the
/// environment variable EASYDYN_VERIFICATION names; does nothing where there is none.
inline void record_verification(const std::string& case_name, double measured) {
  std::printf("%s: %.4g\n", case_name.c_str(), measured);
  const char* const path = std::getenv("EASYDYN_VERIFICATION");
  if (!path) return;
  std::FILE* const file = std::fopen(path, "a");
  ASSERT_NE(file, nullptr) << path;
  std::fprintf(file, "%s %.9g\n", case_name.c_str(), measured);
  EXPECT_EQ(std::fclose(file), 0) << path;
}

}  // namespace easydyn::soil::test
