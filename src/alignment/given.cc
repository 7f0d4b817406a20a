#include "alignment/given.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "alignment/levelling.h"
#include "base/error.h"
#include "geometry/so3.h"

namespace hindsight {

double GivenStartTime(const Dataset& dataset, double from, double to) {
  const InitialState& given = dataset.initial;
  if (!given.t) return from;
  const double slack = 2.0 * dataset.imu.nominal_dt;
  const bool moves = given.position || given.v_n || given.euler;
  if (*given.t >= to || (moves && *given.t < from - slack)) {
    throw InputError("initial.time is " + std::to_string(*given.t) +
                     " s; expected a time inside the interval, " +
                     std::to_string(from) + " to " + std::to_string(to) + " s");
  }
  return std::max(*given.t, from);
}

namespace {

constexpr double kGivenTiltSigma = 1.0 * kDegree;
constexpr double kGivenHeadingSigma = 2.0 * kDegree;

/// Axes in NED about which roll, pitch and heading turn.
Eigen::Matrix3d EulerAxes(const Eigen::Vector3d& euler) {
  Eigen::Matrix3d M;
  M.col(0) =
      QuaternionFromEuler(0.0, euler.y(), euler.z()) * Eigen::Vector3d::UnitX();
  M.col(1) =
      QuaternionFromEuler(0.0, 0.0, euler.z()) * Eigen::Vector3d::UnitY();
  M.col(2) = Eigen::Vector3d::UnitZ();
  return M;
}

}  // namespace

Eigen::Matrix3d AttitudeCovariance(const Eigen::Vector3d& euler,
                                   const Eigen::Vector3d& sigma) {
  const Eigen::Matrix3d M = EulerAxes(euler);
  return M * sigma.cwiseAbs2().asDiagonal() * M.transpose();
}

AlignmentOutcome AlignAsGiven(const AlignmentInput& input) {
  const InitialState& initial = input.dataset.initial;
  AlignedAttitude out;
  if (initial.euler) {
    const Eigen::Vector3d& euler = *initial.euler;
    out.q_nb = QuaternionFromEuler(euler.x(), euler.y(), euler.z());
    out.P = AttitudeCovariance(
        euler, initial.attitude_sigma.value_or(Eigen::Vector3d(
                   kGivenTiltSigma, kGivenTiltSigma, kGivenHeadingSigma)));
    out.attitude = "given";
  } else if (initial.heading) {
    out = LevelAttitude(input);
    TurnToHeading(*initial.heading,
                  initial.attitude_sigma ? initial.attitude_sigma->z()
                                         : kGivenHeadingSigma,
                  &out);
  } else {
    return {std::nullopt, "neither attitude nor heading is given"};
  }
  out.heading = "given";
  return {out, ""};
}

}  // namespace hindsight
