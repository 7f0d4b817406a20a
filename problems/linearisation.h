#ifndef HINDSIGHT_PROBLEMS_LINEARISATION_H_
#define HINDSIGHT_PROBLEMS_LINEARISATION_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "evaluation/grade.h"
#include "filters/forward_filter.h"
#include "filters/rts.h"
#include "state/covariance_series.h"
#include "state/solution.h"
#include "timeline/problem.h"

namespace hindsight {

/// Variances of position, velocity and attitude.
using NavigationVariances = Eigen::Matrix<double, 9, 1>;

/// The whole interval, linearised anew about a smoothed trajectory.
struct Relinearised {
  std::vector<State> states;  ///< empty if no new linearisation held
  std::vector<NavigationVariances> variances;
  LinearisationError smoother;  ///< of the smoothed trajectory
  /// One pass led there, and moved it by a negligible step.
  bool is_near = false;
  /// That, or the last of several passes moved it by less than the first.
  bool contracted = false;
};

/// The navigation part of the diagonals of P.
std::vector<NavigationVariances> VariancesOf(const ErrorLayout& layout,
                                             const CovarianceSeries& P);

/// The largest distance of two trajectories in a component of position,
/// velocity or attitude, in standard deviations.
double LargestDistance(const ErrorLayout& layout,
                       const std::vector<State>& from,
                       const std::vector<State>& to,
                       const std::vector<NavigationVariances>& variances);

/// A trajectory that linearising anew and smoothing led to.
struct Rested {
  SmoothedTrajectory trajectory;
  double step = 0.0;   ///< the last, LargestDistance [sigma]
  double first = 0.0;  ///< the first
  int passes = 0;
  LinearTape tape;  ///< of the last pass, about what its step began at

  bool is_settled() const { return step < kNegligibleStep; }
  static constexpr double kNegligibleStep = 0.1;  ///< [sigma]
};

/// Linearises the interval about a trajectory and smooths, again about the
/// result, up to four times until the step is a tenth of a sigma. Throws
/// EstimationError where it does not hold.
Rested SmoothUntilItRests(const std::vector<State>& states, Problem* problem,
                          const EpochCallback& callback);

/// How a trajectory with covariances P compares with a new linearisation.
LinearisationError Compare(const ErrorLayout& layout,
                           const std::vector<State>& states,
                           const CovarianceSeries& P, const Relinearised& anew);

/// Compare of a solution that is linearised about the forward filter's
/// trajectory; nothing for a forward method if its smoother is usable.
std::optional<LinearisationError> LinearisationErrorOf(
    const Solution& solution, const Relinearised& anew);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_LINEARISATION_H_
