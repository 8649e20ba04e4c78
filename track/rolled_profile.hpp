#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "track/profile.hpp"

namespace easydyn::track {

/// Where a running surface is not flat and how finely its path is tabulated.
struct RolledProfileOptions {
  double begin = 0, end = 0;        ///< of the surface [m]; beyond them it goes on level
  std::vector<double> breaks = {};  ///< places within, where the surface has a corner or a vertical edge [m]
  double step = 2.5e-4;             ///< of the table [m]; features of the surface shorter than this are lost
};

/// The path of the centre of a rigid wheel that rolls over any piecewise smooth running surface p(x):
///
///   r_R(x) = max over s of  p(x + s) + sqrt(R^2 - s^2) - R          |s| < R
///
/// At the point of contact c = x + s, r_R' = s / sqrt(R^2 - s^2) (as c is at rest on the surface), and p'(c) =
/// r_R' where p is smooth. c never runs back as x goes on.
///
/// Where c leaps (the wheel bridges a valley sharper than itself) r_R' jumps up: a rigid wheel takes the velocity
/// v (r'_ahead - r'_behind) at once, an impact that only the contact's stiffness softens. Leaps are found by
/// bisection to 1e-11 m; there r' and r'' are those of the side ahead.
///
/// Between leaps the path is tabulated: cubics through exact heights and slopes, continuously differentiable. Error
/// step^4 max|r''''| / 384, below 1e-13 m on the arcs of a wheel; below step^2 max|jump of r''| / 50, some
/// nanometres, in cells where the wheel rolls onto a corner. One table per wheel radius is made when the radius
/// is first asked for; several threads may ask at once.
class RolledProfile : public Profile {
 public:
  /// @param name     for messages
  /// @param surface  p(x) with its derivative, the same for all wheels, as a profile that does not filter; not null
  /// @throws ModelError naming the option, its value and the range
  RolledProfile(std::string name, std::shared_ptr<const Profile> surface, RolledProfileOptions options);
  ~RolledProfile() override;

  /// @throws ModelError unless wheel_radius > height of the surface from its lowest to its highest point
  ProfilePoint at(double x, double wheel_radius) const override;
  /// The same without a table, as exactly as the surface is known; slow.
  ProfilePoint compute(double x, double wheel_radius) const;
  /// Places where r' jumps for this wheel [m].
  std::vector<double> kinks(double wheel_radius) const;

 private:
  struct Contact;
  struct Piece;
  struct Table;
  Contact touch(double x, double R) const;
  double reach(double R) const;
  const Table& table_of(double R) const;
  void add_pieces(Table& table, const Contact& from, const Contact& to) const;

  std::string name_;
  std::shared_ptr<const Profile> surface_;
  RolledProfileOptions options_;
  std::vector<double> x_, p_;  // vertices of the surface, equidistant and at breaks (the higher side)
  double height_ = 0;
  mutable std::mutex making_;
  mutable std::atomic<const Table*> tables_ = nullptr;  // a list that only grows
};

}  // namespace easydyn::track
