#include "io/recognise_format.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "base/error.h"
#include "io/paths.h"
#include "io/text_layout.h"

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

std::set<Role> RolesOfTitles(const std::set<std::string>& titles) {
  const auto all = [&](std::initializer_list<const char*> names) {
    return std::all_of(names.begin(), names.end(),
                       [&](const char* name) { return titles.contains(name); });
  };
  std::set<Role> roles;
  if (!titles.contains("t")) return roles;
  if (all({"gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z"}) ||
      all({"dtheta_x", "dtheta_y", "dtheta_z", "dvel_x", "dvel_y", "dvel_z"})) {
    roles.insert(Role::kImu);
  }
  if (all({"lat", "lon", "h", "sigma_n", "sigma_e", "sigma_d"})) {
    roles.insert(Role::kPosition);
  }
  if (all({"v_n", "v_e", "v_d", "sigma_v_n", "sigma_v_e", "sigma_v_d"})) {
    roles.insert(Role::kVelocity);
  }
  if (all({"h", "sigma_h"})) roles.insert(Role::kHeight);
  if (all({"roll", "pitch", "heading"}) ||
      (roles.empty() && all({"lat", "lon", "h"}))) {
    roles.insert(Role::kTruth);
  }
  return roles;
}

std::optional<Found> RecogniseCsv(const Probe& probe) {
  std::set<std::string> titles;
  for (const std::string_view title : SplitLine(probe.lines[0], ',')) {
    titles.insert(SplitTitle(title).first);
  }
  std::set<Role> roles = RolesOfTitles(titles);
  if (roles.empty()) return std::nullopt;
  return Found{"", "csv", std::move(roles)};
}

std::optional<Found> RecognisePos(const Probe& probe) {
  if (probe.comments.empty() ||
      probe.comments.back().find("latitude(deg)") == std::string::npos) {
    return std::nullopt;
  }
  return Found{"", "rtklib_pos", {Role::kPosition}};
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
  if (week) return Found{"", "kf_gins", {Role::kTruth}};
  if (first.size() < 7 || second[0] <= first[0]) return std::nullopt;
  // Increments come fast and are small; fixes hold degrees and metres.
  const bool sigmas = first[4] > 0.0 && first[5] > 0.0 && first[6] > 0.0;
  const bool place = std::abs(first[1]) <= 90.0 && std::abs(first[2]) <= 180.0;
  const bool fast = second[0] - first[0] <= 0.05;
  if (fast && first.size() <= 8) return Found{"", "kf_gins", {Role::kImu}};
  if (!fast && sigmas && place) {
    return Found{"", "kf_gins", {Role::kPosition}};
  }
  return std::nullopt;
}

std::optional<Found> RecogniseEuroc(const Probe& probe) {
  if (probe.comments.empty()) return std::nullopt;
  const std::string& header = probe.comments.back();
  if (header.find("w_RS_S_x") != std::string::npos) {
    const bool truth = header.find("p_RS_R_x") != std::string::npos;
    if (!truth) return Found{"", "euroc", {Role::kImu}};
    return Found{"",
                 "euroc",
                 {Role::kTruth},
                 "  frame: enu              # z up; x east is a guess\n"
                 "  origin: [0 deg, 0 deg, 0 m]  # REPLACE\n"};
  }
  return std::nullopt;
}

/// NCLT's files have no header: microseconds since 1970 and a fixed width.
std::optional<Found> RecogniseNclt(const Probe& probe) {
  const auto tokens = SplitLine(probe.lines[0], ',');
  const auto stamp = ParseNumber(tokens[0]);
  const bool microseconds = stamp && *stamp > 1e15 && *stamp < 3e15;
  if (!microseconds) return std::nullopt;
  if (tokens.size() == 10) return Found{"", "nclt", {Role::kImu}};
  if (tokens.size() == 8) {
    return Found{"",
                 "nclt",
                 {Role::kPosition, Role::kSpeedCourse},
                 "    accept_quality: [3]    # with a fix in three axes\n"};
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
  Found found{"", "nmea", {}};
  if (gga) found.roles.insert(Role::kPosition);
  if (rmc) found.roles.insert(Role::kSpeedCourse);
  if (found.roles.empty()) return std::nullopt;
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
  return Found{"", "control_points", {Role::kPosition}};
}

/// Formats told by their name: their content is not text.
std::optional<Found> RecogniseName(const fs::path& path) {
  if (IsFolder(path)) {
    if (!PathExists(path / "timestamps.txt") || !PathExists(path / "data")) {
      return std::nullopt;
    }
    return Found{"",
                 "oxts",
                 {Role::kImu, Role::kPosition, Role::kVelocity, Role::kTruth}};
  }
  if (path.extension() == ".bag") {
    return Found{"", "rosbag", {Role::kImu, Role::kPosition}};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Found> RecogniseFormat(const std::string& path) {
  if (auto found = RecogniseName(path)) return found;
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
  if (auto found = RecogniseCsv(probe)) return found;
  if (auto found = RecogniseControlPoints(probe)) return found;
  return RecogniseKfGins(probe);
}

}  // namespace hindsight
