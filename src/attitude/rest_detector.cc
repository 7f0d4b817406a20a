#include "attitude/rest_detector.h"

#include <algorithm>

namespace hindsight {

void RestDetector::Add(double dt, const Eigen::Vector3d& w,
                       const Eigen::Vector3d& f) {
  constexpr double kRate = 0.035;  // [rad/s]
  constexpr double kForce = 0.5;   // [m/s^2]
  if (!started_) {
    w_ = w;
    f_ = f;
    started_ = true;
  }
  const double gain = std::min(dt / kSmoothing, 1.0);
  w_ += gain * (w - w_);
  f_ += gain * (f - f_);
  const bool still = (w - w_).squaredNorm() < kRate * kRate &&
                     (f - f_).squaredNorm() < kForce * kForce &&
                     w_.squaredNorm() < kRate * kRate;
  still_for_ = still ? still_for_ + dt : 0.0;
}

bool RestDetector::rests() const {
  constexpr double kTime = 1.5;  // [s]
  return still_for_ >= kTime;
}

}  // namespace hindsight
