#pragma once

namespace easydyn::track {

/// Counts how often and how long a wheel is off the rail, from what each step of an integration sees.
///
/// A step counts as open if the contact is open at its end; a loss is a run of open steps. So each loss is met
/// within one step, and a loss shorter than a step may be missed.
class ContactLossCounter {
 public:
  /// To be called once per accepted step, first at the start.
  /// @param t  [s], later than at the call before
  /// @throws ModelError if time does not advance or is not finite
  void update(double t, bool is_closed);

  int count() const { return count_; }                  ///< losses so far, the present one included
  double total_duration() const { return total_; }      ///< [s]
  double longest_duration() const { return longest_; }  ///< of one loss [s]
  bool is_open() const { return is_open_; }             ///< at the last step

 private:
  bool has_begun_ = false, is_open_ = false;
  double t_ = 0;
  int count_ = 0;
  double total_ = 0, longest_ = 0, present_ = 0;
};

}  // namespace easydyn::track
