#ifndef HINDSIGHT_IO_READ_SPLIT_SECONDS_H_
#define HINDSIGHT_IO_READ_SPLIT_SECONDS_H_

#include <optional>
#include <string>
#include <vector>

#include "io/read/file_columns.h"

namespace hindsight {

/// A column of whole seconds, and the next one what is left of them.
struct SplitSeconds {
  int column = 0;
  std::string rest_unit;  ///< "ns", "us" or "ms"
  std::vector<double> t;  ///< their sum [s]
};

/// Stamps as ROS and gettimeofday write them: told by the title of the second
/// column, or where most rows share their second with the one before and the rest
/// fills it. Nothing if the sums do not grow steadily.
std::optional<SplitSeconds> FindSplitSeconds(const FileColumns& file);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_SPLIT_SECONDS_H_
