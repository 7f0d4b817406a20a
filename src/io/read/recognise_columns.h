#ifndef HINDSIGHT_IO_READ_RECOGNISE_COLUMNS_H_
#define HINDSIGHT_IO_READ_RECOGNISE_COLUMNS_H_

#include <optional>
#include <string>
#include <vector>

#include "io/read/file_columns.h"
#include "io/read/found_stream.h"

namespace hindsight {

/// What is known of a recording when the streams beside its IMU are looked at.
struct RecogniseHints {
  std::optional<double> imu_span = {};  ///< [s]
  /// Of the IMU, where its rows are counted and not stamped [Hz].
  std::optional<double> count_rate = {};
};

/// The streams that columns of numbers hold: an IMU (GuessImu), positions, speed
/// and course (GuessFixes), velocities, a DVL, an odometer, a magnetometer, a flag
/// of standing, attitudes; all of it a truth where the file's name says so. Each
/// with the lines that a configuration needs to read it, and with why.
std::vector<FoundStream> RecogniseColumns(const FileColumns& file,
                                          const std::string& name,
                                          const RecogniseHints& hints);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_RECOGNISE_COLUMNS_H_
