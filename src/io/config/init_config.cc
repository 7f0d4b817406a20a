#include "io/config/init_config.h"

#include <fmt/core.h>
#include <yaml-cpp/yaml.h>
#include <zlib.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"
#include "io/read/file_format.h"
#include "io/read/paths.h"
#include "io/read/text_lines.h"
#include "io/read/units.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;

/// Of the first line, which ends with the checksum of all others.
constexpr char kFirstWords[] =
    "# Written from what was found in the folder; unchanged if of checksum ";

std::string FirstLine(const std::string& rest) {
  const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(rest.data()),
                          static_cast<uInt>(rest.size()));
  return std::string(kFirstWords) + fmt::format("{:08x}", sum) + "\n";
}

/// Quoted where it would be read as something else.
std::string YamlScalar(const std::string& text,
                       YAML::EMITTER_MANIP format = YAML::Auto) {
  YAML::Emitter emitter;
  emitter.SetStringFormat(format);
  emitter << text;
  return emitter.c_str();
}

std::string FileLines(const FoundStreams& found, const std::string& indent) {
  return indent + "file: " + YamlScalar(found.file) + "\n" + indent +
         "format: " + found.format + "\n";
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

/// Names no file where none was recognised.
std::string ImuText(const FoundStreams* imu) {
  if (imu != nullptr) return "imu:\n" + FileLines(*imu, "  ") + kImuRest;
  std::string text =
      "# No IMU was recognised. `format: columns` reads any delimited text; a\n"
      "# column is its number from 1 or its title, and its unit. Uncomment:\n"
      "#imu:\n"
      "#  file: REPLACE\n"
      "#  format: columns\n"
      "#  columns: {t: \"1 [s]\",\n"
      "#            gyro_x: \"2 [rad/s]\", gyro_y: \"3 [rad/s]\",\n"
      "#            gyro_z: \"4 [rad/s]\", accel_x: \"5 [m/s^2]\",\n"
      "#            accel_y: \"6 [m/s^2]\", accel_z: \"7 [m/s^2]\"}\n";
  std::istringstream lines(kImuRest);
  for (std::string line; std::getline(lines, line);) {
    text += "#" + line + "\n";
  }
  return text;
}

/// A value to be replaced.
std::string Draft(const SensorKey& key) {
  if (std::holds_alternative<SensorKey::Place>(key.value)) {
    return "[0 deg, 0 deg, 0 m]";
  }
  std::string value = "1";
  switch (key.quantity) {
    case Quantity::kLength:
      value = "2 m";
      break;
    case Quantity::kSpeed:
      value = "0.2 m/s";
      break;
    case Quantity::kAngle:
      value = "2 deg";
      break;
    case Quantity::kRatio:
      break;
    default:
      value += std::string(" ") + SiUnit(key.quantity);
  }
  const bool three = std::holds_alternative<SensorKey::Vector>(key.value);
  return three ? "[" + value + ", " + value + ", " + value + "]" : value;
}

std::string KeyLine(const std::string& key, const std::string& value,
                    const std::string& comment) {
  constexpr std::size_t kComment = 27;
  std::string line = "    " + key + ": " + value;
  line.resize(std::max(line.size(), kComment - 1), ' ');
  return line + " # " + comment + "\n";
}

std::string AidingText(const std::string& name, const SensorKind& kind,
                       const FoundStreams& found) {
  std::string text = "  " + name + ":\n    type: " + std::string(kind.name) +
                     "\n" + FileLines(found, "    ");
  text += found.keys;
  const SensorSettings settings = SettingsOf(kind);
  const bool sigma_in_file = found.sigmas && kind.measured(settings).sigmas > 0;
  for (const SensorKey& key : kind.keys) {
    if (key.applies != nullptr && !key.applies(settings)) continue;
    const bool unstated = key.name == "sigma" && !sigma_in_file;
    if (unstated || (key.needed != nullptr && key.needed(settings))) {
      text += KeyLine(std::string(key.name), Draft(key), "REPLACE");
    } else if (key.name == "lever_arm") {
      text += KeyLine("lever_arm", "[0, 0, 0 m]",
                      "REPLACE: from the IMU; forward, right, down");
    }
  }
  if (kind.has_clock) {
    text += KeyLine("time_offset", "0 s", "true time = stamp + offset");
  }
  return text + KeyLine("gate", "off", "or 99.9 %: reject what fits worse");
}

}  // namespace

InitDraft InitConfig(const std::string& folder) {
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
  std::vector<FoundStreams> files;
  std::string unknown;
  for (const fs::path& path : paths) {
    if (auto found = RecogniseFormat(path.string())) {
      found->file = path.filename().string();
      files.push_back(*found);
    } else {
      unknown += "#   " + path.filename().string() + "\n";
    }
  }
  const auto first = [&](bool FoundStreams::*holds) -> const FoundStreams* {
    const auto at =
        std::find_if(files.begin(), files.end(),
                     [&](const FoundStreams& found) { return found.*holds; });
    return at == files.end() ? nullptr : &*at;
  };
  const fs::path absolute = fs::absolute(folder).lexically_normal();
  std::string text;
  if (!unknown.empty()) text += "# Not recognised:\n" + unknown;
  text +=
      "folder: " + YamlScalar(absolute.string(), YAML::DoubleQuoted) + "\n\n";
  const FoundStreams* imu = first(&FoundStreams::imu);
  text += ImuText(imu);
  std::string aiding;
  for (const SensorKind* kind : SensorKinds()) {
    int count = 0;
    for (const FoundStreams& found : files) {
      if (std::find(found.kinds.begin(), found.kinds.end(), kind) ==
          found.kinds.end()) {
        continue;
      }
      ++count;
      const std::string name =
          std::string(kind->name) + (count == 1 ? "" : std::to_string(count));
      aiding += AidingText(name, *kind, found);
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
  if (const FoundStreams* truth = first(&FoundStreams::truth)) {
    text += "\ntruth:\n" + FileLines(*truth, "  ") + truth->keys;
  }
  for (const FoundStreams& found : files) {
    if (!found.pose) continue;
    text +=
        "\n# Holds attitudes, which no estimate uses. If it is an independent\n"
        "# reference, uncomment:\n# truth:\n" +
        FileLines(found, "#   ");
  }
  return {FirstLine(text) + text, imu != nullptr};
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
