#ifndef HINDSIGHT_ALIGNMENT_ATTITUDE_START_H_
#define HINDSIGHT_ALIGNMENT_ATTITUDE_START_H_

#include <span>
#include <vector>

#include "attitude/attitude_filter.h"
#include "dataset/dataset.h"

namespace hindsight {

/// Scale factor of a calibrated MEMS gyro, where the data set says nothing: 0.3
/// to 0.5 % over temperature by the data sheets of hand-held ones.
inline constexpr double kGyroScaleSigma = 0.004;

/// The data set's first magnetometer with readings; null without one.
const AidingStream* MagnetometerOf(const Dataset& dataset);

/// The filter's settings that a data set asks for. Its first magnetometer
/// stream is used; without one the heading is that of the start.
AttitudeFilterOptions FilterOptionsOf(const Dataset& dataset);

/// The readings of the data set's first magnetometer, its given hard iron
/// removed; none without one.
std::vector<MagneticSample> MagneticSamples(const Dataset& dataset);

/// The readings of all sensors of directions (`heading`) that are not withheld,
/// in order of time.
std::vector<HeadingSample> HeadingSamples(const Dataset& dataset);

/// Attitude at the first sample: levelled by the mean specific force of the
/// first half second and turned to the field's mean; 5 deg of tilt, 10 deg of
/// heading unless the data set gives them. Without readings the heading is
/// that of the configuration, or zero: exact, as headings then count from there,
/// or of any sigma if a sensor of directions is to tell it.
AttitudeState StartOfAttitude(const Dataset& dataset, const ImuStream& imu,
                              std::span<const MagneticSample> magnetic);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_ATTITUDE_START_H_
