#include "problems/sample_solution.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "geometry/so3.h"
#include "imu/imu_link.h"
#include "problems/reconstruction.h"

namespace hindsight {
namespace {

/// Integrates from node to node in steps of the asked times.
class IntervalFill {
 public:
  IntervalFill(const Solution& solution, const ImuStream& imu)
      : solution_(solution), integrator_(imu, HasScale(solution.layout)) {}

  State At(std::size_t k, double t) {
    const State& begin = solution_.states[k];
    const State& end = solution_.states[k + 1];
    if (k != node_) {
      node_ = k;
      jump_ = Local(solution_.layout, Advance(begin, end.t), end);
    }
    const double a = (t - begin.t) / (end.t - begin.t);
    return Retract(solution_.layout, Advance(begin, t), a * jump_);
  }

 private:
  static bool HasScale(const ErrorLayout& layout) {
    return layout.Has(BlockKind::kGyroScale) ||
           layout.Has(BlockKind::kAccelScale);
  }

  State Advance(const State& from, double t) {
    return Predict(solution_.layout, from,
                   integrator_.Summarize(
                       from.t, t, CalibrationOf(solution_.layout, from)));
  }

  const Solution& solution_;
  ImuIntegrator integrator_;
  std::size_t node_ = static_cast<std::size_t>(-1);
  ErrorVector jump_;
};

}  // namespace

Solution SampleSolution(const Solution& solution, const ImuStream& imu,
                        const std::vector<double>& times) {
  Solution out = solution;
  out.states.clear();
  out.separation.clear();
  out.covariances =
      CovarianceSeries(solution.covariances.dim(),
                       solution.covariances.empty() ? 0 : times.size());
  if (times.empty()) return out;
  constexpr double kTolerance = 1e-9;
  if (solution.states.empty() ||
      times.front() < solution.states.front().t - kTolerance ||
      times.back() > solution.states.back().t + kTolerance) {
    throw InputError("time " + std::to_string(times.front()) + " s to " +
                     std::to_string(times.back()) +
                     " s is not inside the solution");
  }
  IntervalFill fill(solution, imu);
  std::size_t k = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double t = times[i];
    while (k + 2 < solution.states.size() && solution.states[k + 1].t <= t) ++k;
    const State& begin = solution.states[k];
    const bool last = solution.states.size() == 1;
    const double span = last ? 1.0 : solution.states[k + 1].t - begin.t;
    const double a = std::clamp((t - begin.t) / span, 0.0, 1.0);
    State x = a == 0.0   ? begin
              : a == 1.0 ? solution.states[k + 1]
                         : fill.At(k, t);
    x.t = t;
    out.states.push_back(x);
    if (!solution.separation.empty()) {
      const std::size_t next = std::min(k + 1, solution.states.size() - 1);
      out.separation.push_back(a == 0.0   ? solution.separation[k]
                               : a == 1.0 ? solution.separation[next]
                                          : (1.0 - a) * solution.separation[k] +
                                                a * solution.separation[next]);
    }
    if (solution.covariances.empty()) continue;
    ErrorMatrix P = (1.0 - a) * solution.covariances.Get(k);
    if (a > 0.0) P += a * solution.covariances.Get(k + 1);
    out.covariances.Set(i, P);
  }
  return out;
}

Solution MoveToPoint(const Solution& solution, const ImuStream& imu,
                     const Eigen::Vector3d& l_b) {
  Solution out = solution;
  ImuIntegrator integrator(imu);
  const ErrorLayout& layout = solution.layout;
  for (std::size_t k = 0; k < solution.states.size(); ++k) {
    const State& x = solution.states[k];
    const Eigen::Matrix3d C_en = x.C_en();
    const Eigen::Matrix3d C_eb = x.q_eb.toRotationMatrix();
    const Eigen::Vector3d w_eb_b = integrator.ReadingAt(x.t).w_ib_b - x.b_g -
                                   C_eb.transpose() * EarthRate_e();
    const Eigen::Vector3d arm_e = C_eb * l_b;
    const Eigen::Vector3d velocity_e = C_eb * w_eb_b.cross(l_b);
    out.states[k].p_e += arm_e;
    out.states[k].v_e += velocity_e;
    if (solution.covariances.empty()) continue;
    ErrorMatrix J = ErrorMatrix::Identity(layout.dim(), layout.dim());
    const Block* position = layout.Find(BlockKind::kPosition);
    const Block* velocity = layout.Find(BlockKind::kVelocity);
    const Block* attitude = layout.Find(BlockKind::kAttitude);
    const Block* gyro_bias = layout.Find(BlockKind::kGyroBias);
    if (attitude != nullptr && attitude->dim == 3) {
      if (position != nullptr && position->dim == 3) {
        J.block<3, 3>(position->offset, attitude->offset) =
            -C_en.transpose() * Skew(arm_e) * C_en;
      }
      if (velocity != nullptr && velocity->dim == 3) {
        J.block<3, 3>(velocity->offset, attitude->offset) =
            -C_en.transpose() * Skew(velocity_e) * C_en;
      }
    }
    if (velocity != nullptr && velocity->dim == 3 && gyro_bias != nullptr) {
      J.block<3, 3>(velocity->offset, gyro_bias->offset) =
          C_en.transpose() * C_eb * Skew(l_b);
    }
    out.covariances.Set(
        k, ErrorMatrix(J * solution.covariances.Get(k) * J.transpose()));
  }
  return out;
}

}  // namespace hindsight
