#ifndef HINDSIGHT_PROBLEMS_MARGINAL_LIKELIHOOD_H_
#define HINDSIGHT_PROBLEMS_MARGINAL_LIKELIHOOD_H_

#include <Eigen/Core>
#include <map>
#include <utility>
#include <vector>

#include "dataset/dataset.h"
#include "timeline/problem.h"

namespace hindsight {

/// Besides a likelihood: nothing, or by what noise its innovations come about.
enum class LikelihoodParts { kAlone, kWithNoise };

/// ln p(measurements) of an explanation, and how its innovations fare; the last two
/// of LikelihoodParts::kWithNoise.
struct MarginalLikelihood {
  double log = 0.0;
  double squares = 0.0;  ///< sum of the normalised squared innovations
  double rows = 0.0;     ///< their components
  /// Innovations of the accepted measurements, whitened by the Cholesky factor
  /// of their covariances, by sensor and stamp.
  std::map<std::pair<int, double>, Eigen::VectorXd> whitened;
  /// How many combinations of the IMU's noise w the measurements know: the
  /// trace of I - Q^-1 cov(w | measurements), over all intervals. In so many
  /// of the whitened innovations stands the IMU's noise, not the measurements'.
  double imu_noise = 0.0;
};

/// The prior by which explanations are compared, so that all share one. It has
/// what the data set states of biases, constants, position, velocity and
/// attitude. What is not stated is that of `x`, the first state of the
/// explanation, with sigmas of 100 m and 100 m/s and any attitude; so are the
/// clocks, as LogClockPrior counts what is stated of them.
Prior PriorOfComparison(const Dataset& dataset, const Problem& problem,
                        const State& x);

/// ln of the a priori density of the time offsets that are estimated, less its
/// maximum, at the state x; of an unknown clock 0.
double LogClockPrior(const Dataset& dataset, const ErrorLayout& layout,
                     const State& x);

/// Marginal likelihood of the measurements that `used` names, in the problem
/// linearised about `nominal`: the likelihood of the forward filter's
/// innovations there, which is Laplace's approximation
///   -cost(MAP) + ln det(2 pi P)/2 with all priors in it,
/// the step from `nominal` to the MAP taken as linear. Of a measurement that is
/// used but rejected by its decisions its gate's limit counts in place of its
/// innovation.
MarginalLikelihood MarginalLikelihoodOf(Problem problem,
                                        const std::vector<State>& nominal,
                                        const GateDecisions& used,
                                        LikelihoodParts parts);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_MARGINAL_LIKELIHOOD_H_
