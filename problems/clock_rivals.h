#ifndef HINDSIGHT_PROBLEMS_CLOCK_RIVALS_H_
#define HINDSIGHT_PROBLEMS_CLOCK_RIVALS_H_

#include <cstddef>
#include <vector>

#include "problems/clock_solution.h"
#include "state/rival_solution.h"

namespace hindsight {

/// The time offset of a stream in the last state of a solution [s].
double FinalOffset(const SolvedClocks& solved, std::size_t stream);

/// Whether two solutions are the same: clocks of `streams` within 20 ms,
/// heading within 5 deg.
bool SameEnd(const std::vector<std::size_t>& streams, const SolvedClocks& one,
             const SolvedClocks& other);

/// Takes away every solution that is the same as one before it.
void RemoveSame(const std::vector<std::size_t>& streams,
                std::vector<SolvedClocks>* solved);

/// The likeliest solution, and ln of each one's evidence over that of it.
struct ClockRanking {
  std::size_t best = 0;
  std::vector<double> log_evidence;
};

/// Compares them two at a time by LogEvidenceRatio. Those within 25 of the best
/// are carried to convergence, as is the best beside them; of the others the
/// linear step from where the smoother left them counts.
ClockRanking Rank(const Dataset& dataset, std::vector<SolvedClocks>* solved);

/// All but the best, the likeliest first, with their probabilities. `streams`
/// are those whose clocks were in question.
std::vector<RivalSolution> Rivals(const Dataset& dataset,
                                  const std::vector<std::size_t>& streams,
                                  const std::vector<SolvedClocks>& solved,
                                  const ClockRanking& ranking);

/// Adds as one rival the `count` combinations that were not solved, as fitting
/// less well by the coarse search. Each is taken to be as likely as the least
/// likely of those that were: where the motion repeats itself, one of many.
void AddUnsolved(double count, std::vector<RivalSolution>* rivals);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_CLOCK_RIVALS_H_
