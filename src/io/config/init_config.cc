#include "io/config/init_config.h"

#include <fmt/core.h>
#include <yaml-cpp/yaml.h>
#include <zlib.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "io/read/file_format.h"
#include "io/read/text_lines.h"

namespace hindsight {
namespace {

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

std::string Render(const KeyLine& line, const std::string& indent) {
  constexpr std::size_t kComment = 40;
  std::string text = indent + line.key + ":";
  if (!line.value.empty()) text += " " + line.value;
  if (line.comment.empty()) return text + "\n";
  text.resize(std::max(text.size() + 2, kComment), ' ');
  return text + "# " + line.comment + "\n";
}

std::string Render(const std::vector<KeyLine>& lines,
                   const std::string& indent) {
  std::string text;
  for (const KeyLine& line : lines) text += Render(line, indent);
  return text;
}

/// A name, or the list of all.
std::string FileValue(const FoundStream& found) {
  if (found.more_files.empty()) return YamlScalar(found.file);
  std::string list = "[" + YamlScalar(found.file, YAML::DoubleQuoted);
  for (const std::string& more : found.more_files) {
    list += ", " + YamlScalar(more, YAML::DoubleQuoted);
  }
  return list + "]";
}

std::string StreamText(const FoundStream& found, const std::string& indent) {
  std::string text;
  for (const std::string& remark : found.remarks) {
    text += indent + "# " + remark + "\n";
  }
  return text + Render({"file", FileValue(found), found.joined_by}, indent) +
         indent + "format: " + std::string(found.format->name) + "\n" +
         Render(found.lines, indent);
}

/// Values of an IMU of which nothing is known but that it is one.
std::vector<KeyLine> UsualImuLines(const FoundStream& imu) {
  std::vector<KeyLine> lines = imu.lines;
  const auto add = [&](const KeyLine& line) {
    if (FindLine(lines, line.key) == nullptr) lines.push_back(line);
  };
  add({"axes", "[x, y, z]", "body forward, right, down in sensor axes"});
  if (FindLine(lines, "noise") == nullptr) {
    lines.push_back({"noise", "", "usual of a consumer's (a guess)"});
    lines.push_back({"  gyro", "0.05 deg/s/sqrt(Hz)"});
    lines.push_back({"  accel", "2 mg/sqrt(Hz)"});
    lines.push_back({"  gyro_bias_walk", "1e-4 deg/s^2/sqrt(Hz)"});
    lines.push_back({"  accel_bias_walk", "10 ug/s/sqrt(Hz)"});
  }
  return lines;
}

std::string AidingText(const RecordingDraft& draft) {
  if (draft.aiding.empty()) {
    return "\n# No aiding was recognised.\naiding: {}\n";
  }
  std::string text = "\naiding:\n";
  for (const StreamDraft& stream : draft.aiding) {
    text += "  " + stream.name + ":\n";
    if (stream.kind->generated) {
      text += "    type: " + std::string(stream.kind->name) + "\n" +
              Render(stream.found.lines, "    ");
      continue;
    }
    text += "    type: " + std::string(stream.kind->name) + "\n" +
            StreamText(stream.found, "    ");
  }
  return text;
}

std::string InComments(const std::string& text) {
  std::string comments;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    comments += "# " + line + "\n";
  }
  return comments;
}

std::string UnusedText(const StreamDraft& stream) {
  std::string text = "\n# Not used: " + stream.found.file;
  if (!stream.found.remarks.empty()) {
    text += ": " + stream.found.remarks.back();
  }
  text += "\n";
  FoundStream plain = stream.found;
  plain.remarks.clear();
  if (stream.name == "truth") {
    return text + InComments("truth:\n" + StreamText(plain, "  "));
  }
  std::string block = stream.name + ":\n";
  if (stream.kind != nullptr) {
    block += "  type: " + std::string(stream.kind->name) + "\n";
  }
  return text + InComments(block + StreamText(plain, "  "));
}

std::string Head(const RecordingDraft& draft) {
  std::string text;
  if (!draft.unknown.empty()) text += "# Not recognised:\n";
  for (const std::string& name : draft.unknown) text += "#   " + name + "\n";
  for (const std::string& copy : draft.copies) {
    text += "# Not used: " + copy + "\n";
  }
  text += "name: " + YamlScalar(draft.name) + "\n";
  text += "folder: " + YamlScalar(draft.folder, YAML::DoubleQuoted) + "\n";
  if (draft.assumptions.empty()) return text;
  text +=
      "\n# What was taken for granted. While a line stands here every result "
      "is\n"
      "# at best doubtful: take away what you know to be so.\nunconfirmed:\n";
  for (const std::string& assumption : draft.assumptions) {
    text += "  - " + YamlScalar(assumption, YAML::DoubleQuoted) + "\n";
  }
  return text;
}

}  // namespace

std::string DraftText(const RecordingDraft& draft) {
  std::string text = Head(draft) + "\n";
  FoundStream imu = *draft.imu;
  imu.lines = UsualImuLines(imu);
  text += "imu:\n" + StreamText(imu, "  ") + AidingText(draft);
  const bool starts = std::any_of(
      draft.top.begin(), draft.top.end(),
      [](const KeyLine& line) { return line.key.starts_with("  "); });
  text += "\n";
  for (const KeyLine& line : draft.top) {
    if (line.key == "initial" && !starts) continue;
    text += Render(line, "");
  }
  if (FindLine(draft.top, "stationary") == nullptr) {
    text +=
        "stationary: off                         "
        "# on: zero velocity and zero rate where the IMU is quiet\n";
  }
  text +=
      "\n# Measurements kept back, to see how well the gaps are bridged:\n"
      "# withhold:\n#   - {sensor: position, every: 120 s, length: 30 s}\n";
  if (draft.truth) text += "\ntruth:\n" + StreamText(*draft.truth, "  ");
  for (const StreamDraft& stream : draft.unused) text += UnusedText(stream);
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
