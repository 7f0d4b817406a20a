#ifndef HINDSIGHT_PROBLEMS_SOLUTION_BUILDER_H_
#define HINDSIGHT_PROBLEMS_SOLUTION_BUILDER_H_

#include <vector>

#include "filters/iterated_smoother.h"
#include "filters/linear_tape.h"
#include "state/solution.h"
#include "timeline/problem.h"

namespace hindsight {

/// The forward filter's solution: states and covariances after each update,
/// innovations as residuals.
Solution FilterSolution(const LinearTape& tape);

/// A whole-interval solution from states and marginal covariances (in the
/// tangent at the states). Residuals are taken about the states; the covariance
/// of one is R - H P H' if the measurement took part and R + H P H' if not, so
/// that the normalised residual of a right model is near one either way.
Solution SmoothedSolution(const Problem& problem, std::vector<State> states,
                          CovarianceSeries P);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_SOLUTION_BUILDER_H_
