#ifndef HINDSIGHT_PROBLEMS_PAPERS_ALIGNMENT_TRIAL_H_
#define HINDSIGHT_PROBLEMS_PAPERS_ALIGNMENT_TRIAL_H_

#include "problems/montecarlo.h"

namespace hindsight {

struct AlignmentTrialOptions {
  double t_early = 0.0;        ///< data up to here make the early attitude [s]
  double diverged_tilt = 0.0;  ///< [rad]
  double diverged_heading = 0.0;  ///< [rad]
  double last = 0.0;  ///< length of the end that decides on failure [s]
};

/// Two ways from no start value: "velocity_alignment", AlignmentWindow up to t_early,
/// judged at that epoch, and "velocity_alignment_batch" over the whole interval
/// from the start that `alignment: velocity` finds. A run fails without an
/// answer, or beyond the limits at the end; the figures, by method, are of all
/// that answered.
///
/// Errors of the attitude in NED; tilt is the norm of its horizontal part,
/// about two axes. Of both angles _rms over runs and epochs, _worst over the
/// runs at the epoch where it is largest, and _sigma, stated, root mean square.
/// anees, mean of e' P^-1 e (3 is
/// right): at the first epoch, and of the batch over all nodes; anees_outside,
/// the share of those epochs at which the average over the runs is outside of
/// the bounds.
Trial AlignmentTrial(const AlignmentTrialOptions& trial);
StudyTable AlignmentTable();

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_PAPERS_ALIGNMENT_TRIAL_H_
