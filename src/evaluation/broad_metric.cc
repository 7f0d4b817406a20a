#include "evaluation/broad_metric.h"

#include <algorithm>
#include <cmath>

#include "evaluation/trajectory_error.h"
#include "geometry/so3.h"

namespace hindsight {

BroadError BroadErrorOf(const Eigen::Quaterniond& q_est,
                        const Eigen::Quaterniond& q_ref) {
  const Eigen::Quaterniond q_e = (q_est * q_ref.conjugate()).normalized();
  const double w = std::abs(q_e.w());
  const double z = std::abs(q_e.z());
  return {2.0 * std::acos(std::min(w, 1.0)), 2.0 * std::atan2(z, w),
          2.0 * std::acos(std::min(std::hypot(w, z), 1.0))};
}

BroadMetric EvaluateBroad(const SolutionTable& solution,
                          const TruthSeries& truth) {
  TruthSeries used;
  for (const TruthPoint& point : truth) {
    if (!point.q_nb || !point.moving.value_or(true)) continue;
    TruthPoint attitude;
    attitude.t = point.t;
    attitude.q_nb = point.q_nb;
    used.push_back(attitude);
  }
  BroadMetric metric;
  for (const TrajectoryError& error :
       ComputeTrajectoryErrors(solution, used, {})) {
    if (!error.rotation) continue;
    // The truth is Exp(rotation) times the solution.
    const BroadError e =
        BroadErrorOf(Exp(-*error.rotation), Eigen::Quaterniond::Identity());
    metric.rms.total += e.total * e.total;
    metric.rms.heading += e.heading * e.heading;
    metric.rms.inclination += e.inclination * e.inclination;
    ++metric.count;
  }
  const auto root = [&](double* sum) {
    *sum = std::sqrt(*sum / static_cast<double>(metric.count));
  };
  root(&metric.rms.total);
  root(&metric.rms.heading);
  root(&metric.rms.inclination);
  return metric;
}

}  // namespace hindsight
