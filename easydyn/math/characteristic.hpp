#pragma once

#include <functional>
#include <string>
#include <vector>

namespace easydyn {

/// A scalar law y(x) of a force element with its derivative and its integral from 0: a nonlinear spring, a damper.
///
/// As a table: cubic pieces through the points that are monotone where the points are (Fritsch & Carlson, SIAM J.
/// Numer. Anal. 17, 1980), with a continuous slope; beyond the table y goes on straight, with the slope of its end.
/// As a function: the integral by a function of the user's, or by Gauss quadrature (8 points on each of 16 parts:
/// exact to rounding for smooth laws).
class Characteristic {
 public:
  /// @param x  ascending, at least two
  /// @throws ModelError naming the object and the place in the table
  static Characteristic table(const std::string& object, std::vector<double> x, std::vector<double> y);
  static Characteristic function(std::function<double(double)> y,
                                 std::function<double(double)> integral = {});

  double value(double x) const;
  double slope(double x) const;     ///< dy/dx; of a function by central differences
  double integral(double x) const;  ///< of y from 0 to x

 private:
  double integral_from_start(double x) const;
  std::size_t piece_of(double x) const;

  std::vector<double> x_, y_, slope_, integral_;  // of a table: at the points
  double integral_at_zero_ = 0;
  std::function<double(double)> function_, function_integral_;
};

}  // namespace easydyn
