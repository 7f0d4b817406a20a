#include "imu/worst_drop_out.h"

#include <fmt/core.h>

#include <cmath>

#include "base/units.h"
#include "imu/preintegration.h"

namespace hindsight {

std::optional<BridgedDropOut> WorstDropOut(const ImuStream& stream, double from,
                                           double to) {
  const ImuIntegrator integrator(stream);
  std::optional<BridgedDropOut> worst;
  for (const std::size_t k : DropOuts(stream)) {
    const double t = stream.samples[k - 1].t;
    if (t < from || stream.samples[k].t > to) continue;
    const LinearRates rates = integrator.RatesOfInterval(k);
    const double sigma = std::sqrt(BridgeNoise(rates).gyro * rates.dt);
    if (!worst || sigma > worst->attitude_sigma) worst = {t, rates.dt, sigma};
  }
  return worst;
}

std::optional<std::string> LostAttitude(
    const std::optional<BridgedDropOut>& drop_out) {
  constexpr double kKnown = 20.0 * kDegree;
  if (!drop_out || drop_out->attitude_sigma < kKnown) return std::nullopt;
  return fmt::format(
      "the IMU's drop-out of {:.3g} s at {:.1f} s, in which the attitude is "
      "lost to {:.2g} deg",
      drop_out->length, drop_out->t, drop_out->attitude_sigma / kDegree);
}

}  // namespace hindsight
