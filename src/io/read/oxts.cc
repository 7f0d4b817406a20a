#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <map>

#include "base/error.h"
#include "base/units.h"
#include "io/read/date_text.h"
#include "io/read/file_formats.h"
#include "io/read/open_text.h"
#include "io/read/paths.h"
#include "io/read/text_lines.h"
#include "io/read/text_tokens.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kValues = 30;

/// value = offset + factor * column.
struct Source {
  const char* field;
  std::size_t column;
  double factor = 1.0;
  double offset = 0.0;
};

constexpr std::array kSources = {
    Source{"lat", 0, kDegree},
    Source{"lon", 1, kDegree},
    Source{"h", 2},
    Source{"roll", 3},
    Source{"pitch", 4, -1.0},
    Source{"heading", 5, -1.0, 0.5 * kPi},
    Source{"v_n", 6},
    Source{"v_e", 7},
    Source{"v_d", 10, -1.0},
    Source{"accel_x", 11},
    Source{"accel_y", 12, -1.0},
    Source{"accel_z", 13, -1.0},
    Source{"gyro_x", 17},
    Source{"gyro_y", 18, -1.0},
    Source{"gyro_z", 19, -1.0},
    Source{"sigma_n", 23},
    Source{"sigma_e", 23},
    Source{"sigma_d", 23},
    Source{"sigma_h", 23},
    Source{"sigma_v_n", 24},
    Source{"sigma_v_e", 24},
    Source{"sigma_v_d", 24},
    Source{"speed", 8},
};

using FileMap = std::map<long, fs::path>;

/// The lines of timestamps.txt that are not empty.
class StampLines {
 public:
  explicit StampLines(const std::string& path) : lines_(path) {}

  /// Advances to the next stamp; false at the end.
  bool Next(Stamp* stamp) {
    std::string_view line;
    do {
      if (!lines_.Next(&line)) return false;
    } while (Trim(line).empty());
    if (!lines_.terminated() && line.size() < shortest_ &&
        shortest_ != std::string::npos) {
      throw InputError(lines_.path(), number(),
                       "the last line is truncated: it is shorter than all "
                       "before, and no line end follows");
    }
    shortest_ = std::min(shortest_, line.size());
    const auto parsed = ParseDateTime(std::string(line) + " UTC");
    if (!parsed) {
      throw InputError(lines_.path(), number(),
                       "'" + std::string(Trim(line)) +
                           "' is not a time; expected yyyy-mm-dd "
                           "hh:mm:ss.sssssssss");
    }
    *stamp = *parsed;
    return true;
  }

  /// Of the line of the stamp last returned, from 1.
  long number() const { return lines_.number(); }

 private:
  TextLines lines_;
  std::size_t shortest_ = std::string::npos;
};

/// The files of data/ by the number that is their name.
FileMap EpochFiles(const fs::path& data) {
  constexpr long kLast = 999'999'999;
  FileMap files;
  for (const fs::path& entry : FolderEntries(data)) {
    if (entry.extension() != ".txt") continue;
    const std::string name = entry.stem().string();
    long number = -1;
    const char* end = name.data() + name.size();
    const auto result = std::from_chars(name.data(), end, number);
    if (result.ec != std::errc() || result.ptr != end || number < 0 ||
        number > kLast || !files.emplace(number, entry).second) {
      throw InputError(entry.string(), 0,
                       "is no epoch; expected the name 0000000000.txt and on, "
                       "each number once");
    }
  }
  return files;
}

/// The next of the files must be that of the next stamp.
void CheckEpoch(const std::string& stamps_path, long number,
                FileMap::const_iterator file, const FileMap& files) {
  const bool exists = file != files.end();
  if (exists && file->first < number) {
    throw InputError(
        stamps_path, file->first + 1,
        "there is no stamp for data/" + file->second.filename().string());
  }
  if (exists && file->first == number) return;
  throw InputError(stamps_path, number + 1,
                   "there is no file data/" +
                       fmt::format("{:010}.txt", number) + " for this stamp");
}

std::array<double, kValues> ReadEpoch(const std::string& path) {
  TextLines lines(path);
  std::string_view line;
  lines.Next(&line);
  const std::string first(line);
  while (lines.Next(&line)) {
    if (Trim(line).empty()) continue;
    throw InputError(path, lines.number(),
                     "a second line; expected the values of one epoch");
  }
  const std::vector<std::string_view> tokens = SplitLine(first, ' ');
  if (tokens.size() != kValues) {
    throw InputError(path, 1,
                     "found " + std::to_string(tokens.size()) +
                         " values, expected " + std::to_string(kValues));
  }
  std::array<double, kValues> values;
  for (std::size_t i = 0; i < kValues; ++i) {
    const auto number = ParseNumber(tokens[i]);
    if (!number) {
      throw InputError(path, 1,
                       "value " + std::to_string(i + 1) + ": '" +
                           std::string(tokens[i]) + "' is not a finite number");
    }
    values[i] = *number;
  }
  return values;
}

RowBuffer ReadOxtsFolder(const std::string& folder,
                         const std::vector<FieldName>& fields) {
  const fs::path data = fs::path(folder) / "data";
  if (!IsFolder(data)) {
    throw InputError(folder, 0,
                     "is no OXTS folder; expected timestamps.txt and data/");
  }
  const FileMap files = EpochFiles(data);
  const std::string stamps_path =
      (fs::path(folder) / "timestamps.txt").string();
  StampLines lines(stamps_path);
  const bool position = FieldIndex(fields, "sigma_n").has_value();
  RowBuffer rows(folder, fields, false);
  rows.Declare("quality");
  rows.Declare("satellites");
  for (const Source& source : kSources) rows.Declare(source.field);
  long missing = 0;
  long epoch = 0;
  auto file = files.begin();
  for (Stamp stamp; lines.Next(&stamp); ++epoch) {
    const long number = lines.number() - 1;
    CheckEpoch(stamps_path, number, file, files);
    missing += number - epoch;
    epoch = number;
    const std::string path = (file++)->second.string();
    const std::array<double, kValues> values = ReadEpoch(path);
    rows.Append(stamp, 1, path);
    for (const Source& source : kSources) {
      rows.Set(source.field,
               source.offset + source.factor * values[source.column]);
    }
    rows.Set("satellites", values[26]);
    rows.Set("quality", values[position ? 27 : 28]);
  }
  if (file != files.end()) {
    throw InputError(
        stamps_path, 0,
        "holds no stamp for data/" + file->second.filename().string());
  }
  if (rows.size() == 0) throw InputError(folder, 0, "holds no epochs");
  rows.LeaveOut("missing epoch", missing);
  return rows;
}

std::optional<FoundStream> RecogniseOxts(const fs::path& path) {
  if (!IsFolder(path) || !PathExists(path / "timestamps.txt") ||
      !PathExists(path / "data")) {
    return std::nullopt;
  }
  FoundStream found = FoundAiding({&PositionKind(), &VelocityKind()});
  found.imu = found.truth = true;
  return found;
}

}  // namespace

const FileFormat& OxtsFormat() {
  static const FileFormat kFormat = {
      .name = "oxts",
      .help = "KITTI `oxts` folder",
      .streams = "imu, position, velocity, odometer, truth",
      .whole_recordings = true,
      .open =
          [](const TableRequest& request) {
            return OpenBuffer(ReadOxtsFolder(request.path, request.fields),
                              true);
          },
      .recognise_name = RecogniseOxts};
  return kFormat;
}

}  // namespace hindsight
