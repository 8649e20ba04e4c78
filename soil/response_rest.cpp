#include "soil/response_rest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

namespace easydyn::soil {
namespace {

using Eigen::Index;

// Of one column; NaN-free: 0 where nothing moves. All components together, since symmetry makes some of them zero.
double compute_share(std::initializer_list<const Eigen::MatrixXd*> components, Index column, Index last) {
  double largest = 0, rest = 0;
  for (const Eigen::MatrixXd* h : components) {
    largest = std::max(largest, h->col(column).cwiseAbs().maxCoeff());
    rest = std::max(rest, h->col(column).tail(last).cwiseAbs().maxCoeff());
  }
  return largest > 0 ? rest / largest : 0;
}

}  // namespace

ResponseRest find_rest(const Mobility& m) {
  ResponseRest found;
  const Index rows = std::max(m.hz.rows(), m.mean.rows()), last = std::max<Index>((rows - m.before) / 10, 1);
  if (rows == 0) return found;
  const auto consider = [&](double share, const auto& describe) {
    if (share > found.share) found = {share, static_cast<double>(rows - m.before) * m.step, describe()};
  };
  const auto consider_load = [&](const Eigen::MatrixXd& hx, const Eigen::MatrixXd& hy,
                                 const Eigen::MatrixXd& hz,
                                 std::initializer_list<const Eigen::MatrixXd*> means) {
    for (std::size_t p = 0; p < m.places.size(); ++p) {
      consider(compute_share({&hx, &hy, &hz}, static_cast<Index>(p), last), [&] {
        return fmt::format("a receiver at ({:.6g}, {:.6g}, {:.6g}) m from the footprint", m.places[p][0],
                           m.places[p][1], m.places[p][2]);
      });
    }
    for (std::size_t s = 0; s < m.shifts.size(); ++s) {
      consider(compute_share(means, static_cast<Index>(s), last), [&] {
        return fmt::format("a footprint at ({:.6g}, {:.6g}) m from the loaded one", m.shifts[s][0],
                           m.shifts[s][1]);
      });
    }
  };
  consider_load(m.hx, m.hy, m.hz, {&m.mean});
  for (const auto& [direction, h] : m.horizontal)
    consider_load(h.hx, h.hy, h.hz, {&h.mean_x, &h.mean_y, &h.mean});
  return found;
}

Parameter describe_rest(const ResponseRest& rest) {
  return {"impulse responses", "largest response in the last tenth of the window over the largest there",
          rest.share, "1", "computed"};
}

}  // namespace easydyn::soil
