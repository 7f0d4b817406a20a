#ifndef HINDSIGHT_PROBLEMS_TILT_BATCH_H_
#define HINDSIGHT_PROBLEMS_TILT_BATCH_H_

#include <functional>

#include "problems/attitude_batch.h"

namespace hindsight {

/// The batch of attitude alone, in Ceres, on the nodes of the other form:
/// preintegrated gyros with their scale factors, gyro bias as a walk, specific
/// force averaged both ways in axes that do not turn (IFLP) as tilt sensor, the
/// field as a vector, each reading with the weight that the survey's robust
/// estimate left it. A magnetic disturbance is a Gauss-Markov state of every
/// node; the field's horizontal and vertical
/// part and, where the data set gives it a sigma, the declination are constants
/// that are estimated. A state an IMU sample, layout {attitude, gyro bias}.
Solution SolveTiltBatch(const RoomProblem& problem,
                        const std::function<void(double)>& progress);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_TILT_BATCH_H_
