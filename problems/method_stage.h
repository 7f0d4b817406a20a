#ifndef HINDSIGHT_PROBLEMS_METHOD_STAGE_H_
#define HINDSIGHT_PROBLEMS_METHOD_STAGE_H_

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "problems/batch_ahead.h"
#include "problems/clocks_without.h"
#include "problems/forward_stage.h"
#include "problems/node_placement.h"

namespace hindsight {

/// What one method works with: the forward stage that all share, and what the
/// method finds out beside its solution.
class MethodStage {
 public:
  /// The problem on some nodes, and a trajectory to begin from.
  struct Nodes {
    Problem* problem;
    const std::vector<State>* states;
    /// By sensor, from its stamps to its nodes [s].
    const std::vector<double>* offsets;
  };

  /// The stage of `clocks` has run; they and `ahead`, its batch if that is solved
  /// already, outlive the object.
  explicit MethodStage(const ClockChoice* clocks, BatchAhead* ahead = nullptr)
      : clocks_(clocks), forward_(clocks->stage.get()), ahead_(ahead) {}

  /// Begins elsewhere than the other methods.
  explicit MethodStage(ClocksWithout elsewhere)
      : elsewhere_(std::make_unique<ClocksWithout>(std::move(elsewhere))),
        clocks_(&elsewhere_->choice),
        forward_(clocks_->stage.get()) {}

  const ClockChoice& clocks() const { return *clocks_; }
  ForwardStage& forward() const { return *forward_; }
  const ErrorLayout& layout() const { return forward_->problem().layout; }
  Nodes SharedNodes() const;

  /// Solves on the shared nodes, and on nodes of its own as long as the
  /// method's time offsets are elsewhere. Where those of the forward stage did not
  /// settle only a method with a model of its own (SetFit or KnowMore in `solve`) goes
  /// on: what it knows of the sensors may be why.
  Solution AtOwnNodes(const std::function<Solution(const Nodes&)>& solve);

  /// As SmoothedSolution, on these nodes.
  Solution FromSmoothed(std::vector<State> states, CovarianceSeries P,
                        const Nodes& nodes) const;

  /// The problem of the nodes without trust in the position sensor that the
  /// start comes from.
  Problem Questioned(const Nodes& nodes) const;

  /// Holds the innovations about an optimum that AtOwnNodes found against its
  /// model, unless the forward stage's, about the same trajectory, are.
  void JudgeOptimum(const Solution& solution);

  /// Computes the credit of the heading about the method's own result, unless that
  /// is the forward stage's trajectory, linearised anew, which has its own.
  void JudgeHeading(const Solution& solution, const Nodes& nodes);

  /// Names the timeline that the solution is found on, if it is none of the
  /// nodes that AtOwnNodes hands out.
  void SetTimeline(Timeline timeline) { timeline_ = std::move(timeline); }
  /// The timeline of the solution where it is not the forward stage's.
  std::optional<Timeline> TakeTimeline();

  /// What the measurements say of a method's own model, where it is another than
  /// the stated one.
  void SetFit(Fit fit) { own_fit_ = std::move(fit); }
  /// The method has a model of its own, without a judgement of it as yet.
  void KnowMore() { knows_more_ = true; }
  /// How a method that linearises once compares with its own model, linearised
  /// anew.
  void SetLinearisation(const LinearisationError& error) {
    own_linearisation_ = error;
  }
  const std::optional<LinearisationError>& linearisation() const {
    return own_linearisation_;
  }
  /// What the method itself says against its result.
  void SetDoubts(std::vector<Evidence> doubts) { doubts_ = std::move(doubts); }
  const std::vector<Evidence>& doubts() const { return doubts_; }

  const Fit& fit() const { return own_fit_ ? *own_fit_ : forward_->fit(); }

  /// Of the reconstruction, with its progress under the name "batch".
  BatchOptions MakeBatchOptions() const;
  /// The batch from the states of the nodes; on the shared ones what BatchAhead
  /// found, if there is one. Adds to `seconds` what that took on other threads.
  BatchResult SolveBatch(const Nodes& nodes, double* seconds);

  /// Sensor whose time offset did not settle on the method's own nodes, or on
  /// those of the forward stage if the method's did not either; empty: none.
  const std::string& unsettled() const;
  /// The lesser of the forward stage's and the method's own.
  HeadingCredit heading_credit() const;

 private:
  /// On the nodes that AtOwnNodes ended with.
  Problem& problem();
  /// Of a solution on the forward stage's nodes.
  bool IsAsLinearisedAnew(const Solution& solution) const;

  std::unique_ptr<ClocksWithout> elsewhere_;  ///< null: where all begin
  const ClockChoice* clocks_;
  ForwardStage* forward_;
  BatchAhead* ahead_ = nullptr;
  std::string own_unsettled_;
  bool settled_ = false;  ///< on the nodes that AtOwnNodes ended with
  HeadingCredit own_credit_;
  std::optional<PlacedNodes> own_;  ///< where they are not the forward stage's
  std::optional<Timeline> timeline_;
  std::optional<Fit> own_fit_;
  bool knows_more_ = false;
  std::optional<LinearisationError> own_linearisation_;
  std::vector<Evidence> doubts_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_METHOD_STAGE_H_
