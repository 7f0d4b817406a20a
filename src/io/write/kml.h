#ifndef HINDSIGHT_IO_WRITE_KML_H_
#define HINDSIGHT_IO_WRITE_KML_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "evaluation/solution_table.h"

namespace hindsight {

/// Most points of a KML line: viewers slow down beyond.
inline constexpr std::size_t kMaxKmlPoints = 5000;

/// KML 2.2 for maps: the path as a LineString and, if `epoch_gps_ns` (as in
/// Dataset) gives the data a date, as a gx:Track with UTC times and headings.
/// At most kMaxKmlPoints epochs, evenly thinned by index, first and last
/// kept. Heights are above the ellipsoid, while viewers take them above the
/// sea; `name` is the title, `description`, if not empty, what viewers show
/// with it. Throws OutputError if the file cannot be written,
/// and EstimationError if the table has no positions.
void WriteKml(const std::string& path, const SolutionTable& table,
              std::optional<std::int64_t> epoch_gps_ns, const std::string& name,
              const std::string& description = "");

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_KML_H_
