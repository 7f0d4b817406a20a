#ifndef HINDSIGHT_DATASET_GYRO_UNIT_H_
#define HINDSIGHT_DATASET_GYRO_UNIT_H_

#include <string>

#include "dataset/dataset.h"

namespace hindsight {

/// Gyros in deg/s that are declared as rad/s, or the other way round, turn
/// gravity by 57 times what they should between quiet spells (GravityBalance), or
/// a vehicle that is level on average against its course over the ground; gyros of
/// the other sign turn it the other way. What looks wrong, and the keys to correct; "" where nothing does or the motion does
/// not show it. Of rates, not of increments.
std::string WarnAboutGyroUnit(const Dataset& dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_GYRO_UNIT_H_
