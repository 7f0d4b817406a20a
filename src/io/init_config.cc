#include "io/init_config.h"

#include <zlib.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "base/error.h"
#include "io/paths.h"
#include "io/recognise_format.h"
#include "io/text_lines.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;

/// Of the first line, which ends with the checksum of all others.
constexpr char kFirstWords[] =
    "# Written from what was found in the folder; unchanged if of checksum ";

std::string FirstLine(const std::string& rest) {
  const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(rest.data()),
                          static_cast<uInt>(rest.size()));
  char digits[16];
  std::snprintf(digits, sizeof(digits), "%08lx", sum);
  return std::string(kFirstWords) + digits + "\n";
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
  text += found.keys;
  const bool sigma_in_file = found.format != "nmea" && found.format != "nclt";
  if (std::string(type) == "speed_course") {
    text +=
        "    sigma: 0.2 m/s         # REPLACE\n"
        "    course_sigma: 2 deg    # REPLACE\n";
  } else if (!sigma_in_file) {
    text += "    sigma: [2, 2, 4 m]     # REPLACE\n";
  }
  return text +
         "    lever_arm: [0, 0, 0 m] # REPLACE: from the IMU; forward, right, "
         "down\n"
         "    time_offset: 0 s       # true time = stamp + offset\n"
         "    gate: off              # or 99.9 %: reject what fits worse\n";
}

}  // namespace

std::string InitConfig(const std::string& folder) {
  if (!IsFolder(folder)) {
    throw InputError(folder, 0, "there is no such folder");
  }
  std::vector<fs::path> paths;
  for (const fs::path& entry : FolderEntries(folder)) {
    if (IsFile(entry) || PathExists(entry / "timestamps.txt")) {
      paths.push_back(entry);
    }
  }
  if (paths.empty()) throw InputError(folder, 0, "the folder holds no files");
  std::vector<Found> files;
  std::string unknown;
  for (const fs::path& path : paths) {
    if (auto found = RecogniseFormat(path.string())) {
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
  std::string text;
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
        Aiding{Role::kVelocity, "velocity"}, Aiding{Role::kHeight, "height"},
        Aiding{Role::kSpeedCourse, "speed_course"}}) {
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
    text += "\ntruth:\n" + FileLines(*truth, "  ") + truth->keys;
  }
  return FirstLine(text) + text;
}

bool IsInitConfig(const std::string& path) {
  TextLines lines(path);
  std::string_view line;
  if (!lines.Next(&line) || !line.starts_with(kFirstWords)) return false;
  const std::string first = std::string(line) + "\n";
  std::string rest;
  while (lines.Next(&line)) rest += std::string(line) + "\n";
  return first == FirstLine(rest);
}

}  // namespace hindsight
