#include "easydyn/forces/nonlinear_spring_damper.hpp"

#include "easydyn/forces/account.hpp"
#include "easydyn/forces/line_of_action.hpp"
#include "easydyn/require.hpp"

namespace easydyn {

NonlinearSpringDamper::NonlinearSpringDamper(std::string name, Characteristic spring, Characteristic damper,
                                             double free_length)
    : name_(std::move(name)),
      spring_(std::move(spring)),
      damper_(std::move(damper)),
      free_length_(free_length) {
  require_not_negative("spring \"" + name_ + "\"", "free length", free_length, "m");
}

NonlinearSpringDamper::NonlinearSpringDamper(std::string name, Characteristic spring, double free_length)
    : NonlinearSpringDamper(std::move(name), std::move(spring),
                            Characteristic::function([](double) { return 0.0; }), free_length) {}

void NonlinearSpringDamper::apply(const Frame& frame_A, const Eigen::Vector3d& p_A, const Frame& frame_B,
                                  const Eigen::Vector3d& p_B) {
  const LineOfAction line("spring", name_, frame_A, p_A, frame_B, p_B);
  length_ = line.length;
  const double stretch = line.length - free_length_, damping_force = damper_.value(line.rate);
  force_ = spring_.value(stretch) + damping_force;
  if (!std::isfinite(force_))
    throw ModelError(fmt::format("spring \"{}\": its force is not finite at stretch {:g} m, rate {:g} m/s",
                                 name_, stretch, line.rate));
  line.pull(force_);
  account(frame_A, frame_B, spring_.integral(stretch), damping_force * line.rate);
}

}  // namespace easydyn
