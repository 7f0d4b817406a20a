#ifndef HINDSIGHT_TESTS_SUPPORT_SHUTTLE_FLIGHT_H_
#define HINDSIGHT_TESTS_SUPPORT_SHUTTLE_FLIGHT_H_

#include <cmath>
#include <numbers>

#include "base/random.h"
#include "base/units.h"
#include "earth/wgs84.h"
#include "measurements/sensor_kind.h"
#include "simulation/scenario.h"

namespace hindsight {

struct ShuttleOptions {
  double duration = 40.0;
  double period = 2.7;     ///< [s]
  double amplitude = 1.0;  ///< [m]
  /// How much period and amplitude wander from one turning point to the next,
  /// a share; and the drift of the place in a second [m], of the heading in a
  /// second [rad].
  double irregularity = 0.1;
  double drift = 0.1;
  double turning = 1.0 * kDegree;
};

/// A multirotor that flies to and fro along a line: it leans as it accelerates,
/// f_b along -z. IMU at 100 Hz with the noise of a consumer unit on rotors,
/// positions of 10 cm at 10 Hz ("gnss"), nothing known of the attitude.
inline Scenario ShuttleFlight(const ShuttleOptions& options,
                              std::uint64_t seed) {
  constexpr double kStep = 0.05;
  const Geodetic home = {47.0 * kDegree, 8.0 * kDegree, 500.0};
  Random random(seed, 5000);
  Scenario s;
  s.name = "shuttle";
  s.start = home;
  s.imu_kind = ImuStream::Kind::kRates;
  s.imu_rate_hz = 100.0;
  s.imu.noise.gyro_noise_density = 0.1 * kDegree;
  s.imu.noise.accel_noise_density = 0.06;
  s.imu.gyro_bias =
      0.3 * kDegree *
      Eigen::Vector3d(random.Normal(), random.Normal(), random.Normal());
  s.imu.accel_bias =
      0.1 * Eigen::Vector3d(random.Normal(), random.Normal(), random.Normal());
  // Half swings of cosines; the wandering of period and amplitude enters where
  // the vehicle stands still.
  const double line = 2.0 * std::numbers::pi * random.Uniform();
  double heading = 2.0 * std::numbers::pi * random.Uniform();
  double phase = 0.0, half = 0.5 * options.period;
  double swing = 2.0 * options.amplitude;
  double from = -options.amplitude;
  double direction = 1.0;
  double east_drift = 0.0, north_drift = 0.0;
  Eigen::Vector3d drift_v = Eigen::Vector3d::Zero();
  double turn_rate = 0.0;
  const double tau = std::exp(-kStep / 2.0);
  const double kick = std::sqrt(1.0 - tau * tau);
  const double radius = 6.37e6;
  for (double t = 0.0; t < options.duration; t += kStep) {
    const double w = std::numbers::pi / half;
    const double x =
        from + direction * 0.5 * swing * (1.0 - std::cos(w * phase));
    const double v = direction * 0.5 * swing * w * std::sin(w * phase);
    const double a = direction * 0.5 * swing * w * w * std::cos(w * phase);
    const Eigen::Vector3d along(std::cos(line), std::sin(line), 0.0);
    ProfilePoint point;
    point.t = t;
    point.position = {home.latitude + (x * along.x() + north_drift) / radius,
                      home.longitude + (x * along.y() + east_drift) /
                                           (radius * std::cos(home.latitude)),
                      home.height};
    point.v_n = v * along + drift_v;
    const double forward = a * std::cos(line - heading);
    const double right = a * std::sin(line - heading);
    point.euler = {std::atan(right / kStandardGravity),
                   -std::atan(forward / kStandardGravity), WrapAngle(heading)};
    s.profile.push_back(point);
    for (double* drift : {&drift_v.x(), &drift_v.y()}) {
      *drift = tau * *drift + kick * options.drift * random.Normal();
    }
    turn_rate = tau * turn_rate + kick * options.turning * random.Normal();
    north_drift += kStep * drift_v.x();
    east_drift += kStep * drift_v.y();
    heading += kStep * turn_rate;
    phase += kStep;
    if (phase < half) continue;
    phase -= half;
    from += direction * swing;
    direction = -direction;
    const double irregular = options.irregularity;
    half = 0.5 * options.period * std::exp(irregular * random.Normal());
    swing = 2.0 * options.amplitude * std::exp(irregular * random.Normal());
  }
  AidingModel gnss(PositionKind());
  gnss.sensor.name = "gnss";
  gnss.rate_hz = 10.0;
  gnss.sigma = Eigen::Vector3d::Constant(0.1);
  s.aiding.push_back(gnss);
  return s;
}

/// The stamps of a stream are late by so much from here on [s].
inline void Delay(double late, AidingStream* stream) {
  for (Measurement& z : stream->measurements.Edited()) {
    z.t += late;
    if (auto* odometer = std::get_if<Odometer>(&z.model)) {
      odometer->t_from += late;
    }
  }
}

/// One seed of it, the positions late; the data set gives their time offset as
/// 0 with the a priori sigma.
inline Dataset LateShuttle(const ShuttleOptions& options, std::uint64_t seed,
                           double late, double sigma) {
  Dataset dataset = Simulate(ShuttleFlight(options, seed), seed);
  Delay(late, &dataset.streams[0]);
  dataset.streams[0].sensor.time_offset_sigma = sigma;
  dataset.initial = {};
  dataset.initial.gyro_bias_sigma = Eigen::Vector3d::Constant(kDegree);
  dataset.initial.accel_bias_sigma = Eigen::Vector3d::Constant(0.3);
  return dataset;
}

}  // namespace hindsight

#endif  // HINDSIGHT_TESTS_SUPPORT_SHUTTLE_FLIGHT_H_
