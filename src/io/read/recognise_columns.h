#ifndef HINDSIGHT_IO_READ_RECOGNISE_COLUMNS_H_
#define HINDSIGHT_IO_READ_RECOGNISE_COLUMNS_H_

#include <string>
#include <vector>

#include "io/read/file_columns.h"
#include "io/read/recognise_format.h"

namespace hindsight {

/// The streams that columns of numbers hold: an IMU (GuessImu), positions, speed
/// and course (GuessFixes), velocities, a DVL, an odometer, a magnetometer, a flag
/// of standing, attitudes; all of it a truth where the file's name says so. Each
/// with the lines that a configuration needs to read it, and with why.
std::vector<Found> RecogniseColumns(const FileColumns& file,
                                    const std::string& name,
                                    const RecogniseHints& hints);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_RECOGNISE_COLUMNS_H_
