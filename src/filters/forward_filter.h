#ifndef HINDSIGHT_FILTERS_FORWARD_FILTER_H_
#define HINDSIGHT_FILTERS_FORWARD_FILTER_H_

#include <functional>
#include <span>
#include <vector>

#include "filters/covariance_policy.h"
#include "filters/linear_tape.h"
#include "filters/measurement_rule.h"
#include "timeline/problem.h"

namespace hindsight {

/// Called after each epoch with the number done; may throw to stop.
using EpochCallback = std::function<void(std::size_t)>;

/// What a forward filter calls its error, and how its P evolves.
struct ForwardModel {
  ErrorDefinition error = ErrorDefinition::kNavigation;
  CovarianceOptions covariance;
  Supposition supposition = {};
  /// Nodes at the beginning that are linearised about a given trajectory, as of
  /// RunLinearizedFilter; the nominal is reset from the next one on.
  std::span<const State> start = {};
};

/// Forward observer x^' = f(x^) + K (y - h(x^)): predicts through the IMU
/// summaries, updates about x_minus by the sensors' MeasurementRule, resets the
/// nominal at each epoch: the forward pass of one model (filters/imm.h). Writes
/// the tape and integrates the timeline's summaries at its own bias estimates.
/// Throws FiniteEscape if the rule of the covariance has no solution any more,
/// EstimationError if the state is no number.
LinearTape RunForwardFilter(const ForwardModel& model, Problem* problem,
                            const EpochCallback& callback = nullptr);

/// Error-state extended Kalman filter: RunForwardFilter with the defaults.
LinearTape RunExtendedKalmanFilter(Problem* problem,
                                   const EpochCallback& callback = nullptr);

/// Linearised Kalman filter about one fixed nominal trajectory, a state a node:
/// nothing is reset, defects of the nominal enter as c. One RTS pass over its
/// tape is one Gauss-Newton step of the whole-interval problem from `nominal`.
LinearTape RunLinearizedFilter(std::span<const State> nominal, Problem* problem,
                               const EpochCallback& callback = nullptr);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_FORWARD_FILTER_H_
