#ifndef HINDSIGHT_PROBLEMS_SAMPLE_SOLUTION_H_
#define HINDSIGHT_PROBLEMS_SAMPLE_SOLUTION_H_

#include <vector>

#include "filters/covariance_policy.h"
#include "imu/imu_stream.h"
#include "state/solution.h"
#include "timeline/timeline.h"

namespace hindsight {

/// Longest step in which a covariance is propagated between nodes [s]. It is
/// linear within a step, which leaves P_pp too large by up to P_vv step^2 / 4:
/// half a percent of sigma where velocity errors move the position by its own
/// sigma in a second.
inline constexpr double kPropagationStep = 0.2;

/// A solution at other times (ascending, inside its span; at a node, the node):
/// the state of the node before, integrated with the IMU (Yu, Lee, Park and Han
/// 2002, eq. (24)) in one walk over the samples that needs neither Jacobians nor
/// noise; parameters and travelled distances go on as from node to node
/// (Advance), `timeline` being that which the solution was found on.
///   smoothers  what the prediction misses of the node after is spread over
///              the interval in proportion to time; with a the part of the
///              interval before t, Phi and Q of position, velocity and attitude
///              from the node before to t (all else constant),
///              Psi = Phi(t, node after),
///                P = (1 - a) (Phi P_k Phi' + Q) + a Psi P_k+1 Psi':
///              exact without noise of the IMU, and with it not less than what
///              either node predicts in proportion to its closeness. Of nodes
///              closer than kPropagationStep it is interpolated. Where the
///              timeline has steps of the velocity, position and velocity have
///              the gain and the covariance of StepBridge in their place.
///   forward methods (Solution::forward)
///              the prediction as it is, P <- Phi P Phi' + Q from the node
///              before, of an observer with its prescribed stability
///              (`covariance`): no later measurement shows.
/// Throws InputError for a time outside the span.
Solution SampleSolution(const Solution& solution, const Timeline& timeline,
                        const ImuStream& imu, const std::vector<double>& times,
                        const CovarianceOptions& covariance = {});

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_SAMPLE_SOLUTION_H_
