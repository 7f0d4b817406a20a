#include "problems/sample_solution.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/error.h"
#include "imu/imu_link.h"
#include "problems/covariance_between.h"
#include "problems/step_bridge.h"
#include "timeline/time_update.h"

namespace hindsight {
namespace {

/// Closer to a node than this is at the node: stamps are rounded [s].
constexpr double kSameInstant = 1e-9;

/// Linear; NaN beside a NaN.
FilterSeparation Blend(double a, const FilterSeparation& before,
                       const FilterSeparation& after) {
  return {(1.0 - a) * before.difference + a * after.difference,
          (1.0 - a) * before.sigma + a * after.sigma};
}

/// One walk through the IMU, from node to node.
class Sampler {
 public:
  Sampler(const Solution& solution, const Timeline& timeline,
          const ImuStream& imu, const CovarianceOptions& covariance,
          Solution* out)
      : solution_(solution),
        timeline_(timeline),
        integrator_(imu),
        covariance_(solution, timeline, imu, covariance),
        out_(*out) {
    if (solution.two_filter) out_.two_filter.emplace();
  }

  /// Node k, as it is at time t.
  void AtNode(std::size_t k, double t) {
    out_.states.push_back(solution_.states[k]);
    out_.states.back().t = t;
    if (const auto& part = solution_.two_filter) {
      if (!part->separation.empty()) {
        out_.two_filter->separation.push_back(part->separation[k]);
      }
      out_.two_filter->components.push_back(part->components[k]);
    }
    if (HasCovariances()) Append(solution_.covariances.Get(k));
  }

  /// Times between node k and the next, ascending.
  void Between(std::size_t k, std::span<const double> times) {
    const State& begin = solution_.states[k];
    const State& end = solution_.states[k + 1];
    ImuSummary mean =
        EmptyMean(begin.t, CalibrationOf(solution_.layout, begin));
    const std::size_t first = out_.states.size();
    for (const double t : times) {
      integrator_.AppendMean(t, &mean);
      out_.states.push_back(
          Advance(solution_.layout, {timeline_, k, mean}, begin));
    }
    if (!solution_.forward) {
      integrator_.AppendMean(end.t, &mean);
      const ErrorVector jump =
          Local(solution_.layout,
                Advance(solution_.layout, {timeline_, k, mean}, begin), end);
      for (std::size_t i = 0; i < times.size(); ++i) {
        State& x = out_.states[first + i];
        x = Retract(solution_.layout, x, PartOf(jump, k, times[i]));
        x.t = times[i];
      }
    }
    for (const double t : times) AppendSpread(k, t);
  }

 private:
  bool HasCovariances() const { return !solution_.covariances.empty(); }

  double Part(std::size_t k, double t) const {
    const double begin = solution_.states[k].t;
    return (t - begin) / (solution_.states[k + 1].t - begin);
  }

  /// What a state at t has of what is missed by the node after k.
  ErrorVector PartOf(const ErrorVector& jump, std::size_t k, double t) const {
    ErrorVector part = Part(k, t) * jump;
    const auto bridge = BridgeOverSteps(solution_.layout, timeline_, k, t);
    if (!bridge) return part;
    for (int axis = 0; axis < 3; ++axis) {
      const int p = bridge->position + axis;
      const int v = bridge->velocity + axis;
      const Eigen::Vector2d both =
          bridge->gain * Eigen::Vector2d(jump(p), jump(v));
      part(p) = both.x();
      part(v) = both.y();
    }
    return part;
  }

  void Append(const ErrorMatrix& P) { out_.covariances.Set(count_++, P); }

  /// Covariance of the state at t, and what else is interpolated.
  void AppendSpread(std::size_t k, double t) {
    const double a = Part(k, t);
    if (const auto& part = solution_.two_filter) {
      if (!part->separation.empty()) {
        out_.two_filter->separation.push_back((1.0 - a) * part->separation[k] +
                                              a * part->separation[k + 1]);
      }
      out_.two_filter->components.push_back(
          Blend(a, part->components[k], part->components[k + 1]));
    }
    if (!HasCovariances()) return;
    Append(covariance_.At(k, t));
  }

  const Solution& solution_;
  const Timeline& timeline_;
  ImuIntegrator integrator_;
  CovarianceBetween covariance_;
  Solution& out_;
  std::size_t count_ = 0;
};

void CheckInside(const Solution& solution, const std::vector<double>& times) {
  if (!solution.states.empty() &&
      times.front() >= solution.states.front().t - kSameInstant &&
      times.back() <= solution.states.back().t + kSameInstant) {
    return;
  }
  throw InputError("time " + std::to_string(times.front()) + " s to " +
                   std::to_string(times.back()) +
                   " s is not inside the solution");
}

}  // namespace

Solution SampleSolution(const Solution& solution, const Timeline& timeline,
                        const ImuStream& imu, const std::vector<double>& times,
                        const CovarianceOptions& covariance) {
  if (timeline.size() != solution.states.size()) {
    throw std::logic_error("the timeline is not the solution's");
  }
  Solution out = WithoutSeries(solution);
  if (times.empty()) return out;
  CheckInside(solution, times);
  if (!solution.covariances.empty()) {
    out.covariances =
        CovarianceSeries(solution.covariances.dim(), times.size());
  }
  out.states.reserve(times.size());
  Sampler sampler(solution, timeline, imu, covariance, &out);
  const std::vector<State>& nodes = solution.states;
  std::size_t k = 0;
  for (std::size_t i = 0; i < times.size();) {
    while (k + 1 < nodes.size() && nodes[k + 1].t <= times[i] + kSameInstant) {
      ++k;
    }
    if (k + 1 == nodes.size() || times[i] <= nodes[k].t + kSameInstant) {
      sampler.AtNode(k, times[i++]);
      continue;
    }
    std::size_t end = i + 1;
    while (end < times.size() && times[end] + kSameInstant < nodes[k + 1].t) {
      ++end;
    }
    sampler.Between(k, std::span(times).subspan(i, end - i));
    i = end;
  }
  return out;
}

}  // namespace hindsight
