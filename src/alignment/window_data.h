#ifndef HINDSIGHT_ALIGNMENT_WINDOW_DATA_H_
#define HINDSIGHT_ALIGNMENT_WINDOW_DATA_H_

#include "alignment/alignment.h"

namespace hindsight {

/// What [input.t, t_end] holds of a recording: the IMU's samples, and of the
/// aiding what needs no calibration found elsewhere first (positions,
/// velocities, heights, speeds with courses, standstill), withheld measurements
/// left out. A sensor without any left has no states. The gyro biases start as
/// GyroBiasBefore says.
Dataset CutOut(const AlignmentInput& input, double t_end);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_WINDOW_DATA_H_
