#ifndef HINDSIGHT_IO_READ_IMU_COLUMNS_H_
#define HINDSIGHT_IO_READ_IMU_COLUMNS_H_

#include <optional>

#include "io/read/file_columns.h"
#include "io/read/imu_guess.h"
#include "io/read/stamp_guess.h"

namespace hindsight {

/// Stamps of an IMU whose rows are counted: the usual rate that is nearest to the
/// one that gravity tells; 100 Hz, as a guess, where it tells none.
StampGuess CountedImu(const ImuGuess& guess);

/// Of an IMU on a wheel the axis about which it spins, 0 to 2: it turns faster
/// than 100 deg/s for a fifth of the record, nine tenths of it about one axis.
std::optional<int> SpinAxis(const FileColumns& file, const ImuGuess& guess);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_IMU_COLUMNS_H_
