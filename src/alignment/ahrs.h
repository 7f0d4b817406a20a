#ifndef HINDSIGHT_ALIGNMENT_AHRS_H_
#define HINDSIGHT_ALIGNMENT_AHRS_H_

#include "alignment/alignment.h"

namespace hindsight {

/// Method `ahrs`: the attitude filter of attitude_filter.h, with the settings
/// of Dataset::ahrs, over the first 30 s from the epoch asked for, smoothed
/// back to it. It needs neither rest nor velocity, only that the acceleration
/// averages out; roll, pitch and gyro bias are found, the heading if there is a
/// magnetometer. Nothing is found in less than 5 s.
AlignmentOutcome AlignByAhrs(const AlignmentInput& input);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_AHRS_H_
