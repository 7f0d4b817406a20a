#ifndef HINDSIGHT_IO_READ_IMU_PAIR_GUESS_H_
#define HINDSIGHT_IO_READ_IMU_PAIR_GUESS_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/read/found_stream.h"

namespace hindsight {

/// An IMU of which gyros and accelerometers have a file, or rows, each.
struct ImuPair {
  FoundStream imu;            ///< of the gyros' file, with the other's lines
  std::string accelerometer;  ///< name of the other file
};

/// The pair that was found, or why two files that look like one are none, a clause
/// of a sentence; empty if there are no such files.
struct ImuPairSearch {
  std::optional<ImuPair> pair;
  std::string apart;
};

/// The first two delimited texts of `names` in `folder`, or two kinds of rows of one
/// (ReadTypedColumns), of which one holds three
/// gyros and the other three accelerometers that feel gravity, on one clock and
/// overlapping by half of the shorter: by titles, or by the name of the file or of its rows where the
/// titles are x, y and z alone. Told and scaled as GuessImu does, of the
/// accelerometers interpolated at the gyros' stamps.
ImuPairSearch FindImuPair(const std::filesystem::path& folder,
                          const std::vector<std::string>& names);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_IMU_PAIR_GUESS_H_
