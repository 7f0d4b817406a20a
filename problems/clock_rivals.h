#ifndef HINDSIGHT_PROBLEMS_CLOCK_RIVALS_H_
#define HINDSIGHT_PROBLEMS_CLOCK_RIVALS_H_

#include <memory>
#include <vector>

#include "problems/batch.h"
#include "problems/forward_stage.h"
#include "state/rival_solution.h"

namespace hindsight {

/// A data set with its clocks at given offsets, solved to its end.
struct SolvedClocks {
  std::vector<double> offsets;  ///< from which it was solved [s]
  std::unique_ptr<ForwardStage> stage;
  BatchResult batch;
};

/// Aligns, filters, smooths and solves the batch with nodes placed at the time
/// offsets that `dataset` has now and wherever they move. Throws
/// EstimationError if that does not converge.
SolvedClocks SolveWithClocks(const std::vector<double>& offsets,
                             const Dataset& dataset,
                             const ReconstructionOptions& options);

/// Which has the largest evidence, with the a priori distributions of
/// `dataset`, where the clocks are as they are given, compared two at a time on
/// the measurements that both have inside the IMU's record.
std::size_t Likeliest(const Dataset& dataset,
                      const std::vector<SolvedClocks>& solved);

/// All that came to another end than the chosen one, the likeliest first, with
/// their probabilities. `streams` are those whose clocks were in question.
/// Innovations of the chosen one whose mean square is above one say by how much
/// the noise is larger than stated; differences of ln evidence are divided by
/// it.
std::vector<RivalSolution> Rivals(const Dataset& dataset,
                                  const std::vector<std::size_t>& streams,
                                  const std::vector<SolvedClocks>& solved,
                                  std::size_t chosen);

/// Adds as one rival the `count` combinations that were not solved, as fitting
/// less well by the coarse search. Each is taken to be as likely as the least
/// likely of those that were: where the motion repeats itself, one of many.
void AddUnsolved(double count, std::vector<RivalSolution>* rivals);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_CLOCK_RIVALS_H_
