#include "alignment/gyro_drift.h"

#include <fmt/core.h>

#include <cmath>

#include "base/units.h"

namespace hindsight {

std::optional<Evidence> FindGyroDrift(
    const StartReport& start, const ImuNoise& stated,
    const std::optional<BridgedDropOut>& drop_out) {
  constexpr double kTooLarge = 2.0 * 1.778;  // sqrt(sqrt(10))
  const double found = start.gyro_bias_walk;
  if (!(found > kTooLarge * stated.gyro_bias_walk)) return std::nullopt;
  const double in_a_minute = std::sqrt(60.0) / kDegree;
  const double drift = found * in_a_minute;
  const double stated_drift = stated.gyro_bias_walk * in_a_minute;
  Evidence evidence{
      .rule = "gyro_drift",
      .grade = Grade::kDoubtful,
      .what = fmt::format(
          "the gyros drift by some {:.2g} deg/s a minute, but by {:.2g} "
          "as stated",
          drift, stated_drift),
      .value = drift,
      .limit = kTooLarge * stated_drift,
      .unit = "deg/s",
      .causes = {"a gyro that warms up"},
      .remedies = {
          fmt::format("'gyro_bias_walk: {:.2g} deg/s^2/sqrt(Hz)' in imu.noise",
                      found / kDegree)}};
  if (const auto lost = LostAttitude(drop_out)) {
    evidence.what += ", or it is " + *lost;
    evidence.causes.insert(evidence.causes.begin(), *lost);
  }
  return evidence;
}

}  // namespace hindsight
