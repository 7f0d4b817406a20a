#ifndef HINDSIGHT_ATTITUDE_REST_DETECTOR_H_
#define HINDSIGHT_ATTITUDE_REST_DETECTOR_H_

#include <Eigen/Core>

namespace hindsight {

/// Tells rest from an IMU alone and from the past alone: rates stay within
/// 0.035 rad/s and forces within 0.5 m/s^2 of their low-passed values,
/// and these rates below 0.035 rad/s, for 1.5 s (thresholds of VQF, Laidig and
/// Seel 2023, table 2). A turn so slow and steady passes for a gyro bias.
class RestDetector {
 public:
  static constexpr double kSmoothing = 0.5;  ///< [s]
  /// A sample, dt after the one before [s]; rate [rad/s], force [m/s^2].
  void Add(double dt, const Eigen::Vector3d& w, const Eigen::Vector3d& f);
  bool rests() const;
  /// Low-passed [rad/s].
  const Eigen::Vector3d& rate() const { return w_; }

 private:
  Eigen::Vector3d w_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d f_ = Eigen::Vector3d::Zero();
  double still_for_ = 0.0;  ///< [s]
  bool started_ = false;
};

}  // namespace hindsight

#endif  // HINDSIGHT_ATTITUDE_REST_DETECTOR_H_
