#include "problems/iteration_progress.h"

#include <algorithm>
#include <cmath>

namespace hindsight {
namespace {

/// Rate of the steps before two of them are known, as of Gauss-Newton near the
/// solution.
constexpr double kFirstRate = 0.01;
constexpr double kSlowestRate = 0.95;

}  // namespace

void IterationProgress::Begin(int max_iterations, double later) {
  max_iterations_ = max_iterations;
  later_ = later;
  previous_ = 0.0;
}

void IterationProgress::After(int iteration, double ratio) {
  double left = 0.0;
  if (iteration > 0) {
    ++done_;
    const double rate = previous_ > 0.0
                            ? std::clamp(ratio / previous_, 1e-9, kSlowestRate)
                            : kFirstRate;
    previous_ = ratio;
    if (ratio >= 1.0) left = std::ceil(std::log(ratio) / -std::log(rate));
    left = std::min(left, static_cast<double>(max_iterations_ - iteration));
  }
  if (done_ > 0) {
    fraction_ = std::max(fraction_, done_ / (done_ + left + later_));
  }
  if (report_) report_(fraction_);
}

}  // namespace hindsight
