#ifndef HINDSIGHT_ALIGNMENT_COURSE_H_
#define HINDSIGHT_ALIGNMENT_COURSE_H_

#include "alignment/alignment.h"

namespace hindsight {

/// Method `course`: LevelAttitude, and as heading the course of the first
/// motion above 3 m/s and ten sigmas, carried back to the epoch by the gyros;
/// forward motion is assumed, along the forward axis of the first odometer or
/// non-holonomic stream. Without one, and unless the configuration asks for the
/// course, which then takes the body's x axis, there is no answer: the course
/// is the heading of the motion, not of an IMU that sits anyhow. Sigma: 3 deg
/// of side slip, the velocity's sigma over the speed, the gyros' drift
/// meanwhile, and the a priori sigma of the yaw of a vehicle mounting that is
/// estimated.
AlignmentOutcome AlignByCourse(const AlignmentInput& input);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_COURSE_H_
