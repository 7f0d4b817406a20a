#ifndef HINDSIGHT_IO_RECOGNISE_FORMAT_H_
#define HINDSIGHT_IO_RECOGNISE_FORMAT_H_

#include <optional>
#include <set>
#include <string>

namespace hindsight {

/// What a file of a recording can serve as.
enum class Role { kImu, kPosition, kVelocity, kHeight, kSpeedCourse, kTruth };

/// A file or folder whose format was recognised.
struct Found {
  std::string file;
  std::string format;
  std::set<Role> roles;
  std::string keys = {};  ///< further lines of its configuration
};

/// Tells the format of a file by its content, that of a bag or an OXTS folder
/// by its name. Nothing if it is none that is known.
std::optional<Found> RecogniseFormat(const std::string& path);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_RECOGNISE_FORMAT_H_
