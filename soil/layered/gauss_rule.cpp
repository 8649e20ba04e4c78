#include "soil/layered/gauss_rule.hpp"

#include <cmath>
#include <numbers>

namespace easydyn::soil {

GaussRule::GaussRule(int n) : points(n), weights(n) {
  for (int i = 0; i < n; ++i) {
    // Newton's method from the asymptotic place of the root of P_n.
    double x = std::cos(std::numbers::pi * (n - i - 0.25) / (n + 0.5)), slope = 1;
    for (int pass = 0; pass < 100; ++pass) {
      double before = 1, p = x;  // P_0, P_1
      for (int m = 2; m <= n; ++m) {
        const double next = ((2 * m - 1) * x * p - (m - 1) * before) / m;
        before = p;
        p = next;
      }
      slope = n * (x * p - before) / (x * x - 1);
      const double step = p / slope;
      x -= step;
      if (std::abs(step) < 1e-15) break;
    }
    points(i) = x;
    weights(i) = 2 / ((1 - x * x) * slope * slope);
  }
}

}  // namespace easydyn::soil
