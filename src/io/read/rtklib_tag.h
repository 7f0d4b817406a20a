#ifndef HINDSIGHT_IO_READ_RTKLIB_TAG_H_
#define HINDSIGHT_IO_READ_RTKLIB_TAG_H_

#include <cstdint>
#include <optional>
#include <string>

#include "io/read/time_scale.h"

namespace hindsight {

/// What a time tag of RTKLIB says of the log beside it (RTKLIB 2.4.3,
/// stream.c, openfile_ and writefile): when it was opened, and how many bytes
/// had come after how many milliseconds.
struct RtklibTag {
  Stamp opened;             ///< GPS time since 1980-01-06
  double duration = 0.0;    ///< from there to the last bytes [s]
  std::uint64_t bytes = 0;  ///< of the log by then
};

/// Nothing if the file is no time tag. Throws InputError if it cannot be read.
std::optional<RtklibTag> ReadRtklibTag(const std::string& path);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_RTKLIB_TAG_H_
