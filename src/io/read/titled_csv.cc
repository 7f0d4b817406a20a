#include <algorithm>
#include <cstddef>
#include <set>

#include "io/read/file_columns.h"
#include "io/read/file_formats.h"
#include "io/read/open_text.h"
#include "io/read/text_tokens.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

using Titles = std::set<std::string>;

/// Columns that a file of the kind must have, if it states its sigmas.
std::vector<std::string> NeededColumns(const SensorKind& kind) {
  const MeasuredColumns measured = kind.measured(SettingsOf(kind));
  std::vector<std::string> names;
  for (std::size_t i = 0; i < measured.count + measured.sigmas; ++i) {
    names.emplace_back(kind.columns[measured.first + i].name);
  }
  return names;
}

bool HoldsAll(const Titles& titles, const std::vector<std::string>& names) {
  return std::all_of(names.begin(), names.end(), [&](const std::string& name) {
    return titles.contains(name);
  });
}

bool Share(const SensorKind& a, const SensorKind& b) {
  const std::vector<std::string> of_b = NeededColumns(b);
  for (const std::string& name : NeededColumns(a)) {
    if (std::find(of_b.begin(), of_b.end(), name) != of_b.end()) return true;
  }
  return false;
}

std::ptrdiff_t ColumnsIn(const Titles& titles, const SensorKind& kind) {
  return std::count_if(
      kind.columns.begin(), kind.columns.end(),
      [&](const FieldName& column) { return titles.contains(column.name); });
}

/// Of kinds that would read the same column the one that reads most.
std::vector<const SensorKind*> KindsOfTitles(const Titles& titles) {
  std::vector<const SensorKind*> kinds;
  for (const SensorKind* kind : SensorKinds()) {
    if (!kind->configured || kind->generated ||
        !HoldsAll(titles, NeededColumns(*kind))) {
      continue;
    }
    const auto rival =
        std::find_if(kinds.begin(), kinds.end(),
                     [&](const SensorKind* k) { return Share(*k, *kind); });
    if (rival == kinds.end()) {
      kinds.push_back(kind);
    } else if (ColumnsIn(titles, *kind) > ColumnsIn(titles, **rival)) {
      *rival = kind;
    }
  }
  return kinds;
}

/// The forms of a speed or a distance that is no log of speed and course.
std::optional<FoundStream> OdometerOf(const Titles& titles) {
  FoundStream found = FoundAiding({&OdometerKind()});
  if (titles.contains("distance") && !titles.contains("speed")) {
    found.lines.push_back({"form", "increments"});
  } else if (!titles.contains("speed") || titles.contains("course")) {
    return std::nullopt;
  }
  return found;
}

std::optional<FoundStream> RecogniseCsv(const TextProbe& probe) {
  Titles titles;
  for (const std::string_view title :
       SplitLine(probe.lines[0], GuessDelimiter(probe.lines[0]))) {
    titles.insert(SplitTitle(title).first);
  }
  if (!titles.contains("t")) return std::nullopt;
  if (auto odometer = OdometerOf(titles)) return odometer;
  FoundStream found;
  found.imu = HoldsAll(titles, {"gyro_x", "gyro_y", "gyro_z", "accel_x",
                                "accel_y", "accel_z"}) ||
              HoldsAll(titles, {"dtheta_x", "dtheta_y", "dtheta_z", "dvel_x",
                                "dvel_y", "dvel_z"});
  // Its columns are those of several sensors.
  const bool attitude = HoldsAll(titles, {"roll", "pitch", "heading"});
  found.truth = attitude && IsNamedTruth(probe.path);
  found.pose = attitude && !found.truth;
  if (attitude) {
    Titles others = titles;
    for (const char* name : {"roll", "pitch", "heading"}) others.erase(name);
    found.kinds = KindsOfTitles(others);
  } else {
    found.kinds = KindsOfTitles(titles);
  }
  // Places beside attitudes are another solution's, no sensor's.
  if (!found.imu && !attitude && found.kinds.empty() &&
      HoldsAll(titles, {"lat", "lon", "h"})) {
    if (IsNamedTruth(probe.path)) {
      found.truth = true;
    } else {
      found.kinds = {&PositionKind()};
      found.sigmas = false;
    }
  }
  const bool known =
      found.imu || found.truth || found.pose || !found.kinds.empty();
  return known ? std::optional(found) : std::nullopt;
}

}  // namespace

const FileFormat& CsvFormat() {
  static const FileFormat kFormat = {.name = "csv",
                                     .help = "own CSV, titles with units",
                                     .streams = "all",
                                     .open = OpenTitled,
                                     .recognise_text = RecogniseCsv};
  return kFormat;
}

const FileFormat& ColumnsFormat() {
  static const FileFormat kFormat = {
      .name = "columns",
      .help =
          "any delimited text: quantity, column, unit, sign and scale are "
          "declared; or a constant",
      .streams = "all",
      .takes_columns = true,
      .columns =
          [](const TableRequest& request) { return request.format.columns; },
      .read_columns = ReadTextColumns};
  return kFormat;
}

}  // namespace hindsight
