#include "simulation/free_rotation.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "geometry/so3.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr std::uint64_t kRotationStream = 0x6672726f;  // of random numbers
constexpr std::uint64_t kRotationDrawStream = 0x66727264;
constexpr double kRotationStep = 0.01;         // [s]
constexpr double kRotationDuration = 90.0;     // [s]
constexpr double kRotationTurns = 20.0;        // net, about the vertical
constexpr double kRotationNods = 10.0;         // in all
constexpr double kRotationGyroSigma = 1e-3;    // of a sample [rad/s]
constexpr double kRotationAccelSigma = 0.05;   // of a sample [m/s^2]
constexpr double kRotationScaleSigma = 0.004;  // [1]
constexpr double kRotationBiasSigma = 0.005;   // [rad/s]

Eigen::Quaterniond RotationAt(double t) {
  constexpr double kLength = kFreeRotationEnd - kFreeRotationBegin;
  const double s = std::clamp((t - kFreeRotationBegin) / kLength, 0.0, 1.0);
  const double part = s - std::sin(2.0 * kPi * s) / (2.0 * kPi);
  const double nod = 0.5 * std::sin(2.0 * kPi * kRotationNods * part);
  return QuaternionFromEuler(0.6 * nod, nod, 2.0 * kPi * kRotationTurns * part);
}

}  // namespace

FreeRotationOptions DrawFreeRotation(std::uint64_t seed) {
  Random random(seed, kRotationDrawStream);
  FreeRotationOptions options;
  options.gyro_scale = kRotationScaleSigma * random.NormalVector3();
  options.gyro_bias = kRotationBiasSigma * random.NormalVector3();
  return options;
}

Dataset SimulateFreeRotation(const FreeRotationOptions& options,
                             std::uint64_t seed) {
  Random random(seed, kRotationStream);
  Dataset dataset;
  dataset.name = kFreeRotationName;
  // None: a configuration says more than zero.
  dataset.initial.accel_bias_sigma = Eigen::Vector3d::Constant(kMicroG);
  AidingStream magnetometer;
  magnetometer.sensor.name = "magnetometer";
  magnetometer.sensor.kind = &MagnetometerKind();
  const Eigen::Array3d scale = 1.0 + options.gyro_scale.array();
  const Eigen::Vector3d f_n(0.0, 0.0, -kStandardGravity);
  const int count =
      static_cast<int>(std::lround(kRotationDuration / kRotationStep));
  for (int k = 0; k <= count; ++k) {
    const double t = k * kRotationStep;
    const Eigen::Quaterniond q_nb = RotationAt(t);
    const Eigen::Vector3d w =
        Log(RotationAt(t - 0.5 * kRotationStep).conjugate() *
            RotationAt(t + 0.5 * kRotationStep)) /
        kRotationStep;
    ImuSample sample;
    sample.t = t;
    sample.gyro = (scale * w.array()).matrix() + options.gyro_bias +
                  kRotationGyroSigma * random.NormalVector3();
    sample.accel =
        q_nb.conjugate() * f_n + kRotationAccelSigma * random.NormalVector3();
    dataset.imu.samples.push_back(sample);
    const bool moves = t > kFreeRotationBegin && t < kFreeRotationEnd;
    const bool disturbed = moves && options.motion_disturbance > 0.0;
    Eigen::Vector3d field_b =
        (disturbed ? options.motion_disturbance : options.magnetic_noise) *
        random.NormalVector3();
    if (!disturbed) {
      field_b += q_nb.conjugate() *
                 (moves ? options.motion_field_n : options.rest_field_n);
    }
    magnetometer.measurements.push_back(
        {t, 0, false, MagneticField{field_b, options.magnetic_noise}});
    TruthPoint truth;
    truth.t = t;
    truth.q_nb = q_nb;
    truth.b_g = options.gyro_bias;
    dataset.truth.push_back(truth);
  }
  dataset.imu.noise.gyro_noise_density =
      kRotationGyroSigma * std::sqrt(kRotationStep);
  dataset.imu.noise.accel_noise_density =
      kRotationAccelSigma * std::sqrt(kRotationStep);
  dataset.imu.nominal_dt = kRotationStep;
  dataset.gyro_scale_sigma = Eigen::Vector3d::Constant(kRotationScaleSigma);
  dataset.streams.push_back(std::move(magnetometer));
  dataset.ahrs.accel_sigma = kRotationAccelSigma;
  dataset.ahrs.low_pass = 0.0;
  dataset.ahrs.correlation_time = 0.0;
  dataset.ahrs.rest_sigma = kRotationGyroSigma;
  return dataset;
}

}  // namespace hindsight
