#ifndef HINDSIGHT_ALIGNMENT_START_COVARIANCE_H_
#define HINDSIGHT_ALIGNMENT_START_COVARIANCE_H_

#include "alignment/alignment.h"
#include "dataset/dataset.h"
#include "state/error_layout.h"

namespace hindsight {

/// A priori covariance (InitialCovariance) with that of the attitude, its sigmas
/// times `factor`, each not beyond that of an angle of which nothing is known.
ErrorMatrix StartCovariance(const Dataset& dataset, const ErrorLayout& layout,
                            const AlignedAttitude& attitude, double factor);

/// That of an estimation, which levels by the same readings again.
///
/// Levelling knows tilt and accelerometer bias together, in body axes. In NED,
/// where the prior says so, a heading that is off by psi turns the tilt against
/// the bias by psi/2: where that is more than levelling leaves open, the prior
/// would say that the bias is small or the heading right, and knows neither.
ErrorMatrix PriorCovariance(const Dataset& dataset, const ErrorLayout& layout,
                            const AlignedAttitude& attitude);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_START_COVARIANCE_H_
