#include <cmath>

#include "io/read/file_formats.h"
#include "io/read/open_text.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

std::vector<ColumnMapping> ControlPointsColumns(const TableRequest& request) {
  if (!request.Is(PositionKind()) && !request.Is(HeightKind())) return {};
  return {ColumnAt(1, "t", "s"),       ColumnAt(2, "lat", "deg"),
          ColumnAt(3, "lon", "deg"),   ColumnAt(4, "h", "m"),
          ColumnAt(5, "sigma_n", "m"), ColumnAt(5, "sigma_e", "m"),
          ColumnAt(5, "sigma_d", "m"), ColumnAt(5, "sigma_h", "m")};
}

std::optional<FoundStream> RecogniseControlPoints(const TextProbe& probe) {
  for (const std::string& line : probe.lines) {
    const std::vector<double> numbers = NumbersOf(line);
    if (numbers.size() != 5 || std::abs(numbers[1]) > 90.0 ||
        std::abs(numbers[2]) > 360.0 || !(numbers[4] > 0.0)) {
      return std::nullopt;
    }
  }
  return FoundAiding({&PositionKind()});
}

}  // namespace

const FileFormat& ControlPointsFormat() {
  static const FileFormat kFormat = {.name = "control_points",
                                     .help = "`t lat lon h sigma`",
                                     .streams = "position, height",
                                     .columns = ControlPointsColumns,
                                     .recognise_bare = RecogniseControlPoints};
  return kFormat;
}

}  // namespace hindsight
