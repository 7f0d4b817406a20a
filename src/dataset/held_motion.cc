#include "dataset/held_motion.h"

#include <algorithm>
#include <cmath>

#include "imu/preintegration.h"

namespace hindsight {

HeldMotion::HeldMotion(const ImuStream& imu, const Eigen::Vector3d& b_g)
    : begin_(imu.t_begin()), end_(imu.t_end()) {
  constexpr double kStep = 0.01;
  constexpr double kMostSteps = 1e6;
  step_ = std::max(kStep, (end_ - begin_) / kMostSteps);
  const auto steps = static_cast<std::size_t>(
      std::max(1.0, std::floor((end_ - begin_) / step_)));
  ImuIntegrator integrator(imu);
  ImuCalibration calibration;
  calibration.b_g = b_g;
  grid_.reserve(steps + 1);
  grid_.push_back({Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(),
                   Eigen::Vector3d::Zero()});
  ImuSummary mean = EmptyMean(begin_, calibration);
  for (std::size_t k = 1; k <= steps; ++k) {
    const double t = begin_ + static_cast<double>(k) * step_;
    integrator.AppendMean(std::min(t, end_), &mean);
    grid_.push_back({mean.dR, mean.dv, mean.dp});
  }
}

HeldMotion::Instant HeldMotion::At(double t) const {
  const double at = std::clamp((t - begin_) / step_, 0.0,
                               static_cast<double>(grid_.size() - 1));
  const auto k = std::min(static_cast<std::size_t>(at), grid_.size() - 2);
  const double u = at - static_cast<double>(k);
  const Instant& a = grid_[k];
  const Instant& b = grid_[k + 1];
  const Eigen::Vector3d dv = b.v - a.v;
  const Eigen::Vector4d q =
      (1.0 - u) * a.q.coeffs() + u * b.q.coeffs();  // a small turn
  return {Eigen::Quaterniond(q).normalized(), a.v + u * dv,
          a.p + u * step_ * (a.v + 0.5 * u * dv)};
}

}  // namespace hindsight
