#ifndef HINDSIGHT_PROBLEMS_SOLUTION_BUILDER_H_
#define HINDSIGHT_PROBLEMS_SOLUTION_BUILDER_H_

#include <vector>

#include "filters/iterated_smoother.h"
#include "filters/linear_tape.h"
#include "measurements/timeline.h"
#include "state/solution.h"

namespace hindsight {

/// The forward filter's solution: states and covariances after each update,
/// innovations as residuals.
Solution FilterSolution(const LinearTape& tape);

/// A whole-interval solution from states and marginal covariances (in the
/// tangent at the states). Residuals are taken about the states; the covariance
/// of one is R - H P H' if the measurement took part and R + H P H' if not, so
/// that the normalised residual of a right model is near one either way.
Solution SmoothedSolution(const ErrorLayout& layout, const Timeline& timeline,
                          std::vector<State> states, CovarianceSeries P,
                          const GateDecisions& decisions);

/// Values, sigmas and verdicts of the layout's constants, from the last epoch:
/// observed if sigma has fallen below a third of the a priori one, unobserved
/// if it is still above nine tenths, weak in between.
std::vector<ConstantEstimate> EstimateConstants(const Solution& solution);

/// Navigation components whose standard deviation stays so large over a span
/// that they say nothing: 1 km, 10 m/s, 5 deg of tilt, 20 deg of heading.
std::vector<UnobservedSpan> FindUnobserved(const Solution& solution);

/// Fills `constants`, `unobserved`, `usable` and `verdict`. Not usable: an
/// iteration that did not converge, a navigation state unobserved over half of
/// the interval, or a sensor whose accepted residuals are, in the root mean
/// square, more than five times the sigma the model gives them - then the model
/// or its noise is wrong, and with them every sigma of the solution.
/// What `known` names as unobserved is so for every method, whatever its own
/// covariances say.
void Conclude(const std::vector<Sensor>& sensors,
              const std::vector<UnobservedSpan>& known, Solution* solution);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_SOLUTION_BUILDER_H_
