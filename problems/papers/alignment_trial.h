#ifndef HINDSIGHT_PROBLEMS_PAPERS_ALIGNMENT_TRIAL_H_
#define HINDSIGHT_PROBLEMS_PAPERS_ALIGNMENT_TRIAL_H_

#include "problems/montecarlo.h"

namespace hindsight {

/// Two ways from no start value: "velocity_alignment", AlignmentWindow up to
/// `t_early` [s], judged at that epoch, and "velocity_alignment_batch" over the
/// whole interval from the start that `alignment: velocity` finds. A run fails
/// without an answer, or where it diverges (problems/papers/attitude_limits.h);
/// the figures, by method, are of all that answered.
///
/// Errors of the attitude in NED; tilt is the norm of its horizontal part,
/// about two axes. Of both angles _rms over runs and epochs, _worst over the
/// runs at the epoch where it is largest, and _sigma, stated, root mean square.
/// anees, mean of e' P^-1 e (3 is right) over the judged epochs; anees_outside,
/// the share of those epochs at which the average over the runs is outside of
/// the bounds.
Trial AlignmentTrial(double t_early);
StudyTable AlignmentTable();

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_PAPERS_ALIGNMENT_TRIAL_H_
