#ifndef HINDSIGHT_ATTITUDE_FIELD_SURVEY_H_
#define HINDSIGHT_ATTITUDE_FIELD_SURVEY_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <span>
#include <vector>

#include "measurements/sensor.h"

namespace hindsight {

/// A magnetometer's reading and the attitude at that time.
struct SurveyedField {
  double t = 0.0;
  Eigen::Quaterniond q_nb;
  Eigen::Vector3d field_b;  ///< [uT]
  double dt = 0.0;          ///< since the reading before [s]
  bool at_rest = false;
  Eigen::Vector3d w_b = Eigen::Vector3d::Zero();  ///< of the body [rad/s]
};

struct SurveyOptions {
  /// Error of a reading per axis [uT], which goes on for correlation_time [s]
  /// while the body rests.
  double sigma = 3.5;
  double correlation_time = 1.0;
  /// False: no reading is disturbed.
  bool reject = true;
  /// Size of a magnet that may travel along, in an unknown direction [uT].
  double weak_iron = 0.0;
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
  /// Variance of the azimuth at rest by a magnet of SurveyOptions::weak_iron,
  /// which turns with the body in motion and averages out there [rad^2].
  double iron_variance = 0.0;
  /// How long the errors of the readings in motion go on [s].
  double memory = 0.0;
  /// Of each reading, in readings of SurveyOptions::sigma; 0: disturbed.
  std::vector<double> weight;
};

/// Azimuth of the field at rest, counted from magnetic north [rad]. Two places
/// disturb the field independently and alike, by azimuths of variance s^2, of which
/// the turn between them says s^2 = turn^2 / 2; at rest comes the iron's v besides.
/// North is the mean by weight, in the middle if v = 0,
///   -turn (s^2 + v) / (2 s^2 + v) +- s sqrt((s^2 + v) / (2 s^2 + v)).
double RestAzimuth(const FieldSurvey& survey);
/// What that leaves open of north [rad].
double NorthSigma(const FieldSurvey& survey);
/// What a disturbance of the whole place leaves open of north [rad]. Of one
/// that is as large along all axes the part that turns the dip is seen,
/// whatever the scale of the readings; the part across turns north by as much:
///   |sin(dip - stated dip)| / cos dip.
double PlaceSigma(const FieldSurvey& survey,
                  const MagneticSurroundings& stated);

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

}  // namespace hindsight

#endif  // HINDSIGHT_ATTITUDE_FIELD_SURVEY_H_
