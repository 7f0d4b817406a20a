#include "dataset/standstill.h"

#include <cmath>

#include "base/units.h"

namespace hindsight {
namespace {

/// Sums over one window of samples.
struct Window {
  double begin = 0.0;
  int count = 0;
  Eigen::Vector3d w = Eigen::Vector3d::Zero();
  Eigen::Vector3d f = Eigen::Vector3d::Zero();
  double w2 = 0.0;
  double f2 = 0.0;

  void Add(const Eigen::Vector3d& rate, const Eigen::Vector3d& force) {
    ++count;
    w += rate;
    f += force;
    w2 += rate.squaredNorm();
    f2 += force.squaredNorm();
  }

  bool IsStill(const StationaryOptions& options) const {
    constexpr int kFewest = 5;
    constexpr double kGravityTolerance = 0.03;
    if (count < kFewest) return false;
    const Eigen::Vector3d w_mean = w / count;
    const Eigen::Vector3d f_mean = f / count;
    const double w_sd =
        std::sqrt(std::max(0.0, w2 / count - w_mean.squaredNorm()));
    const double f_sd =
        std::sqrt(std::max(0.0, f2 / count - f_mean.squaredNorm()));
    return w_sd < options.gyro_threshold && f_sd < options.accel_threshold &&
           std::abs(f_mean.norm() / kStandardGravity - 1.0) < kGravityTolerance;
  }
};

}  // namespace

std::vector<TimeInterval> FindStandstill(const ImuStream& imu,
                                         const StationaryOptions& options) {
  std::vector<TimeInterval> intervals;
  if (imu.empty()) return intervals;
  Window window;
  window.begin = imu.t_begin();
  for (std::size_t k = 1; k < imu.samples.size(); ++k) {
    const ImuSample& s = imu.samples[k];
    const double dt = s.t - imu.samples[k - 1].t;
    const bool increments = imu.kind == ImuStream::Kind::kIncrements;
    window.Add(increments ? Eigen::Vector3d(s.gyro / dt) : s.gyro,
               increments ? Eigen::Vector3d(s.accel / dt) : s.accel);
    if (dt > imu.max_gap) {
      window = Window();
      window.begin = s.t;
      continue;
    }
    if (s.t - window.begin < options.window - 0.5 * dt) continue;
    if (window.IsStill(options)) {
      if (!intervals.empty() &&
          window.begin - intervals.back().end < 1.5 * dt) {
        intervals.back().end = s.t;
      } else {
        intervals.push_back({window.begin, s.t});
      }
    }
    window = Window();
    window.begin = s.t;
  }
  return intervals;
}

}  // namespace hindsight
