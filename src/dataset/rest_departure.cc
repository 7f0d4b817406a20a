#include "dataset/rest_departure.h"

#include <cmath>

#include "dataset/speed_evidence.h"

namespace hindsight {

double GatheredSigma(const ImuNoise& noise, double tau, double T) {
  return std::sqrt(
      std::pow(noise.accel_noise_density, 2) * (tau + tau * tau / T) +
      std::pow(noise.accel_bias_walk, 2) * tau * tau * (tau + T) / 3.0);
}

std::size_t DepartedCells(std::span<const ImuCell> rest, int step,
                          const ImuNoise& noise, const ExcludedMotion& aiding) {
  constexpr double kSigmas = 4.0;
  Eigen::Vector3d all_v = Eigen::Vector3d::Zero();
  double all_T = 0.0;
  for (const ImuCell& cell : rest) {
    if (!cell.quiet) return 0;
    all_v += cell.length() * cell.f;
    all_T += cell.length();
  }
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  double tau = 0.0;
  double most = 1.0;
  std::size_t departed = 0;
  for (std::size_t n = 1; n < rest.size(); ++n) {
    const ImuCell& cell = step > 0 ? rest[rest.size() - n] : rest[n - 1];
    v += cell.length() * cell.f;
    tau += cell.length();
    const double T = all_T - tau;
    if (T < tau) break;
    const double gathered = (v - tau / T * (all_v - v)).norm();
    const double ratio =
        gathered / (kKnownSpeed + kSigmas * GatheredSigma(noise, tau, T));
    if (ratio <= most) continue;
    const TimeInterval end = step > 0
                                 ? TimeInterval{cell.begin, rest.back().end}
                                 : TimeInterval{rest.front().begin, cell.end};
    if (2.0 * aiding.PossibleSpeed(end) < 0.5 * gathered) continue;
    most = ratio;
    departed = n;
  }
  return departed;
}

}  // namespace hindsight
