#include "io/read/recognise_format.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <set>
#include <utility>
#include <vector>

#include "base/error.h"
#include "io/read/column_meaning.h"
#include "io/read/file_columns.h"
#include "io/read/paths.h"
#include "io/read/recognise_columns.h"
#include "io/read/text_layout.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;

/// Lines enough to tell formats and rates apart.
constexpr int kProbeLines = 60;

struct Probe {
  std::vector<std::string> comments;
  std::vector<std::string> lines;
};

Probe ReadProbe(const std::string& path) {
  Probe probe;
  TextLines lines(path);
  std::string_view line;
  while (static_cast<int>(probe.lines.size()) < kProbeLines &&
         lines.Next(&line)) {
    (IsComment(line) ? probe.comments : probe.lines).emplace_back(line);
  }
  return probe;
}

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
std::optional<Found> OdometerOf(const Titles& titles) {
  Found found = {"", "csv"};
  found.kinds = {&OdometerKind()};
  if (titles.contains("distance") && !titles.contains("speed")) {
    found.lines.push_back({"form", "increments"});
  } else if (!titles.contains("speed") || titles.contains("course")) {
    return std::nullopt;
  }
  return found;
}

std::optional<Found> RecogniseCsv(const std::string& path, const Probe& probe) {
  Titles titles;
  for (const std::string_view title : SplitLine(probe.lines[0], ',')) {
    titles.insert(SplitTitle(title).first);
  }
  if (!titles.contains("t")) return std::nullopt;
  if (auto odometer = OdometerOf(titles)) return odometer;
  Found found{"", "csv"};
  found.imu = HoldsAll(titles, {"gyro_x", "gyro_y", "gyro_z", "accel_x",
                                "accel_y", "accel_z"}) ||
              HoldsAll(titles, {"dtheta_x", "dtheta_y", "dtheta_z", "dvel_x",
                                "dvel_y", "dvel_z"});
  // Its columns are those of several sensors.
  const bool attitude = HoldsAll(titles, {"roll", "pitch", "heading"});
  found.truth = attitude && IsNamedTruth(path);
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
    if (IsNamedTruth(path)) {
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

Found AnImu(const char* format) {
  Found found{"", format};
  found.imu = true;
  return found;
}

Found ATruth(const char* format) {
  Found found{"", format};
  found.truth = true;
  return found;
}

Found Aiding(const char* format, std::vector<const SensorKind*> kinds) {
  Found found{"", format};
  found.kinds = std::move(kinds);
  return found;
}

std::optional<Found> RecognisePos(const Probe& probe) {
  if (probe.comments.empty() ||
      probe.comments.back().find("latitude(deg)") == std::string::npos) {
    return std::nullopt;
  }
  return Aiding("rtklib_pos", {&PositionKind()});
}

std::vector<double> Numbers(const std::string& line) {
  std::vector<double> numbers;
  for (const std::string_view token : SplitLine(line, ' ')) {
    const auto number = ParseNumber(token);
    if (!number) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

std::optional<Found> RecogniseKfGins(const Probe& probe) {
  if (probe.lines.size() < 3) return std::nullopt;
  const std::vector<double> first = Numbers(probe.lines[0]);
  const std::vector<double> second = Numbers(probe.lines[1]);
  if (first.size() != second.size()) return std::nullopt;
  const bool week = first.size() >= 11 && first[0] == second[0] &&
                    first[0] == std::floor(first[0]) && first[0] >= 1000.0;
  if (week) return ATruth("kf_gins");
  if (first.size() < 7 || second[0] <= first[0]) return std::nullopt;
  // A pose as the TUM benchmark writes it: t, place, unit quaternion.
  const double length = std::hypot(std::hypot(first[4], first[5]),
                                   std::hypot(first[6], first.back()));
  if (first.size() == 8 && std::abs(length - 1.0) < 1e-3) return std::nullopt;
  // Increments come fast and are small; fixes hold degrees and metres.
  const bool sigmas = first[4] > 0.0 && first[5] > 0.0 && first[6] > 0.0;
  const bool place = std::abs(first[1]) <= 90.0 && std::abs(first[2]) <= 180.0;
  const bool fast = second[0] - first[0] <= 0.05;
  if (fast && first.size() <= 8) return AnImu("kf_gins");
  if (!fast && sigmas && place) {
    return Aiding("kf_gins", {&PositionKind()});
  }
  return std::nullopt;
}

std::optional<Found> RecogniseEuroc(const Probe& probe) {
  if (probe.comments.empty()) return std::nullopt;
  const std::string& header = probe.comments.back();
  if (header.find("w_RS_S_x") != std::string::npos) {
    const bool truth = header.find("p_RS_R_x") != std::string::npos;
    if (!truth) return AnImu("euroc");
    Found found = ATruth("euroc");
    found.lines = {{"frame", "enu", "z up; x east is a guess"},
                   {"origin", "[0 deg, 0 deg, 0 m]",
                    "the file does not say where (a guess)"}};
    return found;
  }
  return std::nullopt;
}

/// NCLT's files have no header: microseconds since 1970 and a fixed width.
std::optional<Found> RecogniseNclt(const Probe& probe) {
  const auto tokens = SplitLine(probe.lines[0], ',');
  const auto stamp = ParseNumber(tokens[0]);
  const bool microseconds = stamp && *stamp > 1e15 && *stamp < 3e15;
  if (!microseconds) return std::nullopt;
  if (tokens.size() == 10) return AnImu("nclt");
  if (tokens.size() == 8) {
    Found found = Aiding("nclt", {&PositionKind(), &SpeedCourseKind()});
    found.lines = {{"accept_quality", "[3]", "with a fix in three axes"}};
    return found;
  }
  return std::nullopt;
}

std::optional<Found> RecogniseNmea(const Probe& probe) {
  bool gga = false;
  bool rmc = false;
  for (const std::string& line : probe.lines) {
    if (!line.starts_with('$') || line.size() < 6) return std::nullopt;
    gga = gga || line.substr(3, 3) == "GGA";
    rmc = rmc || line.substr(3, 3) == "RMC";
  }
  Found found{"", "nmea"};
  if (gga) found.kinds.push_back(&PositionKind());
  if (rmc) found.kinds.push_back(&SpeedCourseKind());
  if (found.kinds.empty()) return std::nullopt;
  return found;
}

std::optional<Found> RecogniseControlPoints(const Probe& probe) {
  for (const std::string& line : probe.lines) {
    const std::vector<double> numbers = Numbers(line);
    if (numbers.size() != 5 || std::abs(numbers[1]) > 90.0 ||
        std::abs(numbers[2]) > 360.0 || !(numbers[4] > 0.0)) {
      return std::nullopt;
    }
  }
  return Aiding("control_points", {&PositionKind()});
}

/// Formats told by their name: their content is not text.
std::optional<Found> RecogniseName(const fs::path& path) {
  if (IsFolder(path)) {
    if (!PathExists(path / "timestamps.txt") || !PathExists(path / "data")) {
      return std::nullopt;
    }
    Found found = Aiding("oxts", {&PositionKind(), &VelocityKind()});
    found.imu = found.truth = true;
    return found;
  }
  if (path.extension() == ".bag") {
    Found found = Aiding("rosbag", {&PositionKind()});
    found.imu = true;
    return found;
  }
  return std::nullopt;
}

/// A format that has one of its own.
std::optional<Found> RecogniseOwn(const std::string& path) {
  Probe probe;
  try {
    probe = ReadProbe(path);
  } catch (const InputError&) {
    return std::nullopt;
  }
  if (probe.lines.empty()) return std::nullopt;
  if (auto found = RecognisePos(probe)) return found;
  if (auto found = RecogniseEuroc(probe)) return found;
  if (auto found = RecogniseNmea(probe)) return found;
  if (auto found = RecogniseNclt(probe)) return found;
  return RecogniseCsv(path, probe);
}

/// A format of bare numbers in a fixed order.
std::optional<Found> RecogniseBare(const std::string& path) {
  const Probe probe = ReadProbe(path);
  if (auto found = RecogniseControlPoints(probe)) return found;
  return RecogniseKfGins(probe);
}

/// Columns that no format declares.
std::vector<Found> RecogniseNumbers(const std::string& path,
                                    const RecogniseHints& hints) {
  const std::string name = fs::path(path).filename().string();
  if (fs::path(path).extension() == ".mat") {
    return RecogniseColumns(ReadMatColumns(path), name, hints);
  }
  const auto columns = ReadTextColumns(path);
  if (!columns) return {};
  return RecogniseColumns(*columns, name, hints);
}

}  // namespace

void SetLine(KeyLine line, std::vector<KeyLine>* lines) {
  const auto at =
      std::find_if(lines->begin(), lines->end(),
                   [&](const KeyLine& known) { return known.key == line.key; });
  if (at != lines->end()) {
    *at = std::move(line);
  } else {
    lines->push_back(std::move(line));
  }
}

const KeyLine* FindLine(const std::vector<KeyLine>& lines,
                        const std::string& key) {
  const auto at =
      std::find_if(lines.begin(), lines.end(),
                   [&](const KeyLine& line) { return line.key == key; });
  return at == lines.end() ? nullptr : &*at;
}

bool IsNamedTruth(const std::string& path) {
  const std::string name = fs::path(path).filename().string();
  const std::vector<std::string> words = SplitWords(name);
  return std::any_of(words.begin(), words.end(), [](const std::string& word) {
    return word == "truth" || word == "groundtruth" || word == "reference" ||
           word == "gt" || word == "ref";
  });
}

std::vector<Found> RecogniseFormat(const std::string& path,
                                   const RecogniseHints& hints) {
  if (auto found = RecogniseName(path)) return {*found};
  if (IsFolder(path)) return {};
  if (auto found = RecogniseOwn(path)) return {*found};
  try {
    std::vector<Found> found = RecogniseNumbers(path, hints);
    const bool imu = std::any_of(found.begin(), found.end(),
                                 [](const Found& f) { return f.imu; });
    // Increments have no gravity to be known by, fixes of a fixed order none
    // of its own columns.
    if (!imu && fs::path(path).extension() != ".mat") {
      if (auto bare = RecogniseBare(path)) return {*bare};
    }
    return found;
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace hindsight
