#include "problems/method_stage.h"

#include <optional>
#include <utility>

#include "base/error.h"
#include "problems/node_placement.h"
#include "problems/solution_builder.h"

namespace hindsight {

MethodStage::Nodes MethodStage::SharedNodes() const {
  return {&forward_->timeline(), &forward_->decisions(),
          &forward_->smoothed().states};
}

Solution MethodStage::AtOwnNodes(
    const std::function<Solution(const Nodes&)>& solve) {
  Solution solution = solve(SharedNodes());
  std::optional<PlacedNodes> own;
  OffsetSearch search;
  for (int i = 1; forward_->unsettled().empty(); ++i) {
    const std::vector<double>& offsets =
        own ? own->offsets : forward_->offsets();
    const Timeline& timeline = own ? own->timeline : forward_->timeline();
    const int sensor =
        FarthestFromNodes(solution.layout, offsets, solution.states.back(),
                          solution.covariances.Get(solution.states.size() - 1));
    if (sensor < 0) break;
    if (i == kMaxPlacements) {
      own_unsettled_ =
          timeline.sensors()[static_cast<std::size_t>(sensor)].name;
      break;
    }
    own = forward_->PlaceAnew(search.Next(solution.layout, timeline.sensors(),
                                          solution.states.back(), offsets),
                              solution.layout, solution.states, timeline,
                              own ? own->decisions : forward_->decisions());
    solution = solve({&own->timeline, &own->decisions, &own->states});
  }
  return solution;
}

Solution MethodStage::FromSmoothed(std::vector<State> states,
                                   CovarianceSeries P,
                                   const Nodes& nodes) const {
  return SmoothedSolution(layout(), *nodes.timeline, std::move(states),
                          std::move(P), *nodes.decisions);
}

Start MethodStage::StartOfQuestioned() const {
  const Start& start = forward_->start();
  return WithoutTrustIn(start.position_sensor, start);
}

void MethodStage::JudgeHeading(const Solution& solution, const Nodes& nodes) {
  own_credit_ =
      CreditHeading(layout(), prior(), solution.states, solution.covariances,
                    nodes.timeline, *nodes.decisions);
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

const std::string& MethodStage::unsettled() const {
  return own_unsettled_.empty() ? forward_->unsettled() : own_unsettled_;
}

HeadingCredit MethodStage::heading_credit() const {
  const HeadingCredit& shared = forward_->heading_credit();
  return own_credit_.curvature < shared.curvature ? own_credit_ : shared;
}

}  // namespace hindsight
