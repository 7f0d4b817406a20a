#ifndef HINDSIGHT_TESTS_SUPPORT_TEST_MOTION_H_
#define HINDSIGHT_TESTS_SUPPORT_TEST_MOTION_H_

#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "imu/imu_link.h"
#include "imu/preintegration.h"

namespace hindsight::testing {

/// An IMU record of lively smooth motion about level flight: rates up to
/// 0.5 rad/s on all axes, specific forces around gravity.
inline ImuStream LivelyImu(double duration, double rate,
                           const ImuNoise& noise = {}) {
  ImuStream stream;
  stream.noise = noise;
  const int count = static_cast<int>(std::lround(duration * rate)) + 1;
  for (int k = 0; k < count; ++k) {
    const double t = k / rate;
    ImuSample s;
    s.t = t;
    s.gyro = {0.3 * std::sin(1.1 * t), 0.4 * std::cos(0.7 * t),
              0.5 * std::sin(0.9 * t + 0.4)};
    s.accel = {1.5 * std::sin(0.5 * t), 2.0 * std::cos(0.8 * t),
               -9.8 + 0.7 * std::sin(1.7 * t)};
    stream.samples.push_back(s);
  }
  return stream;
}

inline State TypicalState() {
  State x = MakeState(0.0, {37.0 * kDegree, 127.0 * kDegree, 50.0},
                      {12.0, -7.0, 0.5}, {0.1, -0.2, 2.1});
  x.b_g = {1e-3, -2e-3, 1.5e-3};
  x.b_a = {0.02, 0.03, -0.05};
  return x;
}

/// Prior of a tactical navigation problem, all components different.
inline ErrorLayout TypicalLayout(const ImuNoise& noise = {}) {
  NavigationPrior prior;
  prior.position_sigma = {1.0, 1.5, 2.0};
  prior.velocity_sigma = {0.1, 0.2, 0.3};
  prior.attitude_sigma = {0.5 * kDegree, 0.6 * kDegree, 1.0 * kDegree};
  prior.gyro_bias_sigma = Eigen::Vector3d::Constant(5e-4);
  prior.accel_bias_sigma = Eigen::Vector3d::Constant(0.02);
  prior.gyro_bias = noise.GyroBiasEvolution();
  prior.accel_bias = noise.AccelBiasEvolution();
  return NavigationLayout(prior);
}

/// Layout with scale factors of the IMU and calibration blocks of sensor 0.
inline ErrorLayout RichLayout(const ImuNoise& noise = {}) {
  ErrorLayout layout = TypicalLayout(noise);
  const auto add = [&layout](BlockKind kind, int sensor, const char* name,
                             double sigma, const Evolution& evolution) {
    Block block;
    block.key = {kind, sensor};
    block.name = name;
    block.unit = "1";
    block.evolution = evolution;
    block.sigma0.setConstant(sigma);
    layout.Add(block);
  };
  add(BlockKind::kGyroScale, BlockKey::kNoSensor, "gyro_scale", 1e-3,
      Evolution::Constant());
  add(BlockKind::kAccelScale, BlockKey::kNoSensor, "accel_scale", 1e-3,
      Evolution::Constant());
  add(BlockKind::kLeverArm, 0, "gnss_lever_arm", 0.1, Evolution::Constant());
  add(BlockKind::kTimeOffset, 0, "gnss_time_offset", 0.02,
      Evolution::Constant());
  add(BlockKind::kColouredNoise, 0, "gnss_noise", 0.5,
      Evolution::GaussMarkov(0.5, 20.0));
  add(BlockKind::kOffset, 0, "height_offset", 0.5, Evolution::RandomWalk(0.01));
  return layout;
}

inline ErrorVector RandomError(const ErrorLayout& layout, Random* random,
                               double size) {
  ErrorVector d(layout.dim());
  for (int i = 0; i < layout.dim(); ++i) d(i) = size * random->Normal();
  return d;
}

}  // namespace hindsight::testing

#endif  // HINDSIGHT_TESTS_SUPPORT_TEST_MOTION_H_
