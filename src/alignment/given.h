#ifndef HINDSIGHT_ALIGNMENT_GIVEN_H_
#define HINDSIGHT_ALIGNMENT_GIVEN_H_

#include "alignment/alignment.h"

namespace hindsight {

/// Method `given`: initial.attitude with initial.attitude_sigma (default 1, 1,
/// 2 deg); or LevelAttitude with initial.heading (default 2 deg).
AlignmentOutcome AlignAsGiven(const AlignmentInput& input);

/// Covariance of psi [rad^2] from standard deviations of roll, pitch, heading
/// about an attitude: roll and pitch turn about axes that heading (and pitch)
/// have turned.
Eigen::Matrix3d AttitudeCovariance(const Eigen::Vector3d& euler,
                                   const Eigen::Vector3d& sigma);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_GIVEN_H_
