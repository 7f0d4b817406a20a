#include "base/step_fraction.h"

#include <algorithm>

namespace hindsight {

void StepFraction::Take(double seconds, double fraction) {
  /// Less of a pass says nothing of its length.
  constexpr double kLeastFraction = 0.02;
  if (fraction < last_fraction_) {
    longest_ = std::max(longest_, last_seconds_ - pass_begin_);
    pass_begin_ = last_seconds_;
  }
  last_seconds_ = seconds;
  last_fraction_ = fraction;
  const double elapsed = seconds - pass_begin_;
  const double pass = std::max(
      longest_, fraction < kLeastFraction ? elapsed : elapsed / fraction);
  if (!(pass > 0.0)) return;
  const double done = seconds / pass;
  const double rest =
      fraction < 1.0 ? 1.0 - std::min(elapsed / pass, fraction) : 0.0;
  now_ = done / (done + rest + more_passes_);
  most_ = std::max(most_, now_);
}

}  // namespace hindsight
