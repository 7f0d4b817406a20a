#ifndef HINDSIGHT_IO_READ_FIELDS_H_
#define HINDSIGHT_IO_READ_FIELDS_H_

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "io/read/units.h"

namespace hindsight {

/// Quantities of an IMU's file; those of aiding are its kind's
/// (SensorKind::columns).
const std::vector<FieldName>& ImuFields();
/// Geodetic position, NED velocity, Euler angles; then the same as vectors and
/// quaternion in a frame that the configuration names.
const std::vector<FieldName>& TruthFields();

/// Where `name` stands in the list.
std::optional<std::size_t> FieldIndex(const std::vector<FieldName>& fields,
                                      std::string_view name);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_FIELDS_H_
