#ifndef HINDSIGHT_EVALUATION_CURVED_ERRORS_H_
#define HINDSIGHT_EVALUATION_CURVED_ERRORS_H_

#include <vector>

#include "evaluation/grade.h"

namespace hindsight {

/// Doubtful: a heading so uncertain that horizontal positions or velocities lie
/// along an arc, which no covariance describes. With psi the heading's error, of
/// standard deviation s, the part of a position's error that goes with it is
///   r psi + n psi^2 / 2,   r = cov(p, psi) / s^2,
/// n as long as r and across it: what is turned about a point |r| away. A
/// covariance has the first term. Across r, where it has a standard deviation of
/// sigma_n, errors are
///   e = sqrt(1 + 3 (|r| s^2 / 2)^2 / sigma_n^2)
/// of it in the root mean square, as E psi^4 = 3 s^4. A smoother is doubtful
/// where e reaches kDoubtfulError at any epoch, a filter where it does in the
/// root mean square over the interval.
void FindCurvedErrors(const Judged& judged, std::vector<Evidence>* evidence);

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_CURVED_ERRORS_H_
