#ifndef HINDSIGHT_IO_FIELDS_H_
#define HINDSIGHT_IO_FIELDS_H_

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "io/units.h"

namespace hindsight {

/// A quantity that a stream may hold, by its name in files and configurations.
struct FieldName {
  const char* name;
  Quantity quantity;
};

/// Quantities of each kind of stream. sd_ne, sd_ed, sd_dn (and sd_v_ne, ...)
/// are covariances as signed square roots: sd_ne |sd_ne| = cov(n, e).
const std::vector<FieldName>& ImuFields();
const std::vector<FieldName>& PositionFields();
const std::vector<FieldName>& VelocityFields();
const std::vector<FieldName>& HeightFields();
/// Speed along the vehicle's x axis, and across it where a sensor measures it.
const std::vector<FieldName>& OdometerFields();
/// Depth below the water's surface.
const std::vector<FieldName>& DepthFields();
/// Velocity along a DVL's own axes, or along its beams with a flag each (0 is
/// lost); water is 1 for water track.
const std::vector<FieldName>& DvlFields();
/// Range, azimuth and depression of a transponder from the vehicle.
const std::vector<FieldName>& AcousticFields();
/// Speed and course over the ground.
const std::vector<FieldName>& SpeedCourseFields();
/// Magnetic field in sensor axes.
const std::vector<FieldName>& MagnetometerFields();
/// Whether the vehicle is said to stand: 1 or 0.
const std::vector<FieldName>& ZeroVelocityFields();
/// Geodetic position, NED velocity, Euler angles; then the same as vectors and
/// quaternion in a frame that the configuration names.
const std::vector<FieldName>& TruthFields();

/// Where `name` stands in the list.
std::optional<std::size_t> FieldIndex(const std::vector<FieldName>& fields,
                                      std::string_view name);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_FIELDS_H_
