#ifndef HINDSIGHT_PROBLEMS_CLOCK_CHOICE_H_
#define HINDSIGHT_PROBLEMS_CLOCK_CHOICE_H_

#include <memory>
#include <vector>

#include "problems/forward_stage.h"
#include "state/rival_solution.h"

namespace hindsight {

/// The beginning of every method, its clocks decided.
struct ClockChoice {
  /// A copy with the chosen offsets; null where there was nothing to choose.
  std::unique_ptr<Dataset> dataset;
  std::unique_ptr<ForwardStage> stage;
  std::vector<RivalSolution> rivals;
};

/// Decides where the clock of every stream stands that is unknown or is to be
/// estimated with an a priori sigma of 0.1 s or more: at each offset that
/// SearchClock finds, of the latter within four sigmas, and at the given one if
/// that is none of them, the data are aligned and solved to the end with nodes
/// placed there; of several streams up to eight combinations. Chosen is the
/// solution of the largest evidence (MarginalLikelihoodOf, the given time
/// offset and its sigma in it), two at a time and on the measurements that both
/// have inside the IMU's record. Methods then start at its offsets. The others
/// are rivals; where noise is larger than stated, by the innovations of the
/// chosen one, their evidence counts accordingly less. Nothing is solved where
/// one offset alone comes into question and is where the configuration has it.
/// Throws EstimationError if an unknown clock is not found, and as
/// ForwardStage.
ClockChoice ChooseClocks(const Dataset& dataset,
                         const ReconstructionOptions& options);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_CLOCK_CHOICE_H_
