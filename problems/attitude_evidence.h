#ifndef HINDSIGHT_PROBLEMS_ATTITUDE_EVIDENCE_H_
#define HINDSIGHT_PROBLEMS_ATTITUDE_EVIDENCE_H_

#include <vector>

#include "attitude/attitude_run.h"
#include "evaluation/grade.h"
#include "evaluation/innovation_test.h"
#include "measurements/sensor.h"
#include "state/solution.h"

namespace hindsight {

/// What the innovations of attitude alone are of, by AttitudeInnovation::Source.
std::vector<Sensor> JudgedSources();

/// Those of a run, in order of time; their index is the time since the first
/// [us].
std::vector<NormalisedInnovation> InnovationsOf(const AttitudeRun& run);

/// What a solution started from: x with P, whose first components are those of
/// the layout. A heading that is zero by definition counts as not known.
StartValues StartOf(const ErrorLayout& layout, const AttitudeState::Matrix& P,
                    const State& x, const InitialState& given);

/// Of the less certain of roll and pitch, the median over the solution [rad].
double UsualTiltSigma(const Solution& solution);

/// Of the norms of the specific force [m/s^2].
double MedianForce(const ImuStream& imu);

/// So many times gravity, or as many times less, are another unit.
inline constexpr double kOtherUnit = 2.0;
bool IsOtherUnit(double ratio);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_ATTITUDE_EVIDENCE_H_
