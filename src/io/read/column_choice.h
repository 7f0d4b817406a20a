#ifndef HINDSIGHT_IO_READ_COLUMN_CHOICE_H_
#define HINDSIGHT_IO_READ_COLUMN_CHOICE_H_

#include <string>
#include <vector>

#include "io/read/column_meaning.h"
#include "io/read/file_columns.h"

namespace hindsight {

/// Whether a column of heights counts from the sea: its title says so, or a
/// column of the geoid's height stands beside one that says nothing.
bool CountsFromSea(const FileColumns& file, int h);

/// Which half of an IMU a file's name says that it holds: "gyro_", "accel_"; "" if
/// it says neither or both.
std::string HalfOfName(const std::string& name);

/// What all columns of a file mean (MeaningOfColumn). No quantity stands twice:
/// of two the first, of times the one that changes most often, of places and
/// heights the receiver's.
std::vector<ColumnMeaning> ReadMeanings(const FileColumns& file);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_COLUMN_CHOICE_H_
