#ifndef HINDSIGHT_ALIGNMENT_GYRO_DRIFT_H_
#define HINDSIGHT_ALIGNMENT_GYRO_DRIFT_H_

#include <optional>

#include "alignment/start.h"
#include "imu/imu_stream.h"
#include "imu/worst_drop_out.h"
#include "state/evidence.h"

namespace hindsight {

/// Rule `gyro_drift`: doubtful if the gyro biases drifted faster while the
/// attitude was sought (StartReport::gyro_bias_walk) than the stated noise lets
/// the estimation follow, whose walk is less than half of it even if the true
/// one is as far below as the walks that were tried are apart, half of a factor
/// sqrt(10) each way: less than 1/3.6. Value and limit are drifts in a minute,
///   walk sqrt(60 s), [deg/s].
/// A drop-out of the IMU that loses the attitude (LostAttitude) looks like
/// such a drift, and is named.
std::optional<Evidence> FindGyroDrift(
    const StartReport& start, const ImuNoise& stated,
    const std::optional<BridgedDropOut>& drop_out = std::nullopt);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_GYRO_DRIFT_H_
