#ifndef HINDSIGHT_PROBLEMS_CLOCK_CHOICE_H_
#define HINDSIGHT_PROBLEMS_CLOCK_CHOICE_H_

#include <memory>
#include <vector>

#include "problems/forward_stage.h"
#include "state/rival_solution.h"

namespace hindsight {

/// The beginning of every method, its clocks decided.
struct ClockChoice {
  const Dataset* given = nullptr;  ///< clocks as they are given; outlives this
  /// A copy with the chosen offsets; null where there was nothing to choose.
  std::unique_ptr<Dataset> dataset;
  std::unique_ptr<ForwardStage> stage;
  std::vector<RivalSolution> rivals;
};

/// Whether the clock of any stream is unknown or is to be estimated with an a priori
/// sigma of 0.1 s or more.
bool HasClocksInQuestion(const Dataset& dataset);

/// Decides the time offset of every such stream. Candidates are the
/// offsets that SearchClock finds (where there is an a priori sigma, within
/// four of it) and the given one if that is none of them, as far as they are
/// plausible (IsPlausible); of several streams up to eight combinations. If
/// there is but one, it is taken. Else the data are solved at each, with nodes
/// placed there (SolveCoarsely), and the solution of the largest evidence is
/// chosen (Rank). Methods then start at its offsets, from the start that
/// FindStart finds there. The others are rivals.
/// Throws EstimationError if an unknown clock is not found, and as
/// ForwardStage.
ClockChoice ChooseClocks(const Dataset& dataset,
                         const ReconstructionOptions& options);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_CLOCK_CHOICE_H_
