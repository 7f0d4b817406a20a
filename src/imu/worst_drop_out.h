#ifndef HINDSIGHT_IMU_WORST_DROP_OUT_H_
#define HINDSIGHT_IMU_WORST_DROP_OUT_H_

#include <optional>
#include <string>

#include "imu/imu_stream.h"

namespace hindsight {

/// A drop-out and what its bridge (BridgeNoise) leaves open.
struct BridgedDropOut {
  double t = 0.0;               ///< at which it begins [s]
  double length = 0.0;          ///< [s]
  double attitude_sigma = 0.0;  ///< of each axis, gained over it [rad]
};

/// The one in [from, to] over which most of the attitude is lost; none if there
/// are none.
std::optional<BridgedDropOut> WorstDropOut(const ImuStream& stream, double from,
                                           double to);

/// "the IMU's drop-out of 5 s at 15.0 s, in which the attitude is lost to 29
/// deg", where the attitude is lost to more than 20 deg: a filter linearised
/// about what it takes for the attitude then says little. Nothing of others.
std::optional<std::string> LostAttitude(
    const std::optional<BridgedDropOut>& drop_out);

}  // namespace hindsight

#endif  // HINDSIGHT_IMU_WORST_DROP_OUT_H_
