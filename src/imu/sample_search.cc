#include "imu/sample_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hindsight {
namespace {

/// Where t would be among regular stamps.
std::size_t Guess(const ImuStream& imu, double t) {
  const double part = (t - imu.t_begin()) / (imu.t_end() - imu.t_begin());
  const auto last = static_cast<double>(imu.samples.size() - 1);
  return static_cast<std::size_t>(std::clamp(part, 0.0, 1.0) * last);
}

}  // namespace

std::size_t FirstSampleAt(const ImuStream& imu, double t) {
  const PagedVector<ImuSample>& samples = imu.samples;
  const std::size_t count = samples.size();
  const auto before = [](const ImuSample& s, double at) { return s.t < at; };
  if (imu.empty()) {
    return count == 1 && before(samples.front(), t) ? 1 : 0;
  }
  // The answer is in [low, high]: steps from the guess, each twice as far.
  std::size_t low = Guess(imu, t);
  std::size_t high = low;
  std::size_t step = 1;
  while (low > 0 && !before(samples[low - 1], t)) {
    high = low - 1;
    low -= std::min(low, step);
    step *= 2;
  }
  if (low == high) {
    step = 1;
    while (high < count && before(samples[high], t)) {
      low = high + 1;
      high += std::min(count - high, step);
      step *= 2;
    }
  }
  const auto begin = samples.begin();
  return static_cast<std::size_t>(
      std::lower_bound(begin + static_cast<std::ptrdiff_t>(low),
                       begin + static_cast<std::ptrdiff_t>(high), t, before) -
      begin);
}

std::size_t FirstSampleAfter(const ImuStream& imu, double t) {
  return FirstSampleAt(
      imu, std::nextafter(t, std::numeric_limits<double>::infinity()));
}

}  // namespace hindsight
