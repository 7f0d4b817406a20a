#ifndef HINDSIGHT_TESTS_SUPPORT_WALKING_FOOT_H_
#define HINDSIGHT_TESTS_SUPPORT_WALKING_FOOT_H_

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/random.h"

namespace hindsight::testing {

struct Walk {
  double rate = 83.0;        ///< [Hz]
  double swing = 0.7;        ///< largest pitch of the foot [rad]
  double force_noise = 0.0;  ///< [g]
  double rate_noise = 0.0;   ///< [rad/s]
};

/// Forty steps of a second, each with half a second on the ground: forward with
/// the speed 1 - cos, pitched about y by swing sin^2(pi p) sin(2 pi p); z points
/// up.
struct WalkRows {
  std::vector<Eigen::Vector3d> accel, gyro;
};

inline WalkRows Steps(const Walk& walk, std::uint64_t seed) {
  constexpr double kStep = 1.0;
  constexpr double kStance = 0.5;
  constexpr double kSpeed = 1.5;     // m/s
  constexpr double kGravity = 9.81;  // m/s^2
  const double turn = 2.0 * std::numbers::pi / kStep;
  Random random(seed);
  WalkRows rows;
  for (int k = 0; k < static_cast<int>(60.0 * walk.rate); ++k) {
    const double t = (k + 0.5) / walk.rate;
    const double phase = std::fmod(t, kStep + kStance) - kStance;
    const bool swings = phase > 0.0;
    const double bell = std::pow(std::sin(0.5 * turn * phase), 2);
    const double angle =
        swings ? walk.swing * bell * std::sin(turn * phase) : 0.0;
    const double w = swings ? walk.swing * turn *
                                  (0.5 * std::pow(std::sin(turn * phase), 2) +
                                   bell * std::cos(turn * phase))
                            : 0.0;
    const double a =
        swings ? kSpeed * turn * std::sin(turn * phase) / kGravity : 0.0;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    rows.accel.emplace_back(Eigen::Vector3d(c * a - s, 0.0, s * a + c) +
                            walk.force_noise * random.NormalVector3());
    rows.gyro.emplace_back(Eigen::Vector3d(0.01, w - 0.02, 0.005) +
                           walk.rate_noise * random.NormalVector3());
  }
  return rows;
}

}  // namespace hindsight::testing

#endif  // HINDSIGHT_TESTS_SUPPORT_WALKING_FOOT_H_
