#include <gtest/gtest.h>

#include "tests/soil/lamb_problem.hpp"
#include "tests/soil/verification_record.hpp"

namespace easydyn::soil {
namespace {

TEST(LambsProblem, IsSolvedWithinHalfAPercentWhereTimeAllows) {
  const test::Errors errors = test::compare_with_lamb(0.25, 20, 10, 0.3);
  for (int k = 0; k < 3; ++k) {  // measured: 0.3 to 0.46 %, of which 0.3 % is the boundary's
    EXPECT_LT(errors.vertical[k], 0.005);
    EXPECT_LT(errors.radial[k], 0.005);
  }
}

// The step is small so that the leapfrog's phase error does not hide the mesh's, and the crossover keeps the
// boundary's share small: without it up to 0.9 % at 20 m (measured).
TEST(LambsProblem, IsSolvedWithinHalfAPercentByDegreesFiveAndSix) {
  for (const int degree : {5, 6}) {
    const test::Errors errors = test::compare_with_lamb(0.25, 20, 7.8, 0.3, degree, 14);
    for (int k = 0; k < 3; ++k) {
      EXPECT_LT(errors.vertical[k], 0.005) << "degree " << degree;
      EXPECT_LT(errors.radial[k], 0.005) << "degree " << degree;
    }
    test::record_verification("lamb-degree-5", 100 * test::worst_of(errors));
  }
}

}  // namespace
}  // namespace easydyn::soil
