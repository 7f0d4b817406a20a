#include "alignment/course.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "alignment/levelling.h"
#include "geometry/so3.h"
#include "imu/preintegration.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr double kCourseSpeed = 3.0;  // [m/s]
// A few degrees of side slip and of antenna sway are not in a velocity's sigma.
constexpr double kSideSlip = 3.0 * kDegree;

double MountingYawSigma(const Dataset& dataset) {
  double sigma = 0.0;
  for (const AidingStream& stream : dataset.streams) {
    if (stream.sensor.mounting_sigma) {
      sigma = std::max(sigma, stream.sensor.mounting_sigma->z());
    }
  }
  return sigma;
}

/// The vehicle's forward axis in the body. It is the IMU's x axis where the
/// configuration asks for the course; by itself nothing says that the IMU was
/// put in that way but a sensor or constraint of the vehicle.
std::optional<Eigen::Vector3d> ForwardAxis(const Dataset& dataset) {
  for (const AidingStream& stream : dataset.streams) {
    if (stream.sensor.kind->of_vehicle) {
      return stream.sensor.q_sb.conjugate() * Eigen::Vector3d::UnitX();
    }
  }
  if (dataset.initial.alignment == AlignmentKind::kCourse) {
    return Eigen::Vector3d::UnitX();
  }
  return std::nullopt;
}

}  // namespace

AlignmentOutcome AlignByCourse(const AlignmentInput& input) {
  const std::optional<Eigen::Vector3d> forward_b = ForwardAxis(input.dataset);
  if (!forward_b) {
    return {std::nullopt,
            "no odometer or constraint says where forward is in the IMU"};
  }
  const auto moves = [&](const TimedVelocity& v) {
    return v.t >= input.t && v.t <= input.to &&
           v.v_n.head<2>().norm() >= std::max(kCourseSpeed, 10.0 * v.sigma);
  };
  const auto first =
      std::find_if(input.velocities.begin(), input.velocities.end(), moves);
  if (first == input.velocities.end()) {
    return {std::nullopt, "no motion above 3 m/s"};
  }
  const double speed = first->v_n.head<2>().norm();
  const double course = std::atan2(first->v_n.y(), first->v_n.x());
  AlignedAttitude out = LevelAttitude(input);
  ImuCalibration calibration;
  calibration.b_g = input.b_g;
  ImuIntegrator integrator(input.dataset.imu);
  const ImuSummary summary =
      integrator.Summarize(input.t, first->t, calibration);
  const Eigen::Vector3d forward = out.q_nb * summary.dR * *forward_b;
  const double turned = std::atan2(forward.y(), forward.x());
  const double elapsed = first->t - input.t;
  const double drift = std::hypot(
      input.gyro_sigma * elapsed,
      input.dataset.imu.noise.gyro_noise_density * std::sqrt(elapsed));
  const double sigma =
      std::min(std::hypot(std::hypot(kSideSlip, first->sigma / speed, drift),
                          MountingYawSigma(input.dataset)),
               kUnknownHeadingSigma);
  TurnToHeading(WrapAngle(course - turned), sigma, &out);
  out.heading = fmt::format(
      "course at t = {:.2f} s ({:.1f} m/s), carried back by the gyros",
      first->t, speed);
  return {out, ""};
}

}  // namespace hindsight
