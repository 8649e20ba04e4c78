// Bessel functions of many arguments.

#include "soil/layered/bessel.hpp"

#include <gtest/gtest.h>
#include <math.h>  // j0, j1: not in <cmath>

namespace easydyn::soil {
namespace {

TEST(BesselFunctions, AreThoseOfTheCLibrary) {
  // Both forms, their border at 10, any number of arguments. 1e-13: the series end there; x = 1e5 is known to 1e-11
  // of a period, and J to 1e-11 / sqrt(x).
  for (const Eigen::Index count : {1, 7, 8, 1003}) {
    for (const double last : {3.0, 11.0, 25.0, 2000.0, 9e4}) {
      const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(count, count > 1 ? 0 : last, last);
      Eigen::VectorXd J0(count), J1(count);
      update_bessel(x, J0, J1);
      for (Eigen::Index i = 0; i < count; ++i) {
        ASSERT_NEAR(J0(i), ::j0(x(i)), 1e-13) << x(i);
        ASSERT_NEAR(J1(i), ::j1(x(i)), 1e-13) << x(i);
      }
    }
  }
}

}  // namespace
}  // namespace easydyn::soil
