#include "track/contact_loss_counter.hpp"

#include <algorithm>

#include "easydyn/require.hpp"

namespace easydyn::track {

void ContactLossCounter::update(double t, bool is_closed) {
  require_finite("contact losses", "time", t, "s");
  if (has_begun_)
    require(t > t_, "contact losses", "time", t, "s", fmt::format("> {:g} s, that of the step before", t_));
  if (is_closed) {
    present_ = 0;
  } else {
    if (!is_open_) ++count_;
    if (has_begun_) {
      total_ += t - t_;
      present_ += t - t_;
      longest_ = std::max(longest_, present_);
    }
  }
  is_open_ = !is_closed;
  has_begun_ = true;
  t_ = t;
}

}  // namespace easydyn::track
