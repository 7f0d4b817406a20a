#ifndef HINDSIGHT_ALIGNMENT_ATTITUDE_START_H_
#define HINDSIGHT_ALIGNMENT_ATTITUDE_START_H_

#include <optional>
#include <span>
#include <vector>

#include "alignment/alignment.h"
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

/// The readings of all velocities over the Earth (`velocity`) that are not
/// withheld, in order of time.
std::vector<VelocitySample> VelocitySamples(const Dataset& dataset);

/// Whether something tells the heading, so that velocities over the Earth can
/// be used: a magnetometer, a sensor of directions, the configuration, or
/// velocities that have done so themselves (`found`).
bool HeadingIsTold(const Dataset& dataset, const AlignedAttitude* found);

/// The attitude at the first sample of `imu` by velocities up to `to`
/// (AlignByVelocity), if they tell the heading to 20 deg.
std::optional<AlignedAttitude> AttitudeByVelocity(const Dataset& dataset,
                                                  const ImuStream& imu,
                                                  double to);

/// Attitude at the first sample: levelled by the mean specific force of the
/// first half second and turned to the field's mean; 5 deg of tilt, 10 deg of
/// heading unless the data set gives them. Without readings the heading is
/// that of the configuration, or zero: exact, as headings then count from there,
/// or of any sigma if a sensor of directions is to tell it. `found` takes the
/// place of all that but what the configuration gives.
AttitudeState StartOfAttitude(const Dataset& dataset, const ImuStream& imu,
                              std::span<const MagneticSample> magnetic,
                              const AlignedAttitude* found = nullptr);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_ATTITUDE_START_H_
