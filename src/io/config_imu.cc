#include <cmath>

#include "base/units.h"
#include "io/config_streams.h"

namespace hindsight {
namespace {

Eigen::RowVector3d ReadAxis(ConfigMap* imu, const std::string& text) {
  const bool negative = text.starts_with('-');
  const std::string letter =
      text.substr(negative || text.starts_with('+') ? 1 : 0);
  if (letter != "x" && letter != "y" && letter != "z") {
    imu->Fail("axes", "'" + text +
                          "' is no axis; expected x, y or z, with - "
                          "where it points the other way");
  }
  Eigen::RowVector3d row = Eigen::RowVector3d::Zero();
  row(letter[0] - 'x') = negative ? -1.0 : 1.0;
  return row;
}

void ReadBias(ConfigMap* noise, const std::string& sensor, Quantity walk_unit,
              Quantity bias_unit, double* walk, double* tau) {
  const std::string walk_key = sensor + "_bias_walk";
  const std::string sigma_key = sensor + "_bias_sigma";
  const std::string tau_key = sensor + "_bias_tau";
  if (!noise->Has(tau_key) && !noise->Has(sigma_key)) {
    *walk = noise->Number(walk_key, walk_unit, 0.0);
    if (*walk < 0.0) noise->Fail(walk_key, "must not be negative");
    return;
  }
  if (noise->Has(walk_key)) {
    noise->Fail(walk_key, "does not go with " + sigma_key + " and " + tau_key);
  }
  *tau = noise->Positive(tau_key, Quantity::kTime);
  const double sigma = noise->Positive(sigma_key, bias_unit);
  *walk = std::sqrt(2.0 / *tau) * sigma;
}

}  // namespace

Eigen::Matrix3d ReadMounting(ConfigMap* imu) {
  Eigen::Matrix3d C_bs = Eigen::Matrix3d::Identity();
  const std::vector<std::string> axes = imu->List("axes");
  if (!axes.empty()) {
    if (axes.size() != 3) imu->Fail("axes", "expected three axes");
    for (std::size_t i = 0; i < 3; ++i) {
      C_bs.row(static_cast<Eigen::Index>(i)) = ReadAxis(imu, axes[i]);
    }
    if (std::abs(C_bs.determinant() - 1.0) > 0.5) {
      imu->Fail("axes",
                "are not a rotation; expected each axis once and right-handed "
                "(a sensor with a mirrored axis needs a sign in `columns`)");
    }
  }
  const Eigen::Vector3d euler =
      imu->Vector("mounting", Quantity::kAngle, Eigen::Vector3d::Zero());
  RequireTurns(imu, "mounting", euler);
  return QuaternionFromEuler(euler.x(), euler.y(), euler.z())
             .toRotationMatrix() *
         C_bs;
}

ImuNoise ReadImuNoise(ConfigMap* imu) {
  if (!imu->Has("noise")) imu->Fail("noise", "is missing");
  ConfigMap map = imu->Map("noise");
  ImuNoise noise;
  noise.gyro_noise_density = map.Positive("gyro", Quantity::kGyroNoiseDensity);
  noise.accel_noise_density =
      map.Positive("accel", Quantity::kAccelNoiseDensity);
  ReadBias(&map, "gyro", Quantity::kGyroBiasWalk, Quantity::kAngularRate,
           &noise.gyro_bias_walk, &noise.gyro_bias_tau);
  ReadBias(&map, "accel", Quantity::kAccelBiasWalk, Quantity::kAcceleration,
           &noise.accel_bias_walk, &noise.accel_bias_tau);
  noise.gyro_noise_per_rate =
      map.Number("gyro_per_rate", Quantity::kNoisePerRate, 0.0);
  if (noise.gyro_noise_per_rate < 0.0) {
    map.Fail("gyro_per_rate", "must not be negative");
  }
  map.Finish();
  return noise;
}

}  // namespace hindsight
