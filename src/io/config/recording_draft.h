#ifndef HINDSIGHT_IO_CONFIG_RECORDING_DRAFT_H_
#define HINDSIGHT_IO_CONFIG_RECORDING_DRAFT_H_

#include <optional>
#include <string>
#include <vector>

#include "io/read/found_stream.h"

namespace hindsight {

/// One aiding stream of a draft.
struct StreamDraft {
  std::string name;
  const SensorKind* kind = nullptr;
  FoundStream found;
};

/// The configuration of one recording before it is text.
struct RecordingDraft {
  std::string name;
  std::string folder;  ///< absolute
  std::optional<FoundStream> imu;
  std::vector<StreamDraft> aiding;
  std::optional<FoundStream> truth;
  std::vector<StreamDraft> unused;  ///< recognised, and why not used in remarks
  /// Files that were not recognised, with what they are where that shows; rows and
  /// columns of others that nothing uses.
  std::vector<std::string> unknown;
  std::vector<std::string> copies;  ///< as RecordingFiles::copies
  std::vector<KeyLine> top;         ///< further lines of the top level
  bool loads = true;  ///< false: 'run' would refuse it as it stands
  /// What was taken for granted and matters, one clause each.
  std::vector<std::string> assumptions;

  /// Adds an assumption that is not there yet.
  void Assume(const std::string& what);
  /// The aiding stream of that name; nullptr if there is none.
  StreamDraft* Find(const std::string& stream);
};

/// The recordings below `folder`, told by their IMUs. Files of a folder are of
/// one recording, with those of folders below it that hold no IMU; a folder
/// without an IMU belongs to the only recording below it, if it is the only one.
/// A folder of several is told apart by times or names (GroupRecordings).
/// A MATLAB file, a bag or an OXTS folder is a recording of its own. Of several
/// IMUs the one that does not spin, has stamps and comes fastest is taken; one
/// that spins is an odometer. Clocks that do not overlap begin together. Throws
/// InputError if the folder is missing, holds nothing, or holds no IMU: then the
/// message names what was found instead.
std::vector<RecordingDraft> DraftRecordings(const std::string& folder);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_RECORDING_DRAFT_H_
