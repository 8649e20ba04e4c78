#include "soil/layered/static_half_space.hpp"

#include <cmath>
#include <numbers>

namespace easydyn::soil {
namespace {

constexpr double pi = std::numbers::pi;

// x ln(y + R), R = |(x, y)|, without cancellation for y < 0; its limit 0 at x = 0.
double x_log(double x, double y) {
  if (x == 0) return 0;
  const double R = std::hypot(x, y);
  return x * (y >= 0 ? std::log(y + R) : 2 * std::log(std::abs(x)) - std::log(R - y));
}

// Fourfold antiderivative of 1 / R, twice in x and twice in y.
double fourfold(double x, double y) {
  const double R = std::hypot(x, y);
  return 0.5 * x * y * (x_log(y, x) + x_log(x, y)) - R * R * R / 6;
}

}  // namespace

StaticPointResponse compute_static_point_response(double nu, double r, double z) {
  const double R = std::hypot(r, z), R3 = R * R * R, beyond = R + z;
  const double first = r / (R * beyond);                                 // int e^(-kz) J1 dk
  const double second = r * r / (R * beyond * beyond);                   // int e^(-kz) J2 dk
  const double second_k = r * r * (2 * R + z) / (R3 * beyond * beyond);  // int k e^(-kz) J2 dk
  const double c = 1 / (4 * pi);
  return {.zz = c * (2 * (1 - nu) / R + z * z / R3),
          .xz = c * (-(1 - 2 * nu) * first + z * r / R3),
          .sum = c / 2 * ((4 - 2 * nu) / R - z * z / R3),
          .difference = c / 2 * (-2 * nu * second - z * second_k),
          .zx = -c * ((1 - 2 * nu) * first + z * r / R3)};
}

StaticCompliance compute_static_compliance(double nu, double k, double z) {
  const double c = std::exp(-k * z) / (2 * k);
  return {.xx = c * (2 * (1 - nu) - k * z),
          .xz = c * (-(1 - 2 * nu) + k * z),
          .zx = -c * (1 - 2 * nu + k * z),
          .zz = c * (2 * (1 - nu) + k * z),
          .yy = 2 * c};
}

StaticRectangleResponse compute_static_rectangle_response(double nu, double length, double width, double x,
                                                          double y) {
  // Integrals over the rectangle by their antiderivatives at its four corners.
  double inverse = 0, along = 0, across = 0, mixed = 0, x_over = 0, y_over = 0;
  for (const double i : {1.0, -1.0}) {
    for (const double j : {1.0, -1.0}) {
      const double X = x + i * length / 2, Y = y + j * width / 2, R = std::hypot(X, Y), sign = i * j;
      const double of_x = x_log(Y, X), of_y = x_log(X, Y);  // of x^2 / R^3 and y^2 / R^3
      along += sign * of_x;
      across += sign * of_y;
      inverse += sign * (of_x + of_y);
      mixed -= sign * R;
      // of x / R^2 and y / R^2
      const double log_R = R > 0 ? std::log(R) : 0;
      x_over += sign * (Y * log_R + (X != 0 ? X * std::atan2(Y, std::abs(X)) * (X > 0 ? 1 : -1) : 0));
      y_over += sign * (X * log_R + (Y != 0 ? Y * std::atan2(X, std::abs(Y)) * (Y > 0 ? 1 : -1) : 0));
    }
  }
  const double c = 1 / (2 * pi * length * width);
  return {.zz = c * (1 - nu) * inverse,
          .xz = -c / 2 * (1 - 2 * nu) * x_over,
          .yz = -c / 2 * (1 - 2 * nu) * y_over,
          .xx = c * ((1 - nu) * inverse + nu * along),
          .yx = c * nu * mixed,
          .zx = c / 2 * (1 - 2 * nu) * x_over};
}

double compute_static_rectangle_mean(double nu, double from_length, double from_width, double to_length,
                                     double to_width, double x, double y) {
  // Far away the closed form cancels: 1 / R averaged to second order (the next is of order (size / R)^4).
  const double R = std::hypot(x, y);
  const double size = std::max(std::max(from_length, to_length), std::max(from_width, to_width));
  if (R > 60 * size) {
    const double xx = (from_length * from_length + to_length * to_length) / 24;
    const double yy = (from_width * from_width + to_width * to_width) / 24;
    const double R2 = R * R;
    return (1 - nu) / (2 * pi * R) * (1 + (xx * (3 * x * x - R2) + yy * (3 * y * y - R2)) / (R2 * R2));
  }
  double sum = 0;
  for (const double i : {1.0, -1.0}) {
    for (const double j : {1.0, -1.0}) {
      for (const double m : {1.0, -1.0}) {
        for (const double n : {1.0, -1.0}) {
          sum += i * j * m * n *
                 fourfold(x + (i * to_length + j * from_length) / 2, y + (m * to_width + n * from_width) / 2);
        }
      }
    }
  }
  return (1 - nu) / (2 * pi) * sum / (from_length * from_width * to_length * to_width);
}

}  // namespace easydyn::soil
