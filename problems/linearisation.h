#ifndef HINDSIGHT_PROBLEMS_LINEARISATION_H_
#define HINDSIGHT_PROBLEMS_LINEARISATION_H_

#include <optional>
#include <string>
#include <vector>

#include "problems/method.h"
#include "state/covariance_series.h"
#include "state/solution.h"

namespace hindsight {

/// The whole interval, linearised anew about a smoothed trajectory.
struct Relinearised {
  /// Largest angle between an attitude that the forward filter was linearised
  /// about and the smoothed one [rad].
  double turn = 0.0;
  /// Empty if no new linearisation held.
  std::vector<State> states;
  /// Root mean square distance of the smoothed trajectory from `states`,
  /// DistanceInSigmas.
  double smoother_sigmas = 0.0;
};

/// Largest angle between the attitudes of two trajectories [rad].
double LargestTurn(const std::vector<State>& a, const std::vector<State>& b);

/// Root mean square over all nodes of the distance of the solution from
/// `states` in its own standard deviations: sqrt(d' P^-1 d / 3) of position,
/// velocity and attitude, the largest of the three. Of a solution that is
/// linearised closely enough it is a fraction of one.
double DistanceInSigmas(const ErrorLayout& layout,
                        const std::vector<State>& solution,
                        const CovarianceSeries& P,
                        const std::vector<State>& states);

/// Why the sigmas of a method that linearises about the forward filter's
/// trajectory are not to be believed, in words; empty if they are. A smoother
/// more than three sigmas from a new linearisation about it was linearised too
/// far off. The filter is judged only where its smoother is: its distance also
/// grows where noise is larger than stated.
std::string LinearisedTooFarOff(Method method, const Solution& solution,
                                const std::optional<Relinearised>& anew);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_LINEARISATION_H_
