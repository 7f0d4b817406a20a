#ifndef HINDSIGHT_PROBLEMS_SENSOR_IMM_H_
#define HINDSIGHT_PROBLEMS_SENSOR_IMM_H_

#include <functional>
#include <string>
#include <vector>

#include "alignment/start.h"
#include "filters/imm_smoother.h"
#include "state/solution.h"

namespace hindsight {

/// The multiple-model filter for any recording: model "good" believes the noise
/// of the sensors as stated, model "poor" multiplies the standard deviations of
/// the position sensors (without any, of all sensors) by the paper's ratio of
/// 20, or to its 20 m where that is more, whether they are white or coloured
/// states. From fix to fix the mode stays with probability 0.9 (Baek 2019, eq.
/// (14)). The modes take the place of the loss and the gate of those sensors;
/// the other sensors keep theirs.
struct SensorImm {
  std::vector<ImmModel> models;
  ImmOptions options;  ///< with feedback
  /// Of the first model, with the sensors as the models take them, and with the
  /// decisions on the tapes that were last smoothed.
  Problem problem;
  /// In words, whose loss or gate the modes replace; "" if none has any.
  std::string replaced;
};
inline constexpr double kPoorFactor = 20.0;
inline constexpr double kPoorSigma = 20.0;  ///< an axis [m]

SensorImm MakeSensorImm(Problem problem);

/// The smoothed filter. Where gates are left, they are decided again about the
/// smoothed trajectory, and the filter is run once more by `imm->options` with
/// these decisions if they differ; what its decisions leave out stays out. `judge` is shown the tape that is smoothed in
/// the end.
ImmSmoothed SmoothSensorImm(
    SensorImm* imm, const EpochCallback& callback,
    const std::function<void(const ImmTape&)>& judge = nullptr);

/// Solutions of the filter and of the smoother, the modes' probabilities with
/// them. The weight of a measurement is that of its loss times the mean of
/// 1/factor^2 over the modes.
Solution ImmFilterSolution(const SensorImm& imm, const ImmResult& result);
Solution ImmSmootherSolution(const SensorImm& imm, ImmSmoothed smoothed);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_SENSOR_IMM_H_
