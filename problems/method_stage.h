#ifndef HINDSIGHT_PROBLEMS_METHOD_STAGE_H_
#define HINDSIGHT_PROBLEMS_METHOD_STAGE_H_

#include <functional>
#include <string>
#include <vector>

#include "problems/batch.h"
#include "problems/forward_stage.h"

namespace hindsight {

/// What one method works with: the forward stage that all share, and what the
/// method finds out beside its solution.
class MethodStage {
 public:
  /// Nodes, the measurements used there, and a trajectory to begin from.
  struct Nodes {
    Timeline* timeline;
    const GateDecisions* decisions;
    const std::vector<State>* states;
  };

  /// `forward` has run and outlives the object.
  explicit MethodStage(ForwardStage* forward) : forward_(forward) {}

  ForwardStage& forward() const { return *forward_; }
  const ErrorLayout& layout() const { return forward_->start().layout; }
  const Prior& prior() const { return forward_->start().prior; }
  Nodes SharedNodes() const;

  /// Solves on the shared nodes, and on nodes of its own as long as the
  /// method's time offsets are elsewhere.
  Solution AtOwnNodes(const std::function<Solution(const Nodes&)>& solve);

  /// As SmoothedSolution, on these nodes.
  Solution FromSmoothed(std::vector<State> states, CovarianceSeries P,
                        const Nodes& nodes) const;

  /// The start without trust in the position sensor that it comes from.
  Start StartOfQuestioned() const;

  /// Takes the credit of the heading about a method's own result, which may lie
  /// elsewhere than that of the forward stage.
  void JudgeHeading(const Solution& solution, const Nodes& nodes);

  /// Of the reconstruction, with its progress under the name "batch".
  BatchOptions MakeBatchOptions() const;

  /// Sensor whose time offset the method's nodes did not settle, or none of
  /// those before it; empty: none.
  const std::string& unsettled() const;
  /// The lesser of the forward stage's and the method's own.
  HeadingCredit heading_credit() const;

 private:
  ForwardStage* forward_;
  std::string own_unsettled_;
  HeadingCredit own_credit_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_METHOD_STAGE_H_
