#ifndef HINDSIGHT_PROBLEMS_ATTITUDE_BATCH_H_
#define HINDSIGHT_PROBLEMS_ATTITUDE_BATCH_H_

#include <functional>
#include <span>
#include <vector>

#include "dataset/dataset.h"
#include "filters/attitude_filter.h"
#include "problems/field_survey.h"
#include "state/solution.h"

namespace hindsight {

/// What the batch of attitude.h is posed from.
struct RoomProblem {
  const Dataset& dataset;                   ///< sensors, noise, settings
  const ImuStream& imu;                     ///< rates of the interval
  std::span<const SurveyedField> readings;  ///< about node_spacing apart
  const FieldSurvey& survey;
  const Solution& smoothed;  ///< an entry an IMU sample
  AttitudePlace place;
};

/// Longest interval between nodes of the batch and between the magnetometer
/// readings it uses [s].
inline constexpr double kRoomNodeSpacing = 0.1;

/// Magnetic disturbance as a Gauss-Markov state [uT], [s].
inline constexpr double kDisturbanceSigma = 2.0;
inline constexpr double kDisturbanceTime = 5.0;

/// Times of the nodes: those of the readings, and what they leave of the
/// interval filled evenly.
std::vector<double> RoomNodeTimes(const RoomProblem& problem);

/// The navigation problem of a body that stays in a room, in Ceres; a state an
/// IMU sample, layout {attitude, gyro bias}.
Solution SolveRoomBatch(const RoomProblem& problem,
                        const std::function<void(double)>& progress);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_ATTITUDE_BATCH_H_
