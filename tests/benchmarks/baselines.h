#ifndef HINDSIGHT_TESTS_BENCHMARKS_BASELINES_H_
#define HINDSIGHT_TESTS_BENCHMARKS_BASELINES_H_

#include <cstddef>
#include <vector>

#include "state/covariance_series.h"
#include "timeline/problem.h"

namespace hindsight {

/// \file
/// What the same whole-interval problem costs elsewhere: solvers that stop at
/// the same size of step as SolveBatch (problems/batch.h), of the same factors.
/// They know only layouts of position, velocity, attitude and biases that walk,
/// and no losses.

struct BaselineResult {
  std::vector<State> states;
  CovarianceSeries P;  ///< marginals in the tangent at the states
  int iterations = 0;
};

/// Ceres as its manual has it: one ceres::Problem, SPARSE_NORMAL_CHOLESKY with
/// its default ordering, one thread. Marginals by ceres::Covariance, whose time
/// grows with the square of the nodes, if `with_covariances`; else P is empty.
BaselineResult SolveByCeres(const std::vector<State>& initial,
                            bool with_covariances, Problem* problem);

/// Gauss-Newton on normal equations in blocks of 15 x 15, whose size the
/// compiler knows: Cholesky down the chain and back, marginals on the way back.
/// No borders, no losses, no rank decision, half of the digits.
BaselineResult SolveBlockTridiagonal(const std::vector<State>& initial,
                                     Problem* problem);

}  // namespace hindsight

#endif  // HINDSIGHT_TESTS_BENCHMARKS_BASELINES_H_
