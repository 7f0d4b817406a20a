#ifndef HINDSIGHT_IO_READ_RECOGNISE_FORMAT_H_
#define HINDSIGHT_IO_READ_RECOGNISE_FORMAT_H_

#include <optional>
#include <string>
#include <vector>

#include "measurements/sensor_kind.h"

namespace hindsight {

/// A file or folder whose format was recognised.
struct Found {
  std::string file;
  std::string format;
  bool imu = false;    ///< holds one
  bool truth = false;  ///< is or holds one, by its name or its format
  bool pose = false;   ///< holds attitudes, and does not say that they are true
  bool sigmas = true;  ///< states those of `kinds`, where the format can
  /// What it can serve as besides, in the order of SensorKinds.
  std::vector<const SensorKind*> kinds = {};
  std::string keys = {};  ///< further lines of its configuration
};

/// Tells the format of a file by its content, that of a bag or an OXTS folder
/// by its name. An own CSV is a truth only by its name. Nothing if it is none
/// that is known.
std::optional<Found> RecogniseFormat(const std::string& path);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_RECOGNISE_FORMAT_H_
