#pragma once

#include <limits>
#include <string>

#include "easydyn/mbs/system.hpp"

namespace easydyn {

/// Controller with proportional, integral and derivative action on an error e, the derivative filtered:
///
///   u = K_p e + K_i z + K_d (e - f) / T_f
///   z. = e                          f. = (e - f) / T_f
///
/// As a transfer function K_p + K_i / s + K_d s / (1 + T_f s). With limits, u stays within them and the integral follows
/// (back-calculation, Astrom & Hagglund, Advanced PID Control, ISA 2006, sect. 3.5): z. = e + (u - u_unlimited) / (K_i
/// T_t), tracking time T_t.
/// The two states z and f are first-order states of the system, named "name.integral" and "name.filter".
class Pid {
 public:
  struct Data {
    double proportional = 0;                                  ///< K_p
    double integral = 0;                                      ///< K_i [1/s]
    double derivative = 0;                                    ///< K_d [s]
    double filter_time = 0;                                   ///< T_f [s], > 0 where K_d is not 0
    double lower = -std::numeric_limits<double>::infinity();  ///< of u
    double upper = std::numeric_limits<double>::infinity();   ///< of u, > lower
    double tracking_time = 0;  ///< T_t [s], > 0 where there are limits and K_i is not 0
  };

  /// @throws ModelError naming the controller, the value and the range
  Pid(System& system, std::string name, const Data& data);

  /// u for the error e; sets the rates of its states. Once per evaluation, in System::forces().
  double compute(double error);

  double value() const { return u_; }  ///< u of the last evaluation
  const std::string& name() const { return name_; }

 private:
  std::string name_;
  Data data_;
  FirstOrderState integral_, filter_;
  double u_ = 0;
};

}  // namespace easydyn
