#ifndef HINDSIGHT_MEASUREMENTS_SPEED_COURSE_H_
#define HINDSIGHT_MEASUREMENTS_SPEED_COURSE_H_

#include <tuple>

#include "measurements/model.h"

namespace hindsight {

/// Speed and course over the ground of a point of the vehicle, as NMEA RMC and
/// many receivers deliver them. With u the unit vector of the measured course
/// and n the one to its right, both horizontal, v the point's velocity:
///   speed = u . v,   0 = n . v,
/// standard deviations sigma_speed and max(speed, 1 m/s) sigma_course [m/s].
/// Linear in the velocity and regular at standstill, unlike the polar form.
/// Without a course (receivers withhold it at low speed): speed = |v_h| above
/// three sigmas, of a |v_h| below one sigma (v_h^2 / sigma + sigma) / 2, which has
/// a derivative at zero; below three, where |v_h| has no usable one, 0 = v_h north
/// and east with sigma^2 = speed^2 + sigma_speed^2.
struct SpeedCourse {
  double speed = 0.0;          ///< over the ground [m/s]
  double course = 0.0;         ///< from north, clockwise [rad]
  double sigma_speed = 0.1;    ///< [m/s]
  double sigma_course = 0.02;  ///< [rad]
  bool has_course = true;

  /// For base/packed_words.h.
  template <class Self>
  static auto Fields(Self& z) {
    return std::tie(z.speed, z.course, z.sigma_speed, z.sigma_course,
                    z.has_course);
  }

  /// Multiplies the standard deviations.
  void ScaleSigma(double factor) {
    sigma_speed *= factor;
    sigma_course *= factor;
  }
  bool is_slow() const { return !has_course && speed < 3.0 * sigma_speed; }
  int rows() const { return has_course || is_slow() ? 2 : 1; }
  void Evaluate(const ModelContext& context, LinearizedMeasurement* out) const;
};

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_SPEED_COURSE_H_
