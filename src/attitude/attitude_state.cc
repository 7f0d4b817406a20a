#include "attitude/attitude_state.h"

#include "earth/wgs84.h"

namespace hindsight {

AttitudePlace PlaceOnEarth(const Eigen::Vector3d& p_e) {
  return {p_e, Gravity(p_e).norm(), NedAxes(p_e).transpose() * EarthRate_e()};
}

namespace {

Block BlockOf(BlockKind kind, const char* name, const char* unit,
              const Evolution& evolution, const AttitudeState& start,
              int begin) {
  Block block;
  block.key = {kind};
  block.name = name;
  block.unit = unit;
  block.evolution = evolution;
  block.sigma0 = start.P.diagonal().segment<3>(begin).cwiseSqrt();
  return block;
}

}  // namespace

ErrorLayout AttitudeLayout(const ImuNoise& noise, const AttitudeState& start) {
  ErrorLayout layout;
  layout.Add(BlockOf(BlockKind::kAttitude, "attitude", "rad",
                     Evolution::Navigation(), start, 0));
  layout.Add(BlockOf(BlockKind::kGyroBias, "gyro_bias", "rad/s",
                     noise.GyroBiasEvolution(), start,
                     AttitudeState::kGyroBias));
  layout.Add(BlockOf(BlockKind::kGyroScale, "gyro_scale", "1",
                     Evolution::Constant(), start, AttitudeState::kGyroScale));
  layout.Add(BlockOf(BlockKind::kAccelBias, "accel_bias", "m/s^2",
                     noise.AccelBiasEvolution(), start,
                     AttitudeState::kAccelBias));
  return layout;
}

}  // namespace hindsight
