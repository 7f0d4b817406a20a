#ifndef HINDSIGHT_ATTITUDE_FIELD_SURVEY_H_
#define HINDSIGHT_ATTITUDE_FIELD_SURVEY_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <span>
#include <vector>

namespace hindsight {

/// A magnetometer's reading and the attitude at that time.
struct SurveyedField {
  double t = 0.0;
  Eigen::Quaterniond q_nb;
  Eigen::Vector3d field_b;  ///< [uT]
  double dt = 0.0;          ///< since the reading before [s]
  bool at_rest = false;
};

struct SurveyOptions {
  /// Error of a reading per axis [uT], which goes on for correlation_time [s]
  /// while the body rests.
  double sigma = 3.5;
  double correlation_time = 1.0;
  /// False: no reading is disturbed.
  bool reject = true;
  /// Whether the attitudes share an error of heading at most.
  bool heading_known = false;
};

/// The undisturbed field, and what each reading tells of it.
struct FieldSurvey {
  double horizontal = 0.0;  ///< [uT]
  double down = 0.0;        ///< [uT]
  double azimuth = 0.0;     ///< by the attitudes' headings [rad]
  /// Of the field in motion, counted from that at rest [rad]; 0 unless there
  /// are both and the heading is known.
  double turn = 0.0;
  /// How long the errors of the readings in motion go on [s].
  double memory = 0.0;
  /// Of each reading, in readings of SurveyOptions::sigma; 0: disturbed.
  std::vector<double> weight;
};

/// Which of two fields points north, the one at rest or the one in motion, a
/// recording does not tell: heading is counted from between them, with this
/// part of the one at rest, and its sigma holds both.
inline constexpr double kRestPart = 0.75;
/// Azimuth of the field at rest, counted from there [rad].
inline double RestAzimuth(const FieldSurvey& survey) {
  return -(1.0 - kRestPart) * survey.turn;
}
/// Standard deviation of a variable that is one of two, by these parts [rad].
inline double NorthSigma(const FieldSurvey& survey) {
  return std::sqrt(kRestPart * (1.0 - kRestPart)) * std::abs(survey.turn);
}

/// The reference is the median of the horizontal, of the vertical part and of
/// the azimuth over the readings, those in motion with a fiftieth of the weight
/// of those at rest: the field where the body rests, if it does. Of the difference d of a reading from it
/// the horizontal and the vertical part can be seen whatever the heading, and
/// all of it if that is known: above |d| = 3 sigma the reading is disturbed.
/// The weight of the others is dt / T, T how long their error goes on:
/// correlation_time at rest, and in motion
///   memory = max(correlation_time, T_motion |mean d|^2 / mean |d|^2)
/// over the T_motion that the readings in motion stand for: where the field of
/// the places that a hand reaches is another one than where it rests, all of
/// them share an error.
FieldSurvey SurveyField(std::span<const SurveyedField> readings,
                        const SurveyOptions& options);

/// Hard iron of a magnet that travels along the whole time [uT, body axes],
/// zero if there is none to be believed. It must be significant, h' P_h^-1 h
/// above the chi-square of 99.99 %, above kLeastHardIron, and nine in ten
/// readings, by weight and by time, must be nearer to the field with it than to
/// the one without: a magnet put on for a part of the time is none. A field
/// that differs from place to place passes for a weak one. The errors of the
/// readings are taken as Student's t, scale and degrees of freedom by maximum
/// likelihood (expectation maximisation; Lange, Little and Taylor 1989). The
/// attitudes may count their heading from anywhere, but must not drift by more
/// than some degrees.
inline constexpr double kLeastHardIron = 5.0;  // [uT]
Eigen::Vector3d FindHardIron(std::span<const SurveyedField> readings);

/// Weight in that search of a reading that follows another by dt [s] after
/// turning by `angle` [rad]: its error is a function of place and attitude, so
/// many readings at rest are one,
///   w = min(1, min(dt / 1 s, angle / 0.5 rad) + dt / 50 s).
double IndependentPart(double dt, double angle);

}  // namespace hindsight

#endif  // HINDSIGHT_ATTITUDE_FIELD_SURVEY_H_
