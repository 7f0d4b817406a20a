#include "io/oxts.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>

#include "base/error.h"
#include "base/units.h"
#include "io/paths.h"
#include "io/text_lines.h"
#include "io/text_table.h"

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

/// One a line; nothing for an empty line, which stands for an epoch that is
/// missing.
std::vector<std::optional<Stamp>> ReadStamps(const std::string& path) {
  TextLines lines(path);
  std::vector<std::optional<Stamp>> stamps;
  std::size_t used = 0;
  std::size_t shortest = std::string::npos;
  std::string_view line;
  while (lines.Next(&line)) {
    stamps.emplace_back();
    if (Trim(line).empty()) continue;
    if (!lines.terminated() && line.size() < shortest && used > 0) {
      throw InputError(path, lines.number(),
                       "the last line is truncated: it is shorter than all "
                       "before, and no line end follows");
    }
    shortest = std::min(shortest, line.size());
    stamps.back() = ParseDateTime(std::string(line) + " UTC");
    if (!stamps.back()) {
      throw InputError(path, lines.number(),
                       "'" + std::string(Trim(line)) +
                           "' is not a time; expected yyyy-mm-dd "
                           "hh:mm:ss.sssssssss");
    }
    used = stamps.size();
  }
  stamps.resize(used);
  return stamps;
}

/// The files of data/ by the number that is their name.
std::map<long, fs::path> EpochFiles(const fs::path& data) {
  constexpr long kLast = 999'999'999;
  std::map<long, fs::path> files;
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

}  // namespace

RowBuffer ReadOxts(const std::string& folder,
                   const std::vector<FieldName>& fields) {
  const fs::path data = fs::path(folder) / "data";
  if (!IsFolder(data)) {
    throw InputError(folder, 0,
                     "is no OXTS folder; expected timestamps.txt and data/");
  }
  const std::map<long, fs::path> files = EpochFiles(data);
  const std::string stamps_path =
      (fs::path(folder) / "timestamps.txt").string();
  const std::vector<std::optional<Stamp>> stamps = ReadStamps(stamps_path);
  const bool position = FieldIndex(fields, "sigma_n").has_value();
  RowBuffer rows(folder, fields, false);
  rows.Declare("quality");
  for (const Source& source : kSources) rows.Declare(source.field);
  const bool gaps =
      std::find(stamps.begin(), stamps.end(), std::nullopt) != stamps.end();
  // A part of a drive may be cut out, with its stamps.
  long number = gaps || files.empty() ? 0 : files.begin()->first;
  auto file = files.begin();
  long missing = 0;
  for (std::size_t i = 0; i < stamps.size(); ++i, ++number) {
    const auto line = static_cast<long>(i) + 1;
    const bool exists = file != files.end() && file->first == number;
    if (exists != stamps[i].has_value()) {
      char name[32];
      std::snprintf(name, sizeof(name), "%010ld.txt", number);
      throw InputError(stamps_path, line,
                       exists ? "there is no stamp for data/" +
                                    file->second.filename().string()
                              : "there is no file data/" + std::string(name) +
                                    " for this stamp");
    }
    if (!exists) {
      ++missing;
      continue;
    }
    const std::string path = (file++)->second.string();
    const std::array<double, kValues> values = ReadEpoch(path);
    rows.Append(*stamps[i], 1, path);
    for (const Source& source : kSources) {
      rows.Set(source.field,
               source.offset + source.factor * values[source.column]);
    }
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

}  // namespace hindsight
