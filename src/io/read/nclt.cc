#include "io/read/file_formats.h"
#include "io/read/open_text.h"
#include "io/read/text_tokens.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

std::vector<ColumnMapping> NcltColumns(const TableRequest& request) {
  std::vector<ColumnMapping> columns = {ColumnAt(1, "t", "us")};
  if (request.IsImu()) {
    AppendVector(5, "accel", "m/s^2", &columns);
    AppendVector(8, "gyro", "rad/s", &columns);
    return columns;
  }
  columns.push_back(ColumnAt(2, "quality", "1"));
  if (request.Is(PositionKind()) || request.Is(HeightKind())) {
    columns.push_back(ColumnAt(3, "satellites", "1"));
    columns.push_back(ColumnAt(4, "lat", "rad"));
    columns.push_back(ColumnAt(5, "lon", "rad"));
    columns.push_back(ColumnAt(6, "h", "m"));
    return columns;
  }
  if (request.Is(SpeedCourseKind())) {
    columns.push_back(ColumnAt(7, "course", "rad"));
    columns.push_back(ColumnAt(8, "speed", "m/s"));
    return columns;
  }
  return {};
}

/// Microseconds since 1970 and a fixed number of columns.
std::optional<FoundStream> RecogniseNclt(const TextProbe& probe) {
  const auto tokens = SplitLine(probe.lines[0], ',');
  const auto stamp = ParseNumber(tokens[0]);
  const bool microseconds = stamp && *stamp > 1e15 && *stamp < 3e15;
  if (!microseconds) return std::nullopt;
  if (tokens.size() == 10) return FoundImu();
  if (tokens.size() != 8) return std::nullopt;
  FoundStream found = FoundAiding({&PositionKind(), &SpeedCourseKind()});
  found.sigmas = false;
  found.lines = {{"accept_quality", "[3]", "with a fix in three axes"}};
  return found;
}

}  // namespace

const FileFormat& NcltFormat() {
  static const FileFormat kFormat = {
      .name = "nclt",
      .help = "NCLT `ms25.csv`, `gps.csv`",
      .streams = "imu, position, height, speed and course",
      .counts_from_1970 = true,
      .columns = NcltColumns,
      .recognise_text = RecogniseNclt};
  return kFormat;
}

}  // namespace hindsight
