#ifndef HINDSIGHT_EVALUATION_OBSERVABILITY_H_
#define HINDSIGHT_EVALUATION_OBSERVABILITY_H_

#include <span>
#include <vector>

#include "base/units.h"
#include "evaluation/grade.h"
#include "state/solution.h"

namespace hindsight {

/// A navigation state with a larger standard deviation says nothing.
inline constexpr double kLargestPositionSigma = 1000.0;  ///< an axis [m]
inline constexpr double kLargestVelocitySigma = 10.0;    ///< an axis [m/s]
inline constexpr double kLargestTiltSigma = 5.0 * kDegree;
inline constexpr double kLargestHeadingSigma = 20.0 * kDegree;

/// Component of which an UnobservedSpan leaves places over the ground right, and
/// attitude and velocity, which hardly depend on it.
inline constexpr char kHeightComponent[] = "position[down]";

/// Observed if sigma has fallen below a third of the a priori one, unobserved if
/// it is still above nine tenths, weak in between.
ConstantEstimate::Verdict VerdictOfSigma(double sigma, double prior_sigma);

/// Values, sigmas and verdicts (VerdictOfSigma) of the layout's constants, from
/// the last epoch. Where `excess` says that
/// the errors of the data that a constant is read from are `factor` times as
/// large as stated, its sigma is widened by its share of them in the estimate,
///   sigma'^2 = sigma^2 (1 + (factor^2 - 1) (1 - sigma^2 / prior_sigma^2)),
/// and it is weak where it would be unobserved.
/// `start`: where they started from, if that is known.
std::vector<ConstantEstimate> EstimateConstants(
    const Solution& solution, std::span<const ConstantExcess> excess = {},
    const State* start = nullptr);

/// Covariance of the errors of Solution::constants, as the last epoch has it
/// and with their sigmas; empty where the solution has none of them.
Eigen::MatrixXd CovarianceOfConstants(const Solution& solution);

/// Navigation components whose standard deviation stays above its limit over a
/// span.
std::vector<UnobservedSpan> FindUnobserved(const Solution& solution);

/// Whether the span is half of the interval or more.
bool IsMostOfTheTime(const UnobservedSpan& span, const Solution& solution);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_OBSERVABILITY_H_
