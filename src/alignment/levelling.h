#ifndef HINDSIGHT_ALIGNMENT_LEVELLING_H_
#define HINDSIGHT_ALIGNMENT_LEVELLING_H_

#include "alignment/alignment.h"
#include "imu/imu_stream.h"

namespace hindsight {

/// Levels by the mean specific force over the rest at input.t:
///   roll = atan2(-f_y, -f_z),  pitch = atan2(f_x, |f_yz|),
/// heading zero with kUnknownHeadingSigma. An accelerometer bias db_a turns
/// into tilt, psi_N = +(C_nb db_a)_E / g and psi_E = -(C_nb db_a)_N / g: P and
/// P_bias say so, with 0.05 deg of sway on top. Without rest the first second
/// is levelled and 5 deg assumed.
AlignedAttitude LevelAttitude(const AlignmentInput& input);

/// Turns a levelled attitude about the vertical to `heading` [rad], with a
/// standard deviation independent of the tilt.
void TurnToHeading(double heading, double sigma, AlignedAttitude* attitude);

/// Method `static`: LevelAttitude at rest, heading left open.
AlignmentOutcome AlignAtRest(const AlignmentInput& input);

/// Gyro bias from the mean rate at rest, whose sigma counts as noise the
/// unknown direction of the Earth's rate and drift, the difference between the
/// means of both halves of the rest where that stands out of their noise,
///   s^2 = density^2 / T + w_ie^2 + drift^2,
/// and the a priori value b_0 +- s_0, weighted by their information:
///   1/sigma^2 = 1/s_0^2 + 1/s^2,   b_g = sigma^2 (b_0/s_0^2 + mean/s^2).
GyroBiasPrior GyroBiasAtRest(const Dataset& dataset, const TimeInterval& rest);

/// The difference between the means of both halves of a rest, the worst axis,
/// if it is more than three sigmas of what noise and stated walk q allow,
///   s^2 = 4 density^2 / T + q^2 T / 3,
/// and 0 otherwise [rad/s].
double DriftAtRest(const ImuStream& imu, const TimeInterval& rest);

/// Gyro bias at the end of a rest: GyroBiasAtRest over all of it, or where the
/// bias drifts over the last half, quarter, ... of at least 2 s in which no
/// drift stands out, with the uncertainty of the drift in it.
GyroBiasPrior GyroBiasAfterRest(const Dataset& dataset, TimeInterval rest);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_LEVELLING_H_
