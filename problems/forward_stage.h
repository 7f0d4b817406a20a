#ifndef HINDSIGHT_PROBLEMS_FORWARD_STAGE_H_
#define HINDSIGHT_PROBLEMS_FORWARD_STAGE_H_

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "alignment/start.h"
#include "dataset/timeline_builder.h"
#include "filters/heading_profile.h"
#include "filters/rts.h"
#include "problems/fit.h"
#include "problems/linearisation.h"
#include "problems/node_placement.h"
#include "problems/reconstruction.h"
#include "problems/single_pass.h"
#include "state/rival_solution.h"
#include "state/solution.h"

namespace hindsight {

/// What every method of a reconstruction begins with: the start, the timeline
/// with its nodes where the measurements belong, the forward filter, the gates
/// as the whole interval decides them, and the RTS pass about them.
class ForwardStage {
 public:
  /// Aligns, places the nodes, preintegrates. `dataset` must outlive the
  /// object. Errors as of Reconstruction.
  ForwardStage(const Dataset& dataset, const ReconstructionOptions& options);
  /// From a start that is known.
  ForwardStage(const Dataset& dataset, ReconstructionOptions options,
               Start start);

  /// Settles from the sensors' time offsets. What follows is valid after it.
  void Run();

  /// Filters and smooths on nodes placed by `offsets`, one a sensor [s]. Where
  /// time offsets are estimated: first with them as noise, for a trajectory to
  /// linearise them along (Timeline::LinearizeTimeOffsets); then as states,
  /// nodes being placed anew at the smoother's estimates until these are within
  /// a tenth of their sigmas of where the nodes stand, and stay so when they
  /// are linearised along that solution; or `unsettled` says whose never were.
  void Settle(std::vector<double> offsets);

  const Dataset& dataset() const { return dataset_; }
  const ReconstructionOptions& options() const { return options_; }
  const Start& start() const { return start_; }
  /// The problem as whole-interval methods solve it, with the measurements that
  /// they use.
  Problem& problem() { return problem_; }
  const Problem& problem() const { return problem_; }
  /// The problem as a filter solves it that knows the past alone: gates decide
  /// by the innovation.
  Problem CausalProblem() const;
  const Timeline& timeline() const { return problem_.timeline; }
  /// Whether any sensor has a robust loss.
  bool has_losses() const {
    return std::any_of(timeline().sensors().begin(), timeline().sensors().end(),
                       [](const Sensor& sensor) {
                         return sensor.loss.kind != RobustLoss::Kind::kNone;
                       });
  }
  const SmoothedTrajectory& smoothed() const { return *smoothed_; }
  /// In place of Run, for `problem` and the states of `smoothed` alone: of those no
  /// covariances are found but where nodes or gates hang on them.
  std::vector<State> SmoothedStates();
  /// The states of `relinearised` from those, without what else it says.
  std::vector<State> RestedStates(const std::vector<State>& smoothed);
  double smoothing_seconds() const { return smoothing_seconds_; }
  /// Spans that the data leave undetermined; found when first asked for.
  const std::vector<UnobservedSpan>& unobserved();
  /// Found when first asked for.
  const Relinearised& relinearised();
  /// What a batch begins at: the smoothed trajectory or, unless sensors have a loss,
  /// what linearising anew led to where that contracted: its passes are steps that
  /// the batch would take itself.
  const std::vector<State>& batch_start();
  /// Of the interval as linearised anew; found when first asked for, empty where
  /// no new linearisation held.
  const Fit& fit();
  /// CreditHeading of the interval as linearised anew; found when first
  /// asked for.
  const HeadingCredit& heading_credit();
  /// The trajectory turned round, where its heading comes from its own motion
  /// and may be the opposite one as well; its probability is not set yet. Found
  /// when first asked for.
  const std::optional<RivalSolution>& turned_round();
  /// Time offsets that the nodes are placed by, one a sensor [s].
  const std::vector<double>& offsets() const { return offsets_; }
  /// Sensor whose estimated time offset did not settle; empty: none.
  const std::string& unsettled() const { return unsettled_; }
  /// Nodes placed by other time offsets, as PlaceNodesAnew.
  PlacedNodes PlaceAnew(std::vector<double> offsets, const Problem& problem,
                        const ErrorLayout& layout,
                        const std::vector<State>& states) const;

  /// Hands out the forward filter's solution, which a day makes too large to
  /// keep twice; whoever asks again has it filtered again.
  Solution TakeFiltered();

  /// A pass of the Kalman filter with the error definition of the options, its
  /// first nodes linearised about `start` (ForwardModel).
  LinearTape Filter(const std::string& stage, Problem* problem,
                    std::span<const State> start = {}) const;

  /// What smoothers that linearise once give: of `rts`, and the tape of the
  /// others. The filter's start is realigned where that cures them (Realign).
  const SmoothedTrajectory& smoothed_once();
  LinearTape FilterOnce(const std::string& stage);

  /// Reports progress under the name of a stage; throws Interrupted if asked.
  EpochCallback Progress(const std::string& stage) const;

 private:
  TimelineOptions MakeTimelineOptions() const;
  void RunOnce();
  void JudgeObservability();
  CovarianceSeries Relinearise();
  void JudgeHeading(const SmoothedTrajectory& last);
  void RepeatWithSmoothedGates();
  const Realigned& realigned();

  const Dataset& dataset_;
  ReconstructionOptions options_;
  std::vector<double> offsets_;
  std::string unsettled_;
  std::optional<std::vector<UnobservedSpan>> unobserved_;
  std::optional<Relinearised> relinearised_;
  std::optional<Realigned> realigned_;
  /// About `smoothed`, where `relinearised` is as near as makes no difference;
  /// until `fit`.
  std::optional<LinearTape> settled_tape_;
  std::optional<Fit> fit_;
  HeadingCredit heading_credit_;
  std::optional<RivalSolution> turned_round_;
  Start start_;
  Problem problem_;
  std::optional<Solution> filtered_;
  std::optional<SmoothedTrajectory> smoothed_;
  double smoothing_seconds_ = 0.0;
};

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_FORWARD_STAGE_H_
