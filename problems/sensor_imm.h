#ifndef HINDSIGHT_PROBLEMS_SENSOR_IMM_H_
#define HINDSIGHT_PROBLEMS_SENSOR_IMM_H_

#include <vector>

#include "alignment/start.h"
#include "filters/imm_smoother.h"
#include "state/solution.h"

namespace hindsight {

/// The multiple-model filter for any recording: model "good" believes the noise
/// of the sensors as stated, model "poor" multiplies the standard deviations of
/// the position sensors (without any, of all sensors) by the paper's ratio of
/// 20, or to its 20 m where that is more, whether they are white or coloured
/// states. From fix to fix the mode stays
/// with probability 0.9 (Baek 2019, eq. (14)).
struct SensorImm {
  std::vector<ImmModel> models;
  ImmOptions options;  ///< with feedback
};
inline constexpr double kPoorFactor = 20.0;
inline constexpr double kPoorSigma = 20.0;  ///< an axis [m]

/// `decisions` of gates hold for all sensors but those whose trust is in
/// question.
SensorImm MakeSensorImm(const Start& start, const Timeline& timeline,
                        const GateDecisions& decisions);

/// Solutions of the filter and of the smoother, the modes' probabilities with
/// them. The weight of a measurement is the mean of 1/factor^2 over the modes.
Solution ImmFilterSolution(const SensorImm& imm, const ImmResult& result);
Solution ImmSmootherSolution(const SensorImm& imm, const Timeline& timeline,
                             ImmSmoothed smoothed);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_SENSOR_IMM_H_
