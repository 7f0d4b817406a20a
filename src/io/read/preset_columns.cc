#include "io/read/preset_columns.h"

#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

using Preset = std::vector<ColumnMapping>;

/// Column number from 1, quantity, unit.
ColumnMapping Column(int number, const char* quantity, const char* unit) {
  ColumnMapping mapping;
  mapping.quantity = quantity;
  mapping.column = number - 1;
  mapping.unit = unit;
  return mapping;
}

void AppendVector(int number, const std::string& stem, const char* unit,
                  Preset* columns) {
  for (const char* axis : {"_x", "_y", "_z"}) {
    columns->push_back(Column(number++, (stem + axis).c_str(), unit));
  }
}

Preset KfGinsColumns(const std::vector<FieldName>& fields) {
  Preset columns = {Column(1, "t", "s")};
  if (&fields == &ImuFields()) {
    AppendVector(2, "dtheta", "rad", &columns);
    AppendVector(5, "dvel", "m/s", &columns);
  } else if (&fields == &OdometerKind().columns) {
    columns.push_back(Column(8, "speed", "m/s"));
  } else if (&fields == &TruthFields()) {
    // The week stands first; the other files of a set do not have it.
    columns = {Column(2, "t", "s"),        Column(3, "lat", "deg"),
               Column(4, "lon", "deg"),    Column(5, "h", "m"),
               Column(6, "v_n", "m/s"),    Column(7, "v_e", "m/s"),
               Column(8, "v_d", "m/s"),    Column(9, "roll", "deg"),
               Column(10, "pitch", "deg"), Column(11, "heading", "deg")};
  } else if (&fields == &PositionKind().columns ||
             &fields == &HeightKind().columns) {
    for (const ColumnMapping& column :
         {Column(2, "lat", "deg"), Column(3, "lon", "deg"), Column(4, "h", "m"),
          Column(5, "sigma_n", "m"), Column(6, "sigma_e", "m"),
          Column(7, "sigma_d", "m"), Column(7, "sigma_h", "m")}) {
      columns.push_back(column);
    }
  } else {
    return {};
  }
  return columns;
}

Preset EurocColumns(const std::vector<FieldName>& fields) {
  Preset columns = {Column(1, "t", "ns")};
  if (&fields == &ImuFields()) {
    AppendVector(2, "gyro", "rad/s", &columns);
    AppendVector(5, "accel", "m/s^2", &columns);
  } else if (&fields == &TruthFields()) {
    AppendVector(2, "p", "m", &columns);
    columns.push_back(Column(5, "q_w", "1"));
    AppendVector(6, "q", "1", &columns);
    AppendVector(9, "v", "m/s", &columns);
  } else {
    return {};
  }
  return columns;
}

Preset NcltColumns(const std::vector<FieldName>& fields) {
  Preset columns = {Column(1, "t", "us")};
  if (&fields == &ImuFields()) {
    AppendVector(5, "accel", "m/s^2", &columns);
    AppendVector(8, "gyro", "rad/s", &columns);
    return columns;
  }
  columns.push_back(Column(2, "quality", "1"));
  if (&fields == &PositionKind().columns || &fields == &HeightKind().columns) {
    columns.push_back(Column(3, "satellites", "1"));
    columns.push_back(Column(4, "lat", "rad"));
    columns.push_back(Column(5, "lon", "rad"));
    columns.push_back(Column(6, "h", "m"));
  } else if (&fields == &SpeedCourseKind().columns) {
    columns.push_back(Column(7, "course", "rad"));
    columns.push_back(Column(8, "speed", "m/s"));
  } else {
    return {};
  }
  return columns;
}

Preset ControlPointColumns(const std::vector<FieldName>& fields) {
  if (&fields != &PositionKind().columns && &fields != &HeightKind().columns)
    return {};
  return {Column(1, "t", "s"),       Column(2, "lat", "deg"),
          Column(3, "lon", "deg"),   Column(4, "h", "m"),
          Column(5, "sigma_n", "m"), Column(5, "sigma_e", "m"),
          Column(5, "sigma_d", "m"), Column(5, "sigma_h", "m")};
}

}  // namespace

std::vector<ColumnMapping> PresetColumns(TextFormat::Kind kind,
                                         const std::vector<FieldName>& fields) {
  switch (kind) {
    case TextFormat::Kind::kKfGins:
      return KfGinsColumns(fields);
    case TextFormat::Kind::kEuroc:
      return EurocColumns(fields);
    case TextFormat::Kind::kNclt:
      return NcltColumns(fields);
    case TextFormat::Kind::kControlPoints:
      return ControlPointColumns(fields);
    default:
      return {};
  }
}

}  // namespace hindsight
