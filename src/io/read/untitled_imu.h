#ifndef HINDSIGHT_IO_READ_UNTITLED_IMU_H_
#define HINDSIGHT_IO_READ_UNTITLED_IMU_H_

#include <optional>
#include <vector>

#include "io/read/column_meaning.h"
#include "io/read/file_columns.h"
#include "io/read/triple_readings.h"

namespace hindsight {

/// An IMU in columns that no title names.
struct UntitledImu {
  ColumnTriple accel = {-1, -1, -1};
  ColumnTriple gyro = {-1, -1, -1};
  GravityTurn turn;
  /// A vector that keeps its length and turns as the gyros say: a magnetometer's.
  std::optional<ColumnTriple> field;
};

/// Of three neighbouring columns each those that go together best. Accelerometers
/// have gravity's length where they are quiet, and gyros turn it, or read next to
/// nothing where it stands still; the axes of either are about as noisy; and what is
/// left holds a field that turns with them, if the file has one. So a vertical
/// accelerometer beside two axes of a magnetometer in gauss, whose length is
/// gravity's as well, is none: its axes are unlike, and it breaks the field.
/// Nothing if none do.
std::optional<UntitledImu> FindUntitledImu(
    const FileColumns& file, const std::vector<ColumnMeaning>& meanings,
    int stamp_column);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_UNTITLED_IMU_H_
