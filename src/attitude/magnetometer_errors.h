#ifndef HINDSIGHT_ATTITUDE_MAGNETOMETER_ERRORS_H_
#define HINDSIGHT_ATTITUDE_MAGNETOMETER_ERRORS_H_

#include <Eigen/Core>
#include <optional>
#include <span>

#include "attitude/field_survey.h"
#include "base/units.h"

namespace hindsight {

/// What all readings of a magnetometer have in common.
struct MagnetometerErrors {
  /// Of a magnet that travels along [uT, body axes]; zero if there is none to
  /// be believed.
  Eigen::Vector3d hard_iron_b = Eigen::Vector3d::Zero();
  /// Size of one that is too weak to be believed, which may be in the readings
  /// all the same [uT].
  double weak_iron = 0.0;
  double time_offset = 0.0;        ///< true time less the stamps' [s]
  double time_offset_sigma = 0.0;  ///< [s]
  /// That it would be, to a tenth of a second a priori, where the stamps are said
  /// to be right. For a verdict [s].
  double apparent_offset = 0.0;
  double apparent_offset_sigma = 0.0;
  /// By which the sensor's axes are turned against those of the gyros, a rotation
  /// vector in body axes: it reads Exp(turn_b) m_b. Zero if there is none to be
  /// believed. For a verdict: readings stay as they are [rad].
  Eigen::Vector3d turn_b = Eigen::Vector3d::Zero();
  /// Of an axis, by the median distance of the readings from the even field as the
  /// body moves; absent if it hardly does [uT].
  std::optional<double> scatter;
};

/// Finds them, with one even field m_n, in
///   m_b = C_bn m_n + h_b + (C_bn m_n x w_b) time_offset + noise,
/// whose noise is Student's t, scale and degrees of freedom by maximum
/// likelihood (expectation maximisation; Lange, Little and Taylor 1989). A hard
/// iron must be significant, h' P_h^-1 h above the chi-square of 99.99 %, above
/// kLeastHardIron, and nine in ten readings, by weight and by time, must be
/// nearer to the field with it than to the one without: a magnet put on for a
/// part of the time is none. A field that differs from place to place passes
/// for a weak one. A turn t, of which m_b then has t x C_bn m_n more, must be as
/// significant, and above kLeastTurn. `time_offset_sigma` is the a priori one; 0: the stamps are
/// right. The attitudes may count their heading from anywhere, but must not
/// drift by more than some degrees.
MagnetometerErrors FindMagnetometerErrors(
    std::span<const SurveyedField> readings, double time_offset_sigma = 0.0);
inline constexpr double kLeastHardIron = 5.0;  // [uT]
/// What a field that differs from place to place by some uT passes for.
inline constexpr double kLeastTurn = 4.0 * kDegree;

/// Weight in that search of a reading that follows another by dt [s] after
/// turning by `angle` [rad]: its error is a function of place and attitude, so
/// many readings at rest are one,
///   w = min(1, min(dt / 1 s, angle / 0.5 rad) + dt / 50 s).
double IndependentPart(double dt, double angle);

}  // namespace hindsight

#endif  // HINDSIGHT_ATTITUDE_MAGNETOMETER_ERRORS_H_
