#pragma once

#include <string>
#include <utility>

namespace easydyn {

/// A number that remembers where it comes from: converts to double, so that formulas read as usual, and
/// forgets its source as soon as a plain number is assigned to it.
///
///   pads.stiffness = {180 * MN / m, "M-l: Brussels tram class"};   // bundled data
///   pads.stiffness = 200 * MN / m;                                  // source is now "set by the user"
///
/// Marks used by the bundled data: F read in the source named, C computed from a closed form or a fit,
/// D derived by elementary reasoning, M recalled from the literature and not verified (-h, -m, -l =
/// confidence).
struct Sourced {
  double value = 0;
  std::string source = "default";

  Sourced() = default;
  Sourced(double v) : value(v), source("set by the user") {}  // NOLINT: implicit on purpose
  Sourced(double v, std::string where) : value(v), source(std::move(where)) {}
  operator double() const { return value; }  // NOLINT: implicit on purpose
};

/// One row of the table of parameters of a run or a report.
struct Parameter {
  std::string group;   ///< what it belongs to, e.g. `track "t2000-like"`
  std::string name;    ///< e.g. "pad stiffness"
  double value = 0;    ///< SI
  std::string unit;    ///< SI, "1" where dimensionless
  std::string source;  ///< provenance, e.g. "M-l: Brussels tram class"
};

}  // namespace easydyn
