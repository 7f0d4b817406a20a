#ifndef HINDSIGHT_IO_WRITE_NAV_H_
#define HINDSIGHT_IO_WRITE_NAV_H_

#include <cstdint>
#include <optional>
#include <string>

#include "evaluation/solution_table.h"

namespace hindsight {

/// KF-GINS .nav, 11 fields separated by blanks, no header:
///   week  seconds of week  lat lon [deg]  h [m]  vN vE vD [m/s]
///   roll pitch yaw [deg], yaw in [0, 360)
/// `epoch_gps_ns` as in Dataset; without a date the week is 0 and the seconds
/// are those of the data set. Throws OutputError if the file cannot be written,
/// and EstimationError if the table lacks position, velocity or attitude.
void WriteNav(const std::string& path, const SolutionTable& table,
              std::optional<std::int64_t> epoch_gps_ns);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_NAV_H_
