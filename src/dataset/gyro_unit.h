#ifndef HINDSIGHT_DATASET_GYRO_UNIT_H_
#define HINDSIGHT_DATASET_GYRO_UNIT_H_

#include <optional>
#include <string>

#include "dataset/dataset.h"

namespace hindsight {

/// How far a vehicle that is level on average turns by its course over the ground for
/// each radian by its gyros, root mean square over spans of some seconds; negative
/// where they turn the other way. Nothing where it does not turn, or not alike.
std::optional<double> CourseOverGyros(const Dataset& dataset);

/// Whether a ratio is another within a quarter of it; both are positive.
bool IsNearRatio(double ratio, double expected);

/// Gyros in deg/s that are declared as rad/s, or the other way round, turn
/// gravity by 57 times what they should between quiet spells (GravityBalance), or
/// a vehicle that is level on average against its course over the ground; gyros of
/// the other sign turn it the other way. What looks wrong, and the keys to correct; ""
/// where nothing does or the motion does not show it. By gravity of rates alone.
std::string WarnAboutGyroUnit(const Dataset& dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_GYRO_UNIT_H_
