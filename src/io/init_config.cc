#include "io/init_config.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <vector>

#include "base/error.h"
#include "io/text_format.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;

enum class Role { kImu, kPosition, kVelocity, kHeight, kTruth };

struct Found {
  std::string file;
  std::string format;
  std::set<Role> roles;
};

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

std::optional<Found> Recognise(const std::string& path) {
  Probe probe;
  try {
    probe = ReadProbe(path);
  } catch (const InputError&) {
    return std::nullopt;
  }
  if (probe.lines.empty()) return std::nullopt;
  if (auto found = RecognisePos(probe)) return found;
  if (auto found = RecogniseCsv(probe)) return found;
  return RecogniseKfGins(probe);
}

std::string FileLines(const Found& found, const std::string& indent) {
  return indent + "file: " + found.file + "\n" + indent +
         "format: " + found.format + "\n";
}

std::string ImuText(const Found* imu) {
  if (imu == nullptr) {
    return "# No IMU was recognised. `format: columns` reads any delimited\n"
           "# text; a column is its number from 1 or its title, and its unit.\n"
           "imu:\n"
           "  file: imu.csv\n"
           "  format: columns\n"
           "  columns: {t: \"1 [s]\",\n"
           "            gyro_x: \"2 [rad/s]\", gyro_y: \"3 [rad/s]\",\n"
           "            gyro_z: \"4 [rad/s]\", accel_x: \"5 [m/s^2]\",\n"
           "            accel_y: \"6 [m/s^2]\", accel_z: \"7 [m/s^2]\"}\n";
  }
  return "imu:\n" + FileLines(*imu, "  ");
}

constexpr const char* kImuRest =
    "  axes: [x, y, z]          # body forward, right, down in sensor axes;\n"
    "                           # `hindsight check` suggests them\n"
    "  mounting: [0, 0, 0 deg]  # roll, pitch, yaw left after axes\n"
    "  time_offset: 0 s         # added to the stamps\n"
    "  max_gap: 0.5 s           # longer gaps are errors\n"
    "  noise:                   # REPLACE by the data sheet's values\n"
    "    gyro: 0.2 deg/sqrt(h)\n"
    "    accel: 100 ug/sqrt(Hz)\n"
    "    gyro_bias_walk: 1 deg/h/sqrt(h)\n"
    "    accel_bias_walk: 100 ug/sqrt(h)\n";

std::string AidingText(const std::string& name, const char* type,
                       const Found& found) {
  std::string text =
      "  " + name + ":\n    type: " + type + "\n" + FileLines(found, "    ");
  if (found.format == "rtklib_pos") {
    text +=
        "    # accept_quality: [1]  # 1 fix, 2 float, 4 differential, 5 "
        "single\n";
  }
  return text +
         "    lever_arm: [0, 0, 0 m] # REPLACE: from the IMU; forward, right, "
         "down\n"
         "    time_offset: 0 s       # true time = stamp + offset\n"
         "    gate: off              # or 99.9 %: reject what fits worse\n";
}

}  // namespace

std::string InitConfig(const std::string& folder) {
  if (!fs::is_directory(folder)) {
    throw InputError(folder, 0, "there is no such folder");
  }
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file()) paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  if (paths.empty()) throw InputError(folder, 0, "the folder holds no files");
  std::vector<Found> files;
  std::string unknown;
  for (const fs::path& path : paths) {
    if (auto found = Recognise(path.string())) {
      found->file = path.filename().string();
      files.push_back(*found);
    } else {
      unknown += "#   " + path.filename().string() + "\n";
    }
  }
  const auto first = [&](Role role) -> const Found* {
    const auto at = std::find_if(
        files.begin(), files.end(),
        [&](const Found& found) { return found.roles.contains(role); });
    return at == files.end() ? nullptr : &*at;
  };
  const fs::path absolute = fs::absolute(folder).lexically_normal();
  std::string text = "# Written from what was found in the folder.\n";
  if (!unknown.empty()) text += "# Not recognised:\n" + unknown;
  text += "folder: \"" + absolute.string() + "\"\n\n";
  text += ImuText(first(Role::kImu)) + kImuRest;
  struct Aiding {
    Role role;
    const char* type;
  };
  std::string aiding;
  for (const Aiding& kind :
       {Aiding{Role::kPosition, "position"},
        Aiding{Role::kVelocity, "velocity"}, Aiding{Role::kHeight, "height"}}) {
    int count = 0;
    for (const Found& found : files) {
      if (!found.roles.contains(kind.role)) continue;
      ++count;
      const std::string name =
          kind.type + (count == 1 ? std::string() : std::to_string(count));
      aiding += AidingText(name, kind.type, found);
    }
  }
  text += aiding.empty() ? "\n# No aiding was recognised.\naiding: {}\n"
                         : "\naiding:\n" + aiding;
  text +=
      "\n# Standstill: zero velocity and zero rate where the IMU is quiet.\n"
      "stationary: off\n"
      "\n# Measurements kept back, to see how well the gaps are bridged:\n"
      "# withhold:\n"
      "#   - {sensor: position, every: 120 s, length: 30 s}\n";
  if (const Found* truth = first(Role::kTruth)) {
    text += "\ntruth:\n" + FileLines(*truth, "  ");
  }
  return text;
}

}  // namespace hindsight
