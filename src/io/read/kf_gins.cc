#include <cmath>

#include "io/read/file_formats.h"
#include "io/read/open_text.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

std::vector<ColumnMapping> KfGinsColumns(const TableRequest& request) {
  std::vector<ColumnMapping> columns = {ColumnAt(1, "t", "s")};
  if (request.IsImu()) {
    AppendVector(2, "dtheta", "rad", &columns);
    AppendVector(5, "dvel", "m/s", &columns);
    return columns;
  }
  if (request.Is(OdometerKind())) {
    columns.push_back(ColumnAt(8, "speed", "m/s"));
    return columns;
  }
  if (request.IsTruth()) {
    // The week stands first; the other files of a set do not have it.
    return {ColumnAt(2, "t", "s"),        ColumnAt(3, "lat", "deg"),
            ColumnAt(4, "lon", "deg"),    ColumnAt(5, "h", "m"),
            ColumnAt(6, "v_n", "m/s"),    ColumnAt(7, "v_e", "m/s"),
            ColumnAt(8, "v_d", "m/s"),    ColumnAt(9, "roll", "deg"),
            ColumnAt(10, "pitch", "deg"), ColumnAt(11, "heading", "deg")};
  }
  if (request.Is(PositionKind()) || request.Is(HeightKind())) {
    return {ColumnAt(1, "t", "s"),       ColumnAt(2, "lat", "deg"),
            ColumnAt(3, "lon", "deg"),   ColumnAt(4, "h", "m"),
            ColumnAt(5, "sigma_n", "m"), ColumnAt(6, "sigma_e", "m"),
            ColumnAt(7, "sigma_d", "m"), ColumnAt(7, "sigma_h", "m")};
  }
  return {};
}

std::optional<FoundStream> RecogniseKfGins(const TextProbe& probe) {
  if (probe.lines.size() < 3) return std::nullopt;
  const std::vector<double> first = NumbersOf(probe.lines[0]);
  const std::vector<double> second = NumbersOf(probe.lines[1]);
  if (first.size() != second.size()) return std::nullopt;
  const bool week = first.size() >= 11 && first[0] == second[0] &&
                    first[0] == std::floor(first[0]) && first[0] >= 1000.0;
  if (week) return FoundTruth();
  if (first.size() < 7 || second[0] <= first[0]) return std::nullopt;
  // A pose as the TUM benchmark writes it: t, place, unit quaternion.
  const double length = std::hypot(std::hypot(first[4], first[5]),
                                   std::hypot(first[6], first.back()));
  if (first.size() == 8 && std::abs(length - 1.0) < 1e-3) return std::nullopt;
  // Increments come fast and are small; fixes hold degrees and metres.
  const bool sigmas = first[4] > 0.0 && first[5] > 0.0 && first[6] > 0.0;
  const bool place = std::abs(first[1]) <= 90.0 && std::abs(first[2]) <= 180.0;
  const bool fast = second[0] - first[0] <= 0.05;
  if (fast && first.size() <= 8) return FoundImu();
  if (!fast && sigmas && place) return FoundAiding({&PositionKind()});
  return std::nullopt;
}

}  // namespace

const FileFormat& KfGinsFormat() {
  static const FileFormat kFormat = {
      .name = "kf_gins",
      .help = "KF-GINS and OB_GINS text; the odometer speed as eighth column",
      .streams = "imu, position, height, odometer, truth",
      .columns = KfGinsColumns,
      .recognise_bare = RecogniseKfGins};
  return kFormat;
}

}  // namespace hindsight
