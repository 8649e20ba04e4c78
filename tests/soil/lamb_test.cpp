#include <gtest/gtest.h>

#include "tests/soil/lamb_problem.hpp"
#include "tests/soil/verification_record.hpp"

namespace easydyn::soil {
namespace {

using test::compare_with_lamb;
using test::Errors;

// With the defaults of margin and boundary. Measured at 5.5 points per wavelength and 0.95 of the stable step, which
// are the defaults, too: 1.1 to 2.0 %; at 7.5 points and half the step: 0.4 to 0.9 %. The rest is the leapfrog's phase
// error, which grows with the distance, and what the boundary sends back.
TEST(LambsProblem, IsSolvedWithinThreePercentAtTheDefaultResolution) {
  for (const double nu : {0.25, 0.35}) {
    const Errors errors =
        compare_with_lamb(nu, 20, Site().points_per_wavelength, SolverOptions().step_safety);
    for (int k = 0; k < 3; ++k) {
      EXPECT_LT(errors.vertical[k], 0.03) << "nu " << nu;
      EXPECT_LT(errors.radial[k], 0.03) << "nu " << nu;
    }
    test::record_verification("lamb-default", 100 * test::worst_of(errors));
  }
}

TEST(LambsProblem, IsSolvedWithinOnePercentOnAFinerMeshWithASmallerStep) {
  const Errors errors = compare_with_lamb(0.25, 20, 7.5, 0.45);
  for (int k = 0; k < 3; ++k) {
    EXPECT_LT(errors.vertical[k], 0.01);
    EXPECT_LT(errors.radial[k], 0.01);
  }
  test::record_verification("lamb-small-step", 100 * test::worst_of(errors));
}

}  // namespace
}  // namespace easydyn::soil
