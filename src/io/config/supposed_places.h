#ifndef HINDSIGHT_IO_CONFIG_SUPPOSED_PLACES_H_
#define HINDSIGHT_IO_CONFIG_SUPPOSED_PLACES_H_

#include <string>
#include <vector>

#include "io/read/found_stream.h"

namespace hindsight {

/// Takes out of `others` the positions that their numbers alone made ones:
/// those of the IMU's file where the positions of another lie 300 km and more
/// away, and those of any file where titled ones do. Each with the reason as
/// its last remark.
std::vector<FoundStream> TakeSupposedPlaces(const std::string& imu_file,
                                            std::vector<FoundStream>* others);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_SUPPOSED_PLACES_H_
