#include "problems/sample_solution.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/error.h"
#include "imu/imu_link.h"
#include "timeline/time_update.h"

namespace hindsight {
namespace {

/// Closer to a node than this is at the node: stamps are rounded [s].
constexpr double kSameInstant = 1e-9;

bool HasScale(const ErrorLayout& layout) {
  return layout.Has(BlockKind::kGyroScale) ||
         layout.Has(BlockKind::kAccelScale);
}

constexpr int kMostMotion = 9;

/// The rows of position, velocity and attitude of a transition that keeps all
/// else. That of a Gauss-Markov block tends to zero over its correlation time
/// and has no useful inverse.
using MotionRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                                 kMostMotion, kMaxErrorDim>;

/// b after a.
MotionRows Chain(const MotionRows& b, const MotionRows& a) {
  const Eigen::Index m = a.rows();
  MotionRows both = b.leftCols(m) * a;
  both.rightCols(a.cols() - m) += b.rightCols(a.cols() - m);
  return both;
}

MotionRows Inverse(const MotionRows& a) {
  const Eigen::Index m = a.rows();
  MotionRows inverse(m, a.cols());
  inverse.leftCols(m) = a.leftCols(m).inverse();
  inverse.rightCols(a.cols() - m) =
      -inverse.leftCols(m) * a.rightCols(a.cols() - m);
  return inverse;
}

/// P of an error that the transition has moved.
ErrorMatrix Moved(const MotionRows& Phi, const ErrorMatrix& P) {
  const Eigen::Index m = Phi.rows();
  const Eigen::Index rest = P.cols() - m;
  const MotionRows rows = Phi * P;
  ErrorMatrix out = P;
  out.topLeftCorner(m, m) = rows * Phi.transpose();
  out.topRightCorner(m, rest) = rows.rightCols(rest);
  out.bottomLeftCorner(rest, m) = rows.rightCols(rest).transpose();
  return out;
}

/// How the motion goes on over some time, and its noise.
struct Motion {
  using Noise = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                              kMostMotion, kMostMotion>;
  MotionRows Phi;
  Noise Q;

  static Motion None(Eigen::Index dim, Eigen::Index of) {
    return {MotionRows::Identity(dim, of), Noise::Zero(dim, dim)};
  }
  Motion Then(const Transition& step) const {
    const Eigen::Index m = Phi.rows();
    const MotionRows next = step.Phi.topRows(m);
    return {Chain(next, Phi),
            next.leftCols(m) * Q * next.leftCols(m).transpose() +
                step.Q.topLeftCorner(m, m)};
  }
};

/// P between the nodes: at steps of at most kPropagationStep, linear in
/// between.
class CovarianceBetween {
 public:
  CovarianceBetween(const Solution& solution, const Timeline& timeline,
                    const ImuStream& imu, const CovarianceOptions& covariance)
      : solution_(solution),
        timeline_(timeline),
        integrator_(imu, HasScale(solution.layout)),
        policy_(covariance, solution.layout) {}

  /// At t between node k and the next.
  ErrorMatrix At(std::size_t k, double t) {
    if (k != node_) StepFrom(k);
    std::size_t i = 1;
    while (i + 1 < t_.size() && t_[i] < t) ++i;
    const double a = (t - t_[i - 1]) / (t_[i] - t_[i - 1]);
    return (1.0 - a) * P_[i - 1] + a * P_[i];
  }

 private:
  void StepFrom(std::size_t k) {
    node_ = k;
    const double begin = solution_.states[k].t;
    const double T = solution_.states[k + 1].t - begin;
    const int steps =
        std::max(1, static_cast<int>(std::ceil(T / kPropagationStep)));
    t_ = {begin};
    for (int i = 1; i < steps; ++i) t_.push_back(begin + T * i / steps);
    t_.push_back(solution_.states[k + 1].t);
    P_.assign(1, solution_.covariances.Get(k));
    if (solution_.forward) {
      Predict(k);
    } else if (steps == 1) {
      P_.push_back(solution_.covariances.Get(k + 1));
    } else {
      Bridge(k);
    }
  }

  /// Calls `step` with the transition over each step and its length.
  template <typename Step>
  void ForEachStep(std::size_t k, const Step& step) {
    State end = solution_.states[k];
    for (std::size_t i = 1; i < t_.size(); ++i) {
      const State begin = end;
      const ImuSummary summary = integrator_.Summarize(
          begin.t, t_[i], CalibrationOf(solution_.layout, begin));
      const NodeInterval interval = {timeline_, k, summary};
      end = Advance(solution_.layout, interval, begin);
      LinearizeAdvance(solution_.layout, interval, begin, end, &transition_);
      step(transition_, summary.dt());
    }
  }

  void Predict(std::size_t k) {
    ErrorMatrix P = P_.front();
    ForEachStep(k, [&](const Transition& transition, double dt) {
      policy_.Predict(transition, dt, &P);
      P_.push_back(P);
    });
  }

  void Bridge(std::size_t k) {
    const ErrorMatrix before = P_.front();
    const ErrorMatrix after = solution_.covariances.Get(k + 1);
    std::vector<Motion> from_node = {Motion::None(MotionDim(), before.rows())};
    ForEachStep(k, [&](const Transition& transition, double) {
      from_node.push_back(from_node.back().Then(transition));
    });
    const MotionRows back = Inverse(from_node.back().Phi);
    for (std::size_t i = 1; i + 1 < t_.size(); ++i) {
      const double a = (t_[i] - t_.front()) / (t_.back() - t_.front());
      const auto& [Phi, Q] = from_node[i];
      ErrorMatrix P = (1.0 - a) * Moved(Phi, before);
      P.topLeftCorner(Q.rows(), Q.cols()) += (1.0 - a) * Q;
      P_.emplace_back(P + a * Moved(Chain(Phi, back), after));
    }
    P_.push_back(after);
  }

  /// Of position, velocity and attitude, which stand first in a layout.
  int MotionDim() const {
    int dim = 0;
    for (const Block& block : solution_.layout.blocks()) {
      if (block.key.kind <= BlockKind::kAttitude) dim += block.dim;
    }
    return dim;
  }

  const Solution& solution_;
  const Timeline& timeline_;
  ImuIntegrator integrator_;
  CovariancePolicy policy_;
  Transition transition_;
  std::size_t node_ = static_cast<std::size_t>(-1);
  std::vector<double> t_;       ///< times of node, steps and next node [s]
  std::vector<ErrorMatrix> P_;  ///< at these times
};

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
        integrator_(imu, HasScale(solution.layout)),
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
        x = Retract(solution_.layout, x, Part(k, times[i]) * jump);
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
