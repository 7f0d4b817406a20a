#ifndef HINDSIGHT_PROBLEMS_FIELD_SURVEY_H_
#define HINDSIGHT_PROBLEMS_FIELD_SURVEY_H_

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "filters/attitude_filter.h"
#include "state/solution.h"

namespace hindsight {

/// A magnetometer's reading and the attitude at that time, from gyros and
/// accelerometers alone: its heading counts from anywhere and may drift slowly.
struct SurveyedField {
  double t = 0.0;
  Eigen::Quaterniond q_nb;
  Eigen::Vector3d field_b;
  double weight = 1.0;  ///< how much of an independent reading this is
};

struct FieldSurvey {
  Eigen::Vector3d field_n = Eigen::Vector3d::Zero();      ///< [uT]
  Eigen::Vector3d hard_iron_b = Eigen::Vector3d::Zero();  ///< [uT]
  /// Student's t distribution of the readings' errors in this recording, the
  /// most likely one: scale per axis [uT] and degrees of freedom.
  double scale = 0.0;
  double freedom = 1.0;
  /// Weight that each reading ended with, 1 / (1 + r^2 / (freedom scale^2)):
  /// 1 agrees, towards 0 disturbed.
  std::vector<double> trust;

  /// Whether reading k differs by more than 2 sqrt(freedom) scales.
  bool IsDisturbed(std::size_t k) const {
    constexpr double kLeast = 0.2;
    return trust[k] < kLeast;
  }
};

/// Error of one independent magnetometer reading indoors to an estimator, which
/// cannot know whether the field of the places where it was is that of the
/// neighbourhood [uT].
inline constexpr double kFieldScale = 5.0;

/// Field of the place and of the body itself, over a whole recording at once:
///   field_b = C_bn field_n + hard_iron_b + noise,
/// linear in both, the noise of Student's t distribution with 1, 2, 4 or 8
/// degrees of freedom and a scale of at least 1 uT, all by maximum likelihood
/// (expectation maximisation; Lange, Little and Taylor 1989): in an even field
/// a magnet that comes near stands out early, in an uneven one late. A hard
/// iron is believed if it is larger than kFieldScale and significant, h' P_h^-1
/// h above the chi-square of 99.99 %; otherwise there is none: over few places
/// and attitudes a field that differs from place to place passes for one.
FieldSurvey SurveyField(std::span<const SurveyedField> readings);

/// Weight of a reading that follows another by dt [s] after turning by `angle`
/// [rad]: its error is a function of place and attitude, so many readings at
/// rest are one,
///   w = min(1, min(dt / 1 s, angle / 0.5 rad) + dt / 50 s).
double IndependentPart(double dt, double angle);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_FIELD_SURVEY_H_
