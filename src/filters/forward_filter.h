#ifndef HINDSIGHT_FILTERS_FORWARD_FILTER_H_
#define HINDSIGHT_FILTERS_FORWARD_FILTER_H_

#include <functional>
#include <span>
#include <vector>

#include "filters/covariance_policy.h"
#include "filters/linear_tape.h"
#include "filters/measurement_rule.h"
#include "measurements/timeline.h"

namespace hindsight {

/// Where a forward pass starts: a state and the covariance of its error.
struct Prior {
  State x;
  ErrorMatrix P;
};

/// Called after each epoch with the number done; may throw to stop.
using EpochCallback = std::function<void(std::size_t)>;

/// What a forward filter calls its error, and how its P evolves.
struct ForwardModel {
  ErrorDefinition error = ErrorDefinition::kNavigation;
  CovarianceOptions covariance;
  Supposition supposition = {};
};

/// Forward observer x^' = f(x^) + K (y - h(x^)): predicts through the IMU
/// summaries, updates about x_minus by the sensors' MeasurementRule, resets the
/// nominal at each epoch. Writes the tape and integrates the timeline's
/// summaries at its own bias estimates. Throws FiniteEscape if the rule of the
/// covariance has no solution any more, EstimationError if the state is no
/// number.
LinearTape RunForwardFilter(const ForwardModel& model,
                            const ErrorLayout& layout, const Prior& prior,
                            Timeline* timeline,
                            const GateDecisions& decisions = {},
                            const EpochCallback& callback = nullptr);

/// Error-state extended Kalman filter: RunForwardFilter with the defaults.
LinearTape RunExtendedKalmanFilter(const ErrorLayout& layout,
                                   const Prior& prior, Timeline* timeline,
                                   const GateDecisions& decisions = {},
                                   const EpochCallback& callback = nullptr);

/// Linearised Kalman filter about one fixed nominal trajectory, a state a node:
/// nothing is reset, defects of the nominal enter as c. One RTS pass over its
/// tape is one Gauss-Newton step of the whole-interval problem from `nominal`.
LinearTape RunLinearizedFilter(const ErrorLayout& layout, const Prior& prior,
                               std::span<const State> nominal,
                               Timeline* timeline,
                               const GateDecisions& decisions = {},
                               const EpochCallback& callback = nullptr);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_FORWARD_FILTER_H_
