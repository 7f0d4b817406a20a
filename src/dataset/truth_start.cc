#include "dataset/truth_start.h"

#include <algorithm>

#include "base/error.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "imu/preintegration.h"

namespace hindsight {
namespace {

/// Mean angular rate within 50 ms of t [rad/s].
Eigen::Vector3d RateAt(const ImuStream& imu, double t) {
  constexpr double kHalf = 0.05;
  const double from = std::max(t - kHalf, imu.t_begin());
  const double to = std::min(t + kHalf, imu.t_end());
  const Eigen::Quaterniond turn =
      ImuIntegrator(imu).Turn(from, to, Eigen::Vector3d::Zero());
  return Log(turn) / (to - from);
}

}  // namespace

void StartFromTruth(Dataset* dataset) {
  InitialState& initial = dataset->initial;
  const ImuStream& imu = dataset->imu;
  const double from =
      std::max(initial.t.value_or(imu.t_begin()), imu.t_begin());
  for (const TruthPoint& point : dataset->truth) {
    if (point.t < from || point.t >= imu.t_end()) continue;
    if (!point.p_e || !point.v_n || !point.q_nb) continue;
    const Eigen::Vector3d& l_b = dataset->truth_lever_arm_b;
    const Eigen::Vector3d w_b = RateAt(imu, point.t) - initial.gyro_bias;
    initial.t = point.t;
    if (!initial.position) {
      const Eigen::Matrix3d C_en = NedAxes(*point.p_e);
      initial.position =
          GeodeticFromEcef(*point.p_e - C_en * (*point.q_nb * l_b));
    }
    if (!initial.v_n) initial.v_n = *point.v_n - *point.q_nb * w_b.cross(l_b);
    if (!initial.euler && !initial.heading) {
      initial.euler = EulerFromQuaternion(*point.q_nb);
    }
    return;
  }
  throw InputError(
      "no point of the truth inside the IMU's record has position, velocity "
      "and attitude");
}

}  // namespace hindsight
