#include "problems/robust_batch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace hindsight {
namespace {

constexpr double kLeastProbability = 0.01;

/// What the receiver's error does over each interval, from the probabilities of
/// the modes at its end.
std::vector<ColouredStep> ErrorSteps(const RegimeProblem& problem,
                                     const TunedRegimes& tuned) {
  std::vector<ColouredStep> steps;
  const Timeline& timeline = *problem.timeline;
  for (std::size_t k = 1; k < timeline.size(); ++k) {
    const Eigen::VectorXd& p = tuned.smoothed.trajectory.probabilities[k];
    const double dt = timeline.node(k).t - timeline.node(k - 1).t;
    Eigen::Index likeliest = 0;
    p.maxCoeff(&likeliest);
    ColouredStep step;
    step.sensor = problem.receiver;
    step.phi =
        ErrorEvolution(tuned.regimes, static_cast<std::size_t>(likeliest))
            .Phi(dt);
    for (Eigen::Index j = 0; j < p.size(); ++j) {
      if (p(j) < kLeastProbability) continue;
      step.variance +=
          p(j) *
          ErrorEvolution(tuned.regimes, static_cast<std::size_t>(j)).Q(dt);
    }
    // An exact step would leave the problem singular.
    constexpr double kFloor = 1e-4;
    step.variance =
        std::max(step.variance,
                 kFloor * kFloor * tuned.regimes.sigma * tuned.regimes.sigma);
    steps.push_back(step);
  }
  return steps;
}

/// Mean probability of an outlier over the fixes.
double OutlierShare(const RegimeProblem& problem, const TunedRegimes& tuned) {
  double sum = 1.0;
  double count = 20.0;
  for (std::size_t k = 0; k < problem.timeline->size(); ++k) {
    for (const Measurement& z : problem.timeline->measurements(k)) {
      if (z.sensor != problem.receiver || z.withheld) continue;
      sum += tuned.smoothed.trajectory.probabilities[k](1);
      count += 1.0;
    }
  }
  return std::clamp(sum / count, 1e-3, 0.5);
}

void ApplyToSensor(const RegimeProblem& problem, const TunedRegimes& tuned) {
  const auto i = static_cast<std::size_t>(problem.receiver);
  Sensor sensor = problem.timeline->sensors()[i];
  sensor.loss.kind = RobustLoss::Kind::kMixture;
  sensor.loss.scale = 1.0;
  sensor.loss.rows = 3;
  sensor.loss.outlier_ratio = tuned.regimes.outlier_ratio;
  sensor.loss.outlier_share = OutlierShare(problem, tuned);
  problem.timeline->SetSensor(i, sensor);
  problem.timeline->ScaleSensor(problem.receiver, tuned.regimes.scale);
}

std::vector<std::string> Notes(const RegimeProblem& problem,
                               const ErrorRegimes& regimes) {
  const Sensor& sensor =
      problem.timeline->sensors()[static_cast<std::size_t>(problem.receiver)];
  char text[200];
  std::snprintf(
      text, sizeof(text),
      "%s: %s errors, sigma %.3g times as stated, outliers %.3g %% of "
      "%.3g times that",
      sensor.name.c_str(), RegimeName(regimes.kind), regimes.scale,
      100.0 * sensor.loss.outlier_share, regimes.outlier_ratio);
  std::vector<std::string> notes = {text};
  if (regimes.HasGaussMarkov()) {
    std::snprintf(text, sizeof(text),
                  "%s: Gauss-Markov error of %.3g m, correlation time %.3g s",
                  sensor.name.c_str(), regimes.sigma, regimes.tau);
    notes.emplace_back(text);
  }
  return notes;
}

}  // namespace

double RobustBatchResult::Trust(std::size_t k) const {
  return regimes.kind == ErrorRegimes::Kind::kSwitching
             ? probabilities[k].head(2).sum()
             : 1.0;
}

RobustBatchResult SolveRobustBatch(const ErrorLayout& layout,
                                   const Prior& prior,
                                   const std::vector<State>& initial,
                                   int receiver, Timeline timeline,
                                   const GateDecisions& decisions,
                                   const BatchOptions& options,
                                   const EpochCallback& callback) {
  const RegimeProblem problem{layout,    prior,     initial, receiver,
                              &timeline, decisions, callback};
  const TunedRegimes tuned = ChooseRegimes(problem);
  const ExtendedProblem extended = Extend(problem, tuned.regimes);
  ApplyToSensor(problem, tuned);
  if (tuned.regimes.kind == ErrorRegimes::Kind::kSwitching) {
    timeline.SetColouredSteps(ErrorSteps(problem, tuned));
  }
  BatchOptions batch = options;
  batch.graduated = false;
  // About the edge of a mixture the last steps converge linearly.
  batch.max_iterations = std::max(batch.max_iterations, 200);
  BatchResult result =
      SolveBatch(extended.layout, extended.prior,
                 tuned.smoothed.trajectory.states, &timeline, decisions, batch);
  std::vector<std::string> notes = Notes(problem, tuned.regimes);
  return {extended.layout,     std::move(result),
          std::move(timeline), decisions,
          tuned.regimes,       tuned.smoothed.trajectory.probabilities,
          std::move(notes)};
}

}  // namespace hindsight
