#ifndef HINDSIGHT_PROBLEMS_RIVAL_DATA_H_
#define HINDSIGHT_PROBLEMS_RIVAL_DATA_H_

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "problems/clock_evidence.h"
#include "problems/forward_stage.h"
#include "state/rival_solution.h"

namespace hindsight {

/// Whether a rival has readings of the IMU at other times than the chosen solution
/// (LogEvidenceRatio), or the same (LogLikelihoodRatio).
enum class RivalReadings { kAtOtherTimes, kTheSame };

/// Compares rivals with a chosen solution. Several threads may use one.
class RivalComparison {
 public:
  /// `chosen` has run, and must outlive it.
  explicit RivalComparison(ForwardStage* chosen);

  /// Solves `rival`, a stage of the recording as it may be instead, to its end and
  /// compares it by its evidence and `log_odds`, what is known beforehand. Returns
  /// `words` with evidence, 30 at most, and end; nothing where the position, velocity
  /// and attitude of both are less than a standard deviation apart, in the root mean
  /// square over the nodes of both, or where the rival is hopeless. Throws
  /// EstimationError where it cannot be solved.
  std::optional<RivalSolution> Solve(double log_odds, RivalReadings readings,
                                     RivalSolution words, ForwardStage* rival);

 private:
  bool IsNear(const std::vector<State>& rival) const;

  const Relinearised& own_;
  const ErrorLayout& layout_;
  ChosenExplanation chosen_;
};

/// Of `count` recordings as they may be instead, each by `solve` (RivalComparison) with
/// ln of the odds beforehand, those that the rule `rival` would tell. Of a right
/// model the evidence of another exceeds its own by a factor K with a probability
/// below 1/K (Markov): they are taken to be so rare that the rule calls all of them
/// together doubtful with kFalseAlarms. What cannot be solved is no rival. Several
/// are solved at once.
std::vector<RivalSolution> RareRivals(
    std::size_t count,
    const std::function<std::optional<RivalSolution>(std::size_t i,
                                                     double log_odds)>& solve);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_RIVAL_DATA_H_
