#ifndef HINDSIGHT_DATASET_GYRO_UNIT_H_
#define HINDSIGHT_DATASET_GYRO_UNIT_H_

#include <string>

#include "imu/imu_stream.h"

namespace hindsight {

/// Gyros in deg/s that are declared as rad/s, or the other way round, turn
/// gravity by 57 times what they should between quiet spells (GravityBalance):
/// what looks wrong, and the keys to correct; "" where nothing does or the motion
/// does not show it. Of rates, not of increments.
std::string WarnAboutGyroUnit(const ImuStream& stream);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_GYRO_UNIT_H_
