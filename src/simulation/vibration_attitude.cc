#include "simulation/vibration_attitude.h"

#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "geometry/so3.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr std::uint64_t kStream = 0x76696272;  // of random numbers
constexpr double kDuration = 60.0;             // [s]
constexpr double kStepTime = 0.1;              // [s]
constexpr double kGyroSigma = 0.1 * kDegree;   // of a sample [rad/s]
constexpr double kGyroBiasSigma = 10.0 * kDegree / kHour;  // [rad/s]
constexpr double kAccelSigma = 0.03 * 9.80665;             // of a sample
constexpr double kMagneticSigma = 0.3;                     // of a sample [uT]
constexpr double kAttitudeSigma = 2.0 * kDegree;           // an axis [rad]

/// Euler's equations of a free body and the attitude, by midpoint steps of
/// 1 ms.
class FreeBody {
 public:
  explicit FreeBody(const Eigen::Quaterniond& q_nb) : q_nb_(q_nb) {}

  void Advance(double dt) {
    const int steps = static_cast<int>(std::lround(dt / kStep));
    for (int i = 0; i < steps; ++i) {
      const Eigen::Vector3d middle = w_ + 0.5 * kStep * Derivative(w_);
      q_nb_ = (q_nb_ * Exp(kStep * middle)).normalized();
      w_ += kStep * Derivative(middle);
    }
  }
  const Eigen::Vector3d& w_b() const { return w_; }
  const Eigen::Quaterniond& q_nb() const { return q_nb_; }

 private:
  static constexpr double kStep = 1e-3;
  Eigen::Vector3d Derivative(const Eigen::Vector3d& w) const {
    return inertia_.cwiseProduct(w).cross(w).cwiseQuotient(inertia_);
  }
  Eigen::Vector3d inertia_{1.0, 1.3, 1.6};  // principal moments, any unit
  Eigen::Vector3d w_ = Eigen::Vector3d(20.0, 30.0, 40.0) * kDegree;
  Eigen::Quaterniond q_nb_;
};

/// Acceleration of the body at a sample, body axes.
Eigen::Vector3d Disturbance(const VibrationAttitudeOptions& options, double t,
                            const Eigen::Quaterniond& q_nb, Random* random) {
  constexpr double kEarly = 1e-9;
  const bool accelerates = t >= 5.0 - kEarly && t < 10.0 - kEarly;
  const bool vibrates = t >= 40.0 - kEarly && t < 45.0 - kEarly;
  if (!accelerates && !vibrates) return Eigen::Vector3d::Zero();
  if (vibrates && !options.vibration_along_axis) {
    return options.vibration_sigma * random->NormalVector3();
  }
  Eigen::Vector3d size = Eigen::Vector3d::Constant(options.acceleration);
  if (vibrates) size = options.vibration_sigma * random->NormalVector3();
  if (options.axis == "body_xyz") return size;
  if (options.axis == "body_x") return {size.x(), 0.0, 0.0};
  const Eigen::Vector3d a_n = options.axis == "up"
                                  ? Eigen::Vector3d(0.0, 0.0, -size.x())
                                  : Eigen::Vector3d(size.x(), 0.0, 0.0);
  return q_nb.conjugate() * a_n;
}

AidingStream Magnetometer() {
  AidingStream stream;
  stream.sensor.name = "magnetometer";
  stream.sensor.kind = &MagnetometerKind();
  stream.sensor.magnetic.horizontal = 30.0;
  stream.sensor.magnetic.down = 40.0;
  return stream;
}

}  // namespace

const std::vector<std::string>& VibrationAxes() {
  static const std::vector<std::string> kAxes = {"north", "body_x", "body_xyz",
                                                 "up"};
  return kAxes;
}

Dataset SimulateVibrationAttitude(const VibrationAttitudeOptions& options,
                                  std::uint64_t seed) {
  Random random(seed, kStream);
  constexpr double dt = kStepTime;
  const Eigen::Vector3d g_n(0.0, 0.0, kStandardGravity);
  const Eigen::Vector3d b_g = kGyroBiasSigma * random.NormalVector3();
  FreeBody body(QuaternionFromEuler(0.1, -0.2, 0.5));
  Dataset dataset;
  dataset.name = kVibrationAttitudeName;
  AidingStream magnetometer = Magnetometer();
  const Eigen::Vector3d m_n(magnetometer.sensor.magnetic.horizontal, 0.0,
                            magnetometer.sensor.magnetic.down);
  dataset.initial.euler = EulerFromQuaternion(
      Exp(kAttitudeSigma * random.NormalVector3()) * body.q_nb());
  dataset.initial.attitude_sigma = Eigen::Vector3d::Constant(kAttitudeSigma);
  dataset.initial.gyro_bias_sigma = Eigen::Vector3d::Constant(kGyroBiasSigma);
  // None: a configuration says more than zero.
  dataset.initial.accel_bias_sigma = Eigen::Vector3d::Constant(kMicroG);
  const int count = static_cast<int>(std::lround(kDuration / dt));
  for (int k = 0; k <= count; ++k) {
    if (k > 0) body.Advance(dt);
    const double t = k * dt;
    const Eigen::Quaterniond q_bn = body.q_nb().conjugate();
    ImuSample sample;
    sample.t = t;
    sample.gyro = body.w_b() + b_g + kGyroSigma * random.NormalVector3();
    // One draw a statement: compilers differ in the order within one.
    const Eigen::Vector3d noise = kAccelSigma * random.NormalVector3();
    sample.accel =
        Disturbance(options, t, body.q_nb(), &random) - q_bn * g_n + noise;
    dataset.imu.samples.push_back(sample);
    const Eigen::Vector3d field_b =
        q_bn * m_n + kMagneticSigma * random.NormalVector3();
    magnetometer.measurements.push_back(
        {t, 0, false,
         MagneticField{field_b, kMagneticSigma, MagneticField::Form::kVector}});
    TruthPoint truth;
    truth.t = t;
    truth.q_nb = body.q_nb();
    truth.b_g = b_g;
    dataset.truth.push_back(truth);
  }
  // White samples that the trapezoidal rule integrates: sigma^2 dt^2 a step.
  dataset.imu.noise.gyro_noise_density = kGyroSigma * std::sqrt(dt);
  dataset.imu.noise.accel_noise_density = kAccelSigma * std::sqrt(dt);
  dataset.imu.nominal_dt = dt;
  dataset.gyro_scale_sigma = Eigen::Vector3d::Zero();
  dataset.streams.push_back(std::move(magnetometer));
  dataset.ahrs.accel_sigma = kAccelSigma;
  dataset.ahrs.low_pass = 0.0;
  dataset.ahrs.correlation_time = 0.0;
  dataset.ahrs.rest_sigma = 0.0;
  dataset.ahrs.reject_disturbances = false;
  dataset.ahrs.survey = false;
  return dataset;
}

}  // namespace hindsight
