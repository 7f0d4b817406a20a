#ifndef HINDSIGHT_TESTS_SUPPORT_TURNED_IMU_H_
#define HINDSIGHT_TESTS_SUPPORT_TURNED_IMU_H_

#include "base/units.h"
#include "dataset/dataset.h"
#include "geometry/so3.h"
#include "measurements/sensor_kind.h"

namespace hindsight::testing {

/// The IMU of a simulated drive is put into the vehicle at another attitude:
/// q_ob turns body to vehicle axes.
inline Dataset Turned(Dataset dataset, const Eigen::Quaterniond& q_ob) {
  const Eigen::Quaterniond q_bo = q_ob.conjugate();
  for (ImuSample& sample : dataset.imu.samples) {
    sample.gyro = q_bo * sample.gyro;
    sample.accel = q_bo * sample.accel;
  }
  for (AidingStream& stream : dataset.streams) {
    stream.sensor.lever_arm_b = q_bo * stream.sensor.lever_arm_b;
  }
  for (TruthPoint& point : dataset.truth.Edited()) {
    point.q_nb = *point.q_nb * q_ob;
  }
  return dataset;
}

/// Non-holonomic constraint twice a second, 5 cm/s.
inline AidingStream Constraint(const Dataset& dataset) {
  AidingStream stream;
  stream.sensor.name = "wheels";
  stream.sensor.kind = &NonHolonomicKind();
  Odometer odometer;
  odometer.form = Odometer::Form::kNonHolonomic;
  odometer.sigma = {1.0, 0.05, 0.05};
  const int index = static_cast<int>(dataset.streams.size());
  for (double t = dataset.imu.t_begin(); t < dataset.imu.t_end(); t += 0.5) {
    stream.measurements.push_back({t, index, false, odometer});
  }
  return stream;
}

/// Vehicle from body axes, from none to upside down and backward.
inline const Eigen::Quaterniond kMountings[] = {
    Eigen::Quaterniond::Identity(), QuaternionFromEuler(0.05, -0.12, 0.09),
    QuaternionFromEuler(kPi, 0.1, -2.8), QuaternionFromEuler(-1.4, 0.6, 1.7),
    QuaternionFromEuler(0.3, -0.2, kPi)};

}  // namespace hindsight::testing

#endif  // HINDSIGHT_TESTS_SUPPORT_TURNED_IMU_H_
