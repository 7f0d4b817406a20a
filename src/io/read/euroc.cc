#include "io/read/file_formats.h"
#include "io/read/open_text.h"

namespace hindsight {
namespace {

std::vector<ColumnMapping> EurocColumns(const TableRequest& request) {
  std::vector<ColumnMapping> columns = {ColumnAt(1, "t", "ns")};
  if (request.IsImu()) {
    AppendVector(2, "gyro", "rad/s", &columns);
    AppendVector(5, "accel", "m/s^2", &columns);
    return columns;
  }
  if (request.IsTruth()) {
    AppendVector(2, "p", "m", &columns);
    columns.push_back(ColumnAt(5, "q_w", "1"));
    AppendVector(6, "q", "1", &columns);
    AppendVector(9, "v", "m/s", &columns);
    return columns;
  }
  return {};
}

std::optional<FoundStream> RecogniseEuroc(const TextProbe& probe) {
  if (probe.comments.empty()) return std::nullopt;
  const std::string& header = probe.comments.back();
  if (header.find("w_RS_S_x") == std::string::npos) return std::nullopt;
  if (header.find("p_RS_R_x") == std::string::npos) return FoundImu();
  FoundStream found = FoundTruth();
  found.lines = {{"frame", "enu", "z up; x east is a guess"},
                 {"origin", "[0 deg, 0 deg, 0 m]",
                  "the file does not say where (a guess)"}};
  return found;
}

}  // namespace

const FileFormat& EurocFormat() {
  static const FileFormat kFormat = {
      .name = "euroc",
      .help = "EuRoC MAV `imu0`, `state_groundtruth_estimate0`",
      .streams = "imu, truth",
      .counts_from_1970 = true,
      .columns = EurocColumns,
      .recognise_text = RecogniseEuroc};
  return kFormat;
}

}  // namespace hindsight
