#include "filters/iterated_smoother.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hindsight {
namespace {

/// Largest movement of a block over all epochs [m or rad].
double LargestMove(const ErrorLayout& layout, const std::vector<ErrorVector>& d,
                   BlockKind kind) {
  const Block* block = layout.Find(kind);
  double largest = 0.0;
  if (block == nullptr) return largest;
  for (const ErrorVector& v : d) {
    largest = std::max(largest, v.segment(block->offset, block->dim).norm());
  }
  return largest;
}

bool IsBelowTolerances(const ErrorLayout& layout,
                       const std::vector<ErrorVector>& d,
                       const IterationOptions& options) {
  return LargestMove(layout, d, BlockKind::kPosition) <
             options.position_tolerance &&
         LargestMove(layout, d, BlockKind::kAttitude) <
             options.attitude_tolerance;
}

void SumInnovations(const LinearTape& tape, IteratedResult* result) {
  double nis = 0.0;
  double rows = 0.0;
  result->log_likelihood = LogLikelihoodOf(tape);
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.headers(k)) {
      if (!z.accepted) continue;
      nis += z.nis;
      rows += static_cast<double>(z.residual.size());
    }
  }
  result->nis = rows > 0.0 ? nis / rows : 1.0;
}

/// Largest step of each iteration in standard deviations.
class Steps {
 public:
  void Add(double step) {
    before_ = last_;
    last_ = step;
  }
  double last() const { return last_; }
  /// Sum of the steps to come if each is to the one before as the last was (a
  /// geometric series); infinite before the second step and while they grow.
  double Rest() const {
    if (!(last_ < before_) || std::isinf(before_)) return kUnknown;
    return last_ * last_ / (before_ - last_);
  }

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::infinity();
  double before_ = kUnknown;
  double last_ = kUnknown;
};

}  // namespace

IteratedResult SmoothIterated(std::vector<State> nominal,
                              const IterationOptions& options,
                              Problem* problem) {
  const ErrorLayout& layout = problem->layout;
  IteratedResult result;
  SmoothedTrajectory& trajectory = result.trajectory;
  trajectory.states = std::move(nominal);
  const bool with_covariances = options.rough == nullptr;
  std::vector<State> about;
  Steps steps;
  for (int i = 1; i <= options.max_iterations && !result.converged; ++i) {
    about = std::move(trajectory.states);
    LinearTape tape = RunLinearizedFilter(about, problem, options.callback);
    result.iterations = i;
    SumInnovations(tape, &result);
    if (i == options.max_iterations && with_covariances) {
      trajectory = SmoothRts(std::move(tape));
      result.converged = IsBelowTolerances(layout, trajectory.d, options);
      steps.Add(
          LargestMoveInSigmas(layout, about, trajectory.states, trajectory.P));
      break;
    }
    trajectory = SmoothMeans(tape);
    result.converged = IsBelowTolerances(layout, trajectory.d, options);
    if (options.rough != nullptr) {
      steps.Add(LargestMoveInSigmas(layout, about, trajectory.states,
                                    *options.rough));
      result.converged = result.converged || steps.Rest() < kNegligibleRest;
    } else if (result.converged && with_covariances) {
      trajectory = SmoothRts(std::move(tape));
    }
  }
  result.converged = result.converged || steps.last() < kSettledStep;
  return result;
}

double LargestMoveInSigmas(const ErrorLayout& layout,
                           const std::vector<State>& from,
                           const std::vector<State>& to,
                           const CovarianceSeries& P) {
  double largest = 0.0;
  for (std::size_t k = 0; k < to.size(); ++k) {
    const ErrorVector d = Local(layout, from[k], to[k]);
    const ErrorVector P_k = P.Variances(k);
    for (const Block& block : layout.blocks()) {
      if (block.key.kind != BlockKind::kPosition &&
          block.key.kind != BlockKind::kAttitude) {
        continue;
      }
      for (int i = block.offset; i < block.offset + block.dim; ++i) {
        largest = std::max(largest, std::abs(d(i)) / std::sqrt(P_k(i)));
      }
    }
  }
  return largest;
}

double LogLikelihoodOf(const LinearTape& tape) {
  double sum = 0.0;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.headers(k)) {
      if (z.accepted) sum += z.log_likelihood;
    }
  }
  return sum;
}

double SettledLogLikelihood(std::vector<State> nominal, Problem* problem) {
  constexpr int kMostPasses = 4;
  constexpr double kSettled = 0.01;
  double before = std::numeric_limits<double>::infinity();
  for (int pass = 1;; ++pass) {
    const LinearTape tape = RunLinearizedFilter(nominal, problem);
    const double log_likelihood = LogLikelihoodOf(tape);
    if (pass == kMostPasses || std::abs(log_likelihood - before) < kSettled) {
      return log_likelihood;
    }
    before = log_likelihood;
    nominal = SmoothMeans(tape).states;
  }
}

GateDecisions DecideGates(const Problem& problem,
                          const SmoothedTrajectory& trajectory) {
  const Timeline& timeline = problem.timeline;
  GateDecisions decisions(timeline.all_measurements().size(), 1);
  LinearizedMeasurement z;
  std::size_t i = 0;
  for (std::size_t k = 0; k < timeline.size(); ++k) {
    for (const Measurement& measurement : timeline.measurements(k)) {
      const std::size_t index = i++;
      const Sensor& sensor =
          timeline.sensors()[static_cast<std::size_t>(measurement.sensor)];
      if (measurement.withheld) {
        decisions[index] = 0;
        continue;
      }
      if (!sensor.gate_probability) continue;
      Evaluate(measurement,
               timeline.Context(k, measurement, problem.layout,
                                trajectory.states[k]),
               &z);
      const RowMatrix HPH = z.H * trajectory.P.Get(k) * z.H.transpose();
      const RowMatrix S = problem.decisions[index] != 0 ? RowMatrix(z.R - HPH)
                                                        : RowMatrix(z.R + HPH);
      const Eigen::LLT<RowMatrix> llt(S);
      // Nothing but the measurement itself determines what it measures: its
      // residual is zero by construction and cannot be tested.
      if (llt.info() != Eigen::Success) continue;
      const double nis = llt.matrixL().solve(z.residual).squaredNorm();
      decisions[index] =
          nis <= GateLimit(sensor, static_cast<int>(z.residual.size())) ? 1 : 0;
    }
  }
  return decisions;
}

GateDecisions DecisionsOnTape(const LinearTape& tape) {
  GateDecisions decisions;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.headers(k)) {
      decisions.push_back(z.accepted ? 1 : 0);
    }
  }
  return decisions;
}

}  // namespace hindsight
