#include "io/oxts.h"

#include <array>
#include <filesystem>

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

std::vector<Stamp> ReadStamps(const std::string& path) {
  TextLines lines(path);
  std::vector<Stamp> stamps;
  std::string_view line;
  while (lines.Next(&line)) {
    if (Trim(line).empty()) continue;
    const auto stamp = ParseDateTime(std::string(line) + " UTC");
    if (!stamp) {
      throw InputError(path, lines.number(),
                       "'" + std::string(Trim(line)) +
                           "' is not a time; expected yyyy-mm-dd "
                           "hh:mm:ss.sssssssss");
    }
    stamps.push_back(*stamp);
  }
  return stamps;
}

std::array<double, kValues> ReadEpoch(const std::string& path) {
  TextLines lines(path);
  std::string_view line;
  lines.Next(&line);
  const std::vector<std::string_view> tokens = SplitLine(line, ' ');
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
  std::vector<fs::path> files;
  for (const fs::path& entry : FolderEntries(data)) {
    if (entry.extension() == ".txt") files.push_back(entry);
  }
  const std::string stamps_path =
      (fs::path(folder) / "timestamps.txt").string();
  const std::vector<Stamp> stamps = ReadStamps(stamps_path);
  if (stamps.size() != files.size()) {
    throw InputError(stamps_path, 0,
                     "holds " + std::to_string(stamps.size()) + " stamps for " +
                         std::to_string(files.size()) +
                         " files in data/; expected one each");
  }
  const bool position = FieldIndex(fields, "sigma_n").has_value();
  RowBuffer rows(folder, fields, false);
  rows.Declare("quality");
  for (const Source& source : kSources) rows.Declare(source.field);
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::array<double, kValues> values = ReadEpoch(files[i].string());
    rows.Append(stamps[i], 1, files[i].string());
    for (const Source& source : kSources) {
      rows.Set(source.field,
               source.offset + source.factor * values[source.column]);
    }
    rows.Set("quality", values[position ? 27 : 28]);
  }
  return rows;
}

}  // namespace hindsight
