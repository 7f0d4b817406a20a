#ifndef HINDSIGHT_PROBLEMS_VERDICT_H_
#define HINDSIGHT_PROBLEMS_VERDICT_H_

#include <string>
#include <vector>

#include "measurements/sensor.h"
#include "state/solution.h"

namespace hindsight {

/// Values, sigmas and verdicts of the layout's constants, from the last epoch:
/// observed if sigma has fallen below a third of the a priori one, unobserved
/// if it is still above nine tenths, weak in between.
std::vector<ConstantEstimate> EstimateConstants(const Solution& solution);

/// Navigation components whose standard deviation stays so large over a span
/// that they say nothing: 1 km, 10 m/s, 5 deg of tilt, 20 deg of heading.
std::vector<UnobservedSpan> FindUnobserved(const Solution& solution);

/// Fills `constants`, `unobserved`, `usable` and `verdict`. Not usable: an
/// iteration that did not converge, states or covariances that are not finite,
/// a navigation state unobserved over half of the interval, a sensor whose
/// measurements were refused (problems/refusals.h), or one whose accepted
/// residuals are, in the root mean square, more than five times the sigma the
/// model gives them - then the model or its noise is wrong, and with them every
/// sigma of the solution. What `known` names as unobserved is so for every
/// method, whatever its own covariances say; `objection`, if not empty, is a
/// reason that goes before these. The verdict of a usable solution names the
/// constants that are kept at their priors.
void Conclude(const std::vector<Sensor>& sensors,
              const std::vector<UnobservedSpan>& known,
              const std::string& objection, Solution* solution);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_VERDICT_H_
