#ifndef HINDSIGHT_MEASUREMENTS_HEADING_H_
#define HINDSIGHT_MEASUREMENTS_HEADING_H_

#include "measurements/generic_reading.h"

namespace hindsight {

/// Direction of a baseline b of the body, from one antenna to another:
///   u = C_nb b,   heading = atan2(u_e, u_n),   pitch = -asin(u_d/|u|),
/// residuals [rad], measured minus predicted, that of the heading within
/// (-pi, pi]. GenericReading::value is (heading, pitch), GenericReading::sigma
/// theirs; a sigma of the pitch of zero says that there is none.
/// Sensor::own_vector is b, in body axes; only its direction counts.
const GenericModel& BaselineDirection();

struct SensorKind;

/// The kind of sensor: two antennas or a gyrocompass.
const SensorKind& HeadingKind();

/// heading and pitch of b, as above [rad].
Eigen::Vector2d DirectionOf(const Eigen::Vector3d& u_n);

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_HEADING_H_
