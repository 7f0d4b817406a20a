#ifndef HINDSIGHT_PROBLEMS_ALIGNMENT_TRIAL_H_
#define HINDSIGHT_PROBLEMS_ALIGNMENT_TRIAL_H_

#include <functional>
#include <string>
#include <vector>

#include "problems/montecarlo.h"

namespace hindsight {

/// Recordings without a start value, on which alignment by velocity is tried.
struct AlignmentRecording {
  std::string name;
  std::function<Dataset(std::uint64_t seed)> dataset;
};

struct AlignmentTrialOptions {
  double t_early = 0.0;        ///< data up to here make the early attitude [s]
  double diverged_tilt = 0.0;  ///< [rad]
  double diverged_heading = 0.0;  ///< [rad]
  double last = 0.0;  ///< length of the end that decides on failure [s]
};

/// What one way of aligning made of all runs. Errors of the attitude in NED:
/// tilt is the norm of its horizontal part, about two axes.
struct AlignmentStatistics {
  std::string recording;
  std::string name;  ///< "velocity_alignment", "velocity_alignment_batch"
  int runs = 0;
  int failed = 0;    ///< no answer, or beyond the limits at the end
  int answered = 0;  ///< runs whose errors the figures below are of
  /// Of velocity_alignment the epoch t_early, of the batch the whole interval.
  struct Angle {
    double rms = 0.0;      ///< over runs and epochs [rad]
    double worst = 0.0;    ///< over the runs, at the epoch where it is largest
    double sigma = 0.0;    ///< stated, root mean square over runs and epochs
    double largest = 0.0;  ///< of a single run at a single epoch
  };
  Angle tilt, heading;
  /// Mean of e' P^-1 e: of the attitude (3 is right) at the first epoch, and of
  /// the batch over all nodes.
  double anees = 0.0;
  /// Share of the nodes at which the average over the runs is outside the
  /// bounds; of velocity_alignment 1 or 0.
  double anees_outside = 0.0;
  double anees_lower = 0.0;
  double anees_upper = 0.0;
  double seconds = 0.0;  ///< processor time, mean
};

/// Tries both on every seed: AlignmentWindow up to t_early, and the batch over
/// the whole interval from the start that `alignment: velocity` finds. Empty
/// where no run is finished.
std::vector<AlignmentStatistics> TryAlignment(
    const std::vector<AlignmentRecording>& recordings,
    const AlignmentTrialOptions& trial, const MonteCarloOptions& options,
    const Watch<std::vector<AlignmentStatistics>>& watch = {});

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_ALIGNMENT_TRIAL_H_
