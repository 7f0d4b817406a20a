#ifndef HINDSIGHT_PROBLEMS_ATTITUDE_CONTRADICTION_H_
#define HINDSIGHT_PROBLEMS_ATTITUDE_CONTRADICTION_H_

#include <vector>

#include "state/covariance_series.h"
#include "state/error_layout.h"
#include "state/state.h"

namespace hindsight {

/// Whether the attitudes of a trajectory contradict those of another of the same nodes,
/// with covariances P that begin with the blocks of `layout`: the mean square of the
/// angle between them is above 25 times the largest variance that P has of an axis.
bool AttitudesContradict(const ErrorLayout& layout,
                         const std::vector<State>& one,
                         const std::vector<State>& other,
                         const CovarianceSeries& P);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_ATTITUDE_CONTRADICTION_H_
