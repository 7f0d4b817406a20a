#ifndef HINDSIGHT_PROBLEMS_ROUGH_TRAJECTORY_H_
#define HINDSIGHT_PROBLEMS_ROUGH_TRAJECTORY_H_

#include <vector>

#include "problems/method_stage.h"

namespace hindsight {

/// The trajectory about which errors of sensors are sought, a state a node: that of
/// the IMM smoother. The EKF's may be so far off after an outlier that a linearisation
/// about it is of no use. So may be one that follows headings which err: where those
/// contradict what moves, by a mean square of the angle above 25 of the latter's
/// variances, it is the one without them. `problem` is that of the nodes with what is
/// to be used, among which are blunders it leaves out if `has_blunders`.
std::vector<State> RoughStates(const MethodStage& stage,
                               const MethodStage::Nodes& nodes,
                               const Problem& problem, bool has_blunders);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_ROUGH_TRAJECTORY_H_
