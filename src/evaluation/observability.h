#ifndef HINDSIGHT_EVALUATION_OBSERVABILITY_H_
#define HINDSIGHT_EVALUATION_OBSERVABILITY_H_

#include <vector>

#include "base/units.h"
#include "state/solution.h"

namespace hindsight {

/// A navigation state with a larger standard deviation says nothing.
inline constexpr double kLargestPositionSigma = 1000.0;  ///< an axis [m]
inline constexpr double kLargestVelocitySigma = 10.0;    ///< an axis [m/s]
inline constexpr double kLargestTiltSigma = 5.0 * kDegree;
inline constexpr double kLargestHeadingSigma = 20.0 * kDegree;

/// Values, sigmas and verdicts of the layout's constants, from the last epoch:
/// observed if sigma has fallen below a third of the a priori one, unobserved
/// if it is still above nine tenths, weak in between.
std::vector<ConstantEstimate> EstimateConstants(const Solution& solution);

/// Navigation components whose standard deviation stays above its limit over a
/// span.
std::vector<UnobservedSpan> FindUnobserved(const Solution& solution);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_OBSERVABILITY_H_
