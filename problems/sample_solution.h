#ifndef HINDSIGHT_PROBLEMS_SAMPLE_SOLUTION_H_
#define HINDSIGHT_PROBLEMS_SAMPLE_SOLUTION_H_

#include <vector>

#include "imu/imu_stream.h"
#include "state/solution.h"

namespace hindsight {

/// A solution at other times (ascending, inside its span): the state of the
/// node before, integrated with the IMU (2002 paper, eq. 24), and the jump that
/// remains at the node after spread over the interval in proportion to time.
/// Covariances are interpolated between the two nodes. Throws InputError for a
/// time outside the span.
Solution SampleSolution(const Solution& solution, const ImuStream& imu,
                        const std::vector<double>& times);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_SAMPLE_SOLUTION_H_
