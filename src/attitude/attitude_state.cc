#include "attitude/attitude_state.h"

#include "earth/wgs84.h"

namespace hindsight {

AttitudePlace PlaceOnEarth(const Eigen::Vector3d& p_e) {
  return {p_e, Gravity(p_e).norm(), NedAxes(p_e).transpose() * EarthRate_e()};
}

ErrorLayout AttitudeLayout(const ImuNoise& noise, const AttitudeState& start) {
  ErrorLayout layout;
  Block attitude;
  attitude.key = {BlockKind::kAttitude};
  attitude.name = "attitude";
  attitude.unit = "rad";
  attitude.evolution = Evolution::Navigation();
  attitude.sigma0 = start.P.diagonal().head<3>().cwiseSqrt();
  layout.Add(attitude);
  Block bias;
  bias.key = {BlockKind::kGyroBias};
  bias.name = "gyro_bias";
  bias.unit = "rad/s";
  bias.evolution = noise.GyroBiasEvolution();
  bias.sigma0 =
      start.P.diagonal().segment<3>(AttitudeState::kGyroBias).cwiseSqrt();
  layout.Add(bias);
  Block scale;
  scale.key = {BlockKind::kGyroScale};
  scale.name = "gyro_scale";
  scale.unit = "1";
  scale.evolution = Evolution::Constant();
  scale.sigma0 =
      start.P.diagonal().segment<3>(AttitudeState::kGyroScale).cwiseSqrt();
  layout.Add(scale);
  Block accel_bias;
  accel_bias.key = {BlockKind::kAccelBias};
  accel_bias.name = "accel_bias";
  accel_bias.unit = "m/s^2";
  accel_bias.evolution = noise.AccelBiasEvolution();
  accel_bias.sigma0 =
      start.P.diagonal().segment<3>(AttitudeState::kAccelBias).cwiseSqrt();
  layout.Add(accel_bias);
  return layout;
}

}  // namespace hindsight
