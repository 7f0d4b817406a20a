#ifndef HINDSIGHT_ALIGNMENT_ALIGNMENT_H_
#define HINDSIGHT_ALIGNMENT_ALIGNMENT_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/units.h"
#include "dataset/dataset.h"
#include "dataset/ground_motion.h"
#include "dataset/time_interval.h"

namespace hindsight {

/// Standard deviation of a heading of which nothing is known: uniform on a
/// circle, 360 deg/sqrt(12).
inline constexpr double kUnknownHeadingSigma = 104.0 * kDegree;

/// Gyro bias that is known beforehand, and its sigma [rad/s].
struct GyroBiasPrior {
  Eigen::Vector3d b_g;
  Eigen::Vector3d sigma;
};

/// What every alignment method sees. Biases are the best values known before
/// the attitude, with the sigma with which a gyro carries an attitude.
struct AlignmentInput {
  const Dataset& dataset;
  double t = 0.0;   ///< epoch at which the attitude is asked for [s]
  double to = 0.0;  ///< data up to here may be used [s]
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();  ///< near the vehicle [m]
  /// Position fixes and velocities over the ground, withheld ones left out.
  std::vector<TimedFix> fixes = {};
  std::vector<TimedVelocity> velocities = {};
  /// Rest that begins at t.
  std::optional<TimeInterval> rest = std::nullopt;
  Eigen::Vector3d b_g = Eigen::Vector3d::Zero();  ///< [rad/s]
  Eigen::Vector3d b_a = Eigen::Vector3d::Zero();  ///< [m/s^2]
  double gyro_sigma = 0.0;  ///< of b_g, the worst axis [rad/s]
  /// At t, by what is measured before it; absent: as the configuration says.
  std::optional<GyroBiasPrior> b_g_before = std::nullopt;
  /// The gyro biases walk at least so much [rad/s/sqrt(s)].
  double least_gyro_walk = 0.0;
};

/// b_g_before, or what the configuration says.
GyroBiasPrior GyroBiasBefore(const AlignmentInput& input);

/// An attitude at the epoch asked for.
struct AlignedAttitude {
  Eigen::Quaterniond q_nb = Eigen::Quaterniond::Identity();
  /// Covariance of psi, C_nb = Exp(psi) C_nb^, in NED axes [rad^2].
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  /// Covariance of psi with the errors of the gyro (columns 0-2) and
  /// accelerometer biases (3-5).
  Eigen::Matrix<double, 3, 6> P_bias = Eigen::Matrix<double, 3, 6>::Zero();
  /// Factor on the sigmas in the prior of an estimation that uses the same
  /// measurements again: at 10 they count twice by one per cent.
  double reuse = 1.0;
  /// Direction of travel in body axes, where the alignment has found one.
  std::optional<Eigen::Vector3d> travel_b;
  /// Gyro bias where the method estimates it, with its sigma [rad/s].
  std::optional<Eigen::Vector3d> b_g;
  Eigen::Vector3d b_g_sigma = Eigen::Vector3d::Zero();
  /// Gyro bias walk beyond the stated one that the data show; 0: they do not
  /// [rad/s/sqrt(s)].
  double gyro_bias_walk = 0.0;
  std::string attitude;  ///< how roll and pitch were found, in words
  std::string heading;   ///< how the heading was found, in words
};

/// Whether the heading is known at all.
bool TellsHeading(const AlignedAttitude& attitude);

/// By what `a` is turned against `b` (NED) [rad]; where one of them leaves the
/// heading open, after it has been turned about the vertical to the other.
Eigen::Vector3d Difference(const AlignedAttitude& a, const AlignedAttitude& b);

/// Whether two attitudes, taken as independent, are more than five sigmas
/// apart.
bool Contradict(const AlignedAttitude& a, const AlignedAttitude& b);

/// An attitude, or why there is none.
struct AlignmentOutcome {
  std::optional<AlignedAttitude> found;
  std::string reason;
};

/// One way to find an attitude. `in_auto`: a candidate where the configuration
/// names none.
struct AlignmentMethod {
  AlignmentKind kind;
  AlignmentOutcome (*align)(const AlignmentInput& input);
  bool in_auto = true;
};

/// All methods, in the order in which they are tried.
std::span<const AlignmentMethod> AlignmentMethods();

/// Name of a kind as in a configuration.
std::string AlignmentName(AlignmentKind kind);

/// What was chosen.
struct AlignmentChoice {
  AlignmentKind kind = AlignmentKind::kAuto;
  AlignedAttitude attitude;
  /// "velocity: heading to 0.3 deg; course would give 5 deg; gyrocompass: ..."
  std::string why;
};

/// Aligns by the method that Dataset::initial asks for; by default by the given
/// attitude or heading, and without one by the method whose covariance has the
/// smallest trace, by a tenth or more below those before it; none is tried
/// after one that knows all axes to 0.5 deg. Stated sigmas do not settle a
/// contradiction: where Contradict says that another candidate is in conflict
/// with that one, Judge compares how well either explains the measured motion
/// and gravity, and the loser is refuted. Where that is undecided, too, the
/// sigmas grow by what lies between them. The course is a candidate where an
/// odometer or constraint says where the vehicle's forward axis is in the body.
/// If none finds any, the first second is taken as level. Throws
/// EstimationError if the method asked for finds nothing (its reason is the
/// message).
AlignmentChoice Align(const AlignmentInput& input);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_ALIGNMENT_H_
