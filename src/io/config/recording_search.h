#ifndef HINDSIGHT_IO_CONFIG_RECORDING_SEARCH_H_
#define HINDSIGHT_IO_CONFIG_RECORDING_SEARCH_H_

#include <filesystem>
#include <string>
#include <vector>

#include "io/read/found_stream.h"

namespace hindsight {

/// The streams of one recording, and the files that hold none. File names are
/// relative to its folder.
struct RecordingFiles {
  std::string name;
  std::filesystem::path folder;
  std::vector<FoundStream> imus;
  std::vector<FoundStream> others;
  std::vector<std::string> unknown;
  /// "b.csv.gz, which begins with the rows of a.csv": not used, as fixes must not
  /// count twice.
  std::vector<std::string> copies;
  std::string apart;  ///< as of ImuPairSearch
};

/// The recordings below `folder`, as DraftRecordings says; `rest` takes the
/// files that belong to none.
std::vector<RecordingFiles> FindRecordings(const std::filesystem::path& folder,
                                           RecordingFiles* rest);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_RECORDING_SEARCH_H_
