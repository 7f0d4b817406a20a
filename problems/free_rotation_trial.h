#ifndef HINDSIGHT_PROBLEMS_FREE_ROTATION_TRIAL_H_
#define HINDSIGHT_PROBLEMS_FREE_ROTATION_TRIAL_H_

#include "problems/montecarlo.h"
#include "state/solution.h"

namespace hindsight {

/// Both methods of attitude alone on a recording that moves from `begin` to
/// `end` [s], with truth at every sample.
///
/// Figures, in columns field and method: heading_rms and tilt_rms [rad] of the
/// motion; nees of the attitude in its middle, mean over the runs, where 3 is
/// right; inside, the share of the motion's samples within the ellipsoid that
/// holds 99.73 %.
Trial FreeRotationTrial();
StudyTable FreeRotationTable(double begin, double end);

/// Truth from an estimate of the attitude alone, in NED [rad].
Eigen::Vector3d RotationError(const TruthPoint& truth, const State& x);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_FREE_ROTATION_TRIAL_H_
