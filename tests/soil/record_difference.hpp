#pragma once

// How far apart the records of two predictions are.

#include <utility>

#include "soil/recoupling.hpp"
#include "soil/vibrations.hpp"

namespace easydyn::soil::test {

/// |a - b| / |b| of each receiver's velocity, all components together, over the times that both have; of the part above
/// `lowest` [Hz] alone if it is > 0.
inline Eigen::VectorXd compute_record_difference(const Vibrations& a, const Vibrations& b,
                                                 double lowest = 0) {
  const Eigen::VectorXd time = a.time.head((a.time.array() <= b.time(b.time.size() - 1)).count());
  const auto cut = [&](const Eigen::MatrixXd& velocity) -> Eigen::MatrixXd {
    if (lowest <= 0) return velocity;
    return velocity - compute_slow_part(velocity, time(1) - time(0), lowest);
  };
  Eigen::VectorXd difference = Eigen::VectorXd::Zero(a.vz.cols()), size = difference;
  for (const auto& [mine, other] : {std::pair{&a.vx, &b.vx}, {&a.vy, &b.vy}, {&a.vz, &b.vz}}) {
    const Eigen::MatrixXd reference = cut(interpolate(b.time, *other, time));
    difference += (cut(mine->topRows(time.size())) - reference).colwise().squaredNorm().transpose();
    size += reference.colwise().squaredNorm().transpose();
  }
  return (difference.array() / size.array()).sqrt();
}

}  // namespace easydyn::soil::test
