#ifndef HINDSIGHT_IO_CONFIG_RECOGNISE_AGAIN_H_
#define HINDSIGHT_IO_CONFIG_RECOGNISE_AGAIN_H_

#include <filesystem>
#include <string>
#include <vector>

#include "io/read/recognise_format.h"

namespace hindsight {

/// Once the IMU's record is known, its span and rate tell what was stamped
/// otherwise: looks again at the tables among `others`, and at the `unknown`
/// files, of which those become streams whose rows are counted.
void RecogniseAgain(const FoundStream& imu, const std::filesystem::path& folder,
                    std::vector<FoundStream>* others,
                    std::vector<std::string>* unknown);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_RECOGNISE_AGAIN_H_
