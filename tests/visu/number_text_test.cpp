#include "easydyn/visu/number_text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using easydyn::visu::number_text;
using easydyn::visu::short_number_text;

TEST(NumberText, KeepsTheSignificantDigits) {
  EXPECT_EQ(number_text(0.034561), "0.0346");
  EXPECT_EQ(number_text(2), "2.00");
  EXPECT_EQ(number_text(112.4), "112");
  EXPECT_EQ(number_text(-1.5, 2), "−1.5");
  EXPECT_EQ(number_text(0), "0");
}

TEST(NumberText, RoundsBeforeItCountsDigits) {
  EXPECT_EQ(number_text(0.99996), "1.00");
  EXPECT_EQ(number_text(9.996), "10.0");
  EXPECT_EQ(number_text(12345, 3), "12300");
}

TEST(NumberText, WritesPowersOfTenWhereZerosWouldPileUp) {
  EXPECT_EQ(number_text(2.1e11), "2.10·10¹¹");
  EXPECT_EQ(number_text(-3.4e-7, 2), "−3.4·10⁻⁷");
  EXPECT_EQ(short_number_text(1e6), "10⁶");
}

TEST(NumberText, DropsZerosWhenShort) {
  EXPECT_EQ(short_number_text(0.6), "0.6");
  EXPECT_EQ(short_number_text(30), "30");
  EXPECT_EQ(short_number_text(100.0), "100");
  EXPECT_EQ(short_number_text(2.1e11), "2.1·10¹¹");
}

TEST(NumberText, HasSignsForWhatIsNoNumber) {
  EXPECT_EQ(number_text(std::nan("")), "–");
  EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), "∞");
}
