#include "dataset/wheel_speed.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>
#include <vector>

#include "dataset/ground_motion.h"

namespace hindsight {
namespace {

struct WheelReading {
  double t = 0.0;
  double speed = 0.0;
};

std::vector<WheelReading> ReadingsOf(const AidingStream& wheel) {
  std::vector<WheelReading> readings;
  for (const Measurement& z : wheel.measurements) {
    const auto* odometer = std::get_if<Odometer>(&z.model);
    if (odometer != nullptr) readings.push_back({z.t, odometer->speed});
  }
  return readings;
}

WheelComparison CompareAt(double offset, const std::vector<WheelReading>& wheel,
                          const std::vector<TimedVelocity>& ground) {
  double wg = 0.0;
  double ww = 0.0;
  double gg = 0.0;
  double w_sum = 0.0;
  double g_sum = 0.0;
  double count = 0.0;
  std::size_t next = 0;
  for (const TimedVelocity& velocity : ground) {
    while (next + 1 < wheel.size() && wheel[next].t + offset < velocity.t) {
      ++next;
    }
    if (std::abs(wheel[next].t + offset - velocity.t) > 0.2) continue;
    const double w = wheel[next].speed;
    const double g = velocity.v_n.head<2>().norm();
    wg += w * g;
    ww += w * w;
    gg += g * g;
    w_sum += w;
    g_sum += g;
    count += 1.0;
  }
  if (count < 0.5 * static_cast<double>(ground.size()) || ww <= 0.0) return {};
  const double scatter =
      std::sqrt((ww - w_sum * w_sum / count) * (gg - g_sum * g_sum / count));
  if (!(scatter > 0.0)) return {};
  return {wg / ww, offset, (wg - w_sum * g_sum / count) / scatter};
}

}  // namespace

std::optional<WheelComparison> FindWheel(const AidingStream& wheel,
                                         const Dataset& dataset) {
  constexpr double kFarthest = 20.0;  // s
  constexpr double kStep = 0.05;
  constexpr double kAlike = 0.9;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<WheelReading> readings = ReadingsOf(wheel);
  const auto ground = GroundVelocities(dataset, -kInfinity, kInfinity);
  if (readings.size() < 10 || ground.size() < 10) return std::nullopt;
  WheelComparison best;
  const int steps = static_cast<int>(kFarthest / kStep);
  for (int i = -steps; i <= steps; ++i) {
    const WheelComparison here = CompareAt(i * kStep, readings, ground);
    if (std::abs(here.correlation) > std::abs(best.correlation)) best = here;
  }
  if (std::abs(best.correlation) < kAlike) return std::nullopt;
  return best;
}

}  // namespace hindsight
