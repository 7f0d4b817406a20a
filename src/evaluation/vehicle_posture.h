#ifndef HINDSIGHT_EVALUATION_VEHICLE_POSTURE_H_
#define HINDSIGHT_EVALUATION_VEHICLE_POSTURE_H_

#include <vector>

#include "evaluation/grade.h"

namespace hindsight {

/// Doubtful: a vehicle on its wheels (SensorKind::of_vehicle) that drives on its
/// roof, its down axis above the horizon at more than half of the epochs, or
/// backwards on nine tenths of its way and for kLeastWay. No measurement
/// contradicts either where the IMU's axes are given and the wheels are asked for
/// no sign: then the axes are wrong, and with them the attitude.
void FindOddPosture(const Judged& judged, std::vector<Evidence>* evidence);

/// Farther than vehicles reverse [m].
inline constexpr double kLeastWay = 100.0;

}  // namespace hindsight

#endif  // HINDSIGHT_EVALUATION_VEHICLE_POSTURE_H_
