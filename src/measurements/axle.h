#ifndef HINDSIGHT_MEASUREMENTS_AXLE_H_
#define HINDSIGHT_MEASUREMENTS_AXLE_H_

#include "measurements/sensor_kind.h"

namespace hindsight {

/// \file
/// What the kinds of sensor on an axle, measurements of Odometer, have in common.

/// speed, side, down, quality, distance: columns of a file.
const std::vector<FieldName>& AxleColumns();

/// level_on_average: SensorSettings::level_sigma.
SensorKey AxleLevelKey();

/// Where `sigma` of such a sensor is missing.
inline constexpr char kAxleSigmaMissing[] =
    "expected a standard deviation of each speed";

/// SensorKind::complete and ::uncomplete: the pattern has the settings' sigma.
std::optional<KeyObjection> TakeAxleSigma(SensorSettings* settings);
void GiveAxleSigma(SensorSettings* settings);

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_AXLE_H_
