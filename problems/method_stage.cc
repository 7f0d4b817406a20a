#include "problems/method_stage.h"

#include <optional>
#include <utility>

#include "base/error.h"
#include "problems/node_placement.h"
#include "problems/solution_builder.h"

namespace hindsight {

MethodStage::Nodes MethodStage::SharedNodes() const {
  if (elsewhere_) {
    PlacedNodes& nodes = elsewhere_->nodes;
    return {&nodes.problem, &nodes.states, &nodes.offsets};
  }
  return {&forward_->problem(), &forward_->smoothed().states,
          &forward_->offsets()};
}

Solution MethodStage::AtOwnNodes(
    const std::function<Solution(const Nodes&)>& solve) {
  Solution solution = solve(SharedNodes());
  own_.reset();
  OffsetSearch search;
  const auto goes_on = [this] {
    return forward_->unsettled().empty() || own_fit_ || knows_more_;
  };
  for (int i = 1; goes_on(); ++i) {
    const std::vector<double>& offsets =
        own_ ? own_->offsets : *SharedNodes().offsets;
    const std::vector<Sensor>& sensors = problem().timeline.sensors();
    const int sensor =
        FarthestFromNodes(solution.layout, offsets, solution.states.back(),
                          solution.covariances.Get(solution.states.size() - 1));
    settled_ = sensor < 0;
    if (settled_) break;
    if (i == kMaxPlacements) {
      own_unsettled_ = sensors[static_cast<std::size_t>(sensor)].name;
      break;
    }
    own_ = forward_->PlaceAnew(
        search.Next(solution.layout, sensors, solution.states.back(), offsets),
        problem(), solution.layout, solution.states);
    timeline_.reset();
    solution = solve({&own_->problem, &own_->states, &own_->offsets});
  }
  return solution;
}

Problem& MethodStage::problem() {
  return own_ ? own_->problem : *SharedNodes().problem;
}

std::optional<Timeline> MethodStage::TakeTimeline() {
  if (!timeline_ && own_) return std::move(own_->problem.timeline);
  return std::move(timeline_);
}

bool MethodStage::IsAsLinearisedAnew(const Solution& solution) const {
  constexpr double kSame = 0.1;  // sigma, as ForwardStage::Relinearise
  const Relinearised& shared = forward_->relinearised();
  return !shared.states.empty() &&
         LargestDistance(solution.layout, shared.states, solution.states,
                         shared.variances) < kSame;
}

void MethodStage::JudgeOptimum(const Solution& solution) {
  if (!own_ && IsAsLinearisedAnew(solution)) return;
  SetFit(
      JudgeFit(forward_->dataset(),
               {.states = solution.states,
                .variances = VariancesOf(solution.layout, solution.covariances),
                .smoother = {}},
               &problem(), forward_->Progress("grading")));
}

Solution MethodStage::FromSmoothed(std::vector<State> states,
                                   CovarianceSeries P,
                                   const Nodes& nodes) const {
  return SmoothedSolution(*nodes.problem, std::move(states), std::move(P));
}

Problem MethodStage::Questioned(const Nodes& nodes) const {
  const Start& start = forward_->start();
  Problem problem = *nodes.problem;
  problem.prior = WithoutTrustIn(start.position_sensor, start).prior;
  return problem;
}

void MethodStage::JudgeHeading(const Solution& solution, const Nodes& nodes) {
  own_credit_ = {};
  const bool is_shared = nodes.problem == &forward_->problem();
  if (is_shared && IsAsLinearisedAnew(solution)) return;
  own_credit_ =
      CreditHeading(*nodes.problem, solution.states, solution.covariances);
}

BatchOptions MethodStage::MakeBatchOptions() const {
  const ReconstructionOptions& options = forward_->options();
  BatchOptions batch;
  batch.max_iterations = options.max_iterations;
  batch.callback = [&options](double fraction) {
    if (options.stop != nullptr && *options.stop) throw Interrupted();
    if (options.progress) options.progress("batch", fraction);
  };
  return batch;
}

BatchResult MethodStage::SolveBatch(const Nodes& nodes, double* seconds) {
  if (ahead_ == nullptr || nodes.problem != &forward_->problem()) {
    const bool shared = nodes.problem == &forward_->problem();
    return hindsight::SolveBatch(
        shared ? forward_->batch_start() : *nodes.states, MakeBatchOptions(),
        nodes.problem);
  }
  double beside = 0.0;
  BatchResult result = std::exchange(ahead_, nullptr)->Take(&beside);
  *seconds += beside;
  return result;
}

const std::string& MethodStage::unsettled() const {
  return own_unsettled_.empty() && !settled_ ? forward_->unsettled()
                                             : own_unsettled_;
}

HeadingCredit MethodStage::heading_credit() const {
  const HeadingCredit& shared = forward_->heading_credit();
  return own_credit_.curvature < shared.curvature ? own_credit_ : shared;
}

}  // namespace hindsight
