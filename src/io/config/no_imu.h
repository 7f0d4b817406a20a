#ifndef HINDSIGHT_IO_CONFIG_NO_IMU_H_
#define HINDSIGHT_IO_CONFIG_NO_IMU_H_

#include <string>

#include "io/config/recording_search.h"

namespace hindsight {

/// Throws InputError of a folder in which no IMU was recognised: what was found
/// instead, which of it cannot be read as it is, and what to do.
[[noreturn]] void FailWithoutImu(const std::string& folder,
                                 const RecordingFiles& rest);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_NO_IMU_H_
