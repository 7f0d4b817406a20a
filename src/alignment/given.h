#ifndef HINDSIGHT_ALIGNMENT_GIVEN_H_
#define HINDSIGHT_ALIGNMENT_GIVEN_H_

#include "alignment/alignment.h"

namespace hindsight {

/// When what is given of the start holds: InitialState::t, but not before
/// `from`; `from` without one. Where the body was and how it moved then says
/// nothing of another time: throws InputError if that is given and its time lies
/// outside of [from, to), by more than two samples before it.
double GivenStartTime(const Dataset& dataset, double from, double to);

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
