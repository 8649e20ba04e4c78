#pragma once

#include <stdexcept>
#include <string>

namespace easydyn {

/// Base of every error that the project throws for its user; what() is one line a user can act on.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What the user described cannot be: names the object, the quantity, its value and the accepted range,
/// e.g. `rail "left": EI = -6.4e6 N m^2, must be > 0`.
class ModelError : public Error {
 public:
  using Error::Error;
};

/// A file or an option cannot be used. For text files what() starts with `file:line:column: `.
class InputError : public Error {
 public:
  using Error::Error;
};

/// A computation failed: names time, step, iterations, residual and what to try.
class SolverError : public Error {
 public:
  using Error::Error;
};

}  // namespace easydyn
