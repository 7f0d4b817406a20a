#ifndef HINDSIGHT_PROBLEMS_LINEARISATION_H_
#define HINDSIGHT_PROBLEMS_LINEARISATION_H_

#include <optional>
#include <vector>

#include "evaluation/grade.h"
#include "problems/method.h"
#include "state/covariance_series.h"
#include "state/solution.h"

namespace hindsight {

/// The whole interval, linearised anew about a smoothed trajectory.
struct Relinearised {
  /// Empty if no new linearisation held.
  std::vector<State> states;
  CovarianceSeries P;
  /// Of the smoothed trajectory to `states`.
  LinearisationMove smoother;
};

/// The largest distance of `states` from `from`, component by component of
/// position, velocity and attitude, in standard deviations of P.
LinearisationMove LargestMove(const ErrorLayout& layout,
                              const std::vector<State>& from,
                              const CovarianceSeries& P,
                              const std::vector<State>& states);

/// How far the solution of a method that linearises about the forward filter's
/// trajectory is from a new linearisation; nothing for other methods. The
/// filter is judged only where its smoother is beyond kDoubtfulBias: its
/// distance also grows where noise is larger than stated.
std::optional<LinearisationMove> MoveOf(Method method, const Solution& solution,
                                        const Relinearised& anew);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_LINEARISATION_H_
