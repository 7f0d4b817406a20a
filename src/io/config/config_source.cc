#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "base/error.h"
#include "io/config/config_columns.h"
#include "io/config/config_key.h"
#include "io/config/config_streams.h"
#include "io/read/file_formats.h"
#include "io/read/paths.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

/// Of those that are `wanted`.
std::vector<std::string> FormatNames(bool (*wanted)(const FileFormat&)) {
  std::vector<std::string> names;
  for (const FileFormat* format : FileFormats()) {
    if (wanted(*format)) names.emplace_back(format->name);
  }
  return names;
}

KeyEntry* EntryOf(const std::string& name, KeySection* section) {
  return &*std::find_if(section->keys.begin(), section->keys.end(),
                        [&](const KeyEntry& key) { return key.name == name; });
}

/// With what its keys are read by.
struct StreamConfig : StreamSource {
  std::filesystem::path folder;
  const std::vector<FieldName>* fields = nullptr;
};

void ReadFile(ConfigMap* map, StreamConfig* stream) {
  stream->config_line = map->Line("file");
  std::vector<std::string> paths;
  std::vector<std::string> absolute;
  for (const std::string& file : FileNames(map)) {
    paths.push_back((stream->folder / file).lexically_normal().string());
    if (std::count(paths.begin(), paths.end(), paths.back()) > 1) {
      map->Fail("file", paths.back() + " stands twice");
    }
    absolute.push_back(
        std::filesystem::absolute(paths.back()).lexically_normal().string());
  }
  stream->path = paths.front();
  stream->more_paths.assign(paths.begin() + 1, paths.end());
  if (stream->more_paths.empty()) {
    map->Resolve("file", absolute.front());
  } else {
    map->Resolve("file", absolute);
  }
}

void ReadFormat(ConfigMap* map, StreamConfig* stream) {
  TextFormat& format = stream->format;
  format.config_path = map->file();
  format.config_line = map->line();
  const auto all = [](const FileFormat&) { return true; };
  format.kind = FileFormats()[map->Choice("format", FormatNames(all), 0)];
}

void ReadColumnsOf(ConfigMap* map, StreamConfig* stream) {
  const FileFormat& kind = *stream->format.kind;
  if (!kind.takes_columns) {
    if (!map->Has("columns")) return;
    const auto takes = [](const FileFormat& format) {
      return format.takes_columns;
    };
    map->Fail("columns",
              fmt::format("has no use with `format: {}`{}; expected beside it "
                          "`format:` {}",
                          kind.name,
                          map->Has("format") ? "" : ", which is the default",
                          fmt::join(FormatNames(takes), " or ")));
  }
  if (!map->Has("columns")) map->Fail("columns", "is missing");
  stream->format.config_line = map->Line("columns");
  ReadColumns(map, *stream->fields, &stream->format);
}

void ReadDelimiter(ConfigMap* map, StreamConfig* stream) {
  constexpr std::array<char, 5> kDelimiters = {'\0', ',', ';', ' ', '\t'};
  stream->format.delimiter = kDelimiters[map->Choice(
      "delimiter", {"auto", "comma", "semicolon", "blank", "tab"}, 0)];
}

void ReadDecimal(ConfigMap* map, StreamConfig* stream) {
  constexpr std::array<char, 3> kDecimals = {'\0', '.', ','};
  stream->format.decimal =
      kDecimals[map->Choice("decimal", {"auto", "point", "comma"}, 0)];
  if (stream->format.decimal == ',' && stream->format.delimiter == ',') {
    map->Fail("decimal", "a comma does not go with `delimiter: comma`");
  }
}

void ReadRows(ConfigMap* map, StreamConfig* stream) {
  if (!map->Has("rows")) return;
  if (stream->format.kind != &ColumnsFormat()) {
    map->Fail("rows", "is of `format: columns`");
  }
  ConfigMap rows = map->Map("rows");
  stream->format.rows = ReadRowWord(&rows);
  rows.Finish();
}

void ReadBadValues(ConfigMap* map, StreamConfig* stream) {
  if (!map->Has("bad_values")) return;
  if (stream->format.kind != &ColumnsFormat()) {
    map->Fail("bad_values", "is of `format: columns`");
  }
  for (const std::string& text : map->List("bad_values")) {
    const auto number = ParseNumber(text);
    if (!number) map->Fail("bad_values", "'" + text + "' is not a number");
    stream->format.bad_values.push_back(*number);
  }
  stream->absent_values = true;
}

void ReadFormatKeys(ConfigMap* map, StreamConfig* stream) {
  TextFormat& format = stream->format;
  for (const FormatKey& key : format.kind->keys) {
    const std::string name(key.name);
    if (const auto text = map->OptionalText(name)) format.values[name] = *text;
  }
}

const ConfigTable<StreamConfig>& StreamTable() {
  using Key = ConfigKey<StreamConfig>;
  static const ConfigTable<StreamConfig> kTable = {
      "stream",
      "What imu, truth and aiding streams share.",
      {{.name = "file",
        .value = Key::Special{ReadFile},
        .help = "plain or gzip; a folder for oxts and npy; [FILE, FILE2, ...]: "
                "parts of one stream in the order of time",
        .needed = true},
       {.name = "format", .value = Key::Special{ReadFormat}, .fallback = "csv"},
       {.name = "columns",
        .value = Key::Special{ReadColumnsOf},
        .help =
            "QUANTITY: COLUMN [UNIT]; COLUMN is a number from 1 or a title, "
            "of npy and mat ARRAY or ARRAY:NUMBER; a leading \"-\" turns "
            "the sign; or {column, unit, scale}; or {constant: VALUE}, the "
            "same in every row"},
       {.name = "delimiter",
        .value = Key::Special{ReadDelimiter},
        .help = "auto, comma, semicolon, blank (a run of them, tabs too), tab "
                "(one of them, so that nothing may stand between two)",
        .fallback = "auto"},
       {.name = "decimal",
        .value = Key::Special{ReadDecimal},
        .help = "auto, point, comma: between units and tenths, as the first "
                "row has it",
        .fallback = "auto"},
       {.name = "dates",
        .value = Key::Word{{"year_first", "day_first", "month_first"},
                           [](const StreamConfig& stream) {
                             return static_cast<std::size_t>(
                                 stream.format.date_order);
                           },
                           [](StreamConfig& stream, std::size_t word) {
                             stream.format.date_order =
                                 static_cast<DateOrder>(word);
                           }},
        .help = "the order of 07/08/2025; 2025-07-08 and 8.7.2025 need none"},
       {.name = "rows",
        .value = Key::Special{ReadRows},
        .help = "of columns: which lines are the stream's, in a file that "
                "holds several sensors' between each other"},
       {.name = "skip_lines",
        .value = Key::Special{[](ConfigMap* map, StreamConfig* stream) {
          stream->format.skip_lines = map->Integer("skip_lines", 0);
          ReadFormatKeys(map, stream);
        }},
        .help = "lines before the header or data",
        .fallback = "0"},
       {.name = "time",
        .value = Key::Special{[](ConfigMap* map, StreamConfig* stream) {
          stream->clock = ReadClock(map, *stream->format.kind);
        }},
        .help = "how stamps become time"},
       {.name = "on_duplicate",
        .value = Key::Word{{"error", "drop_first", "drop_last"},
                           [](const StreamConfig& stream) {
                             return static_cast<std::size_t>(
                                 stream.on_duplicate);
                           },
                           [](StreamConfig& stream, std::size_t word) {
                             stream.on_duplicate =
                                 static_cast<DuplicatePolicy>(word);
                           }}},
       {.name = "on_unordered",
        .value = Key::Word{{"error", "sort"},
                           [](const StreamConfig& stream) {
                             return std::size_t{stream.sort ? 1U : 0U};
                           },
                           [](StreamConfig& stream, std::size_t word) {
                             stream.sort = word == 1;
                           }}},
       {.name = "absent_values",
        .value = Key::Flag{&StreamConfig::absent_values},
        .help = "empty and NaN values are absent: truth keeps the rest of the "
                "row, aiding passes over it"},
       {.name = "bad_values",
        .value = Key::Special{ReadBadValues},
        .help = "of columns: numbers that stand for no reading, as the file "
                "has them: [-32.768, -999]; they are absent"},
       {.name = "allow_truncated_tail",
        .value = Key::Flag{&StreamConfig::allow_truncated_tail},
        .help = "drop a last line that was cut off: without line end, and "
                "incomplete or with a last value shorter than any before"},
       {.name = "on_text",
        .value = Key::Word{{"error", "drop"},
                           [](const StreamConfig& stream) {
                             return std::size_t{stream.drop_text ? 1U : 0U};
                           },
                           [](StreamConfig& stream, std::size_t word) {
                             stream.drop_text = word == 1;
                           }},
        .help = "rows of text, or of another number of columns, between those "
                "of numbers: repeated titles, notes"}}};
  return kTable;
}

}  // namespace

std::vector<std::string> FileNames(ConfigMap* map) {
  constexpr const char* kExpected = "expected a file, or a list of files";
  if (map->IsMap("file")) {
    map->Fail("file", std::string("is a map; ") + kExpected);
  }
  const bool one = !map->Has("file") || map->IsScalar("file");
  std::vector<std::string> names =
      one ? std::vector{map->Text("file")} : map->List("file");
  if (names.empty()) map->Fail("file", kExpected);
  for (const std::string& name : names) {
    if (name.empty()) map->Fail("file", std::string("is empty; ") + kExpected);
  }
  return names;
}

StreamSource ReadStreamSource(ConfigMap* map,
                              const std::filesystem::path& folder,
                              const std::vector<FieldName>& fields) {
  StreamConfig stream;
  stream.folder = folder;
  stream.fields = &fields;
  stream.name = map->name();
  stream.config_path = map->file();
  ReadTable(StreamTable(), map, &stream);
  return stream;
}

std::vector<KeySection> StreamSections() {
  KeySection stream = Documented(StreamTable());
  EntryOf("format", &stream)->meaning =
      MeaningOf(FormatNames([](const FileFormat&) { return true; }), "");
  KeyEntry* columns = EntryOf("columns", &stream);
  columns->meaning =
      "of " + MeaningOf(FormatNames([](const FileFormat& format) {
                          return format.takes_columns;
                        }),
                        columns->meaning);
  for (const FileFormat* format : FileFormats()) {
    for (const FormatKey& key : format->keys) {
      stream.keys.push_back({std::string(key.name), std::string(key.help),
                             std::string(key.fallback),
                             "format: " + std::string(format->name)});
    }
  }
  KeySection time = TimeSection();
  EntryOf("clock", &time)->fallback =
      "dataset; of " + MeaningOf(FormatNames([](const FileFormat& format) {
                                   return format.counts_from_1970;
                                 }),
                                 "unix");
  return {stream, RowsSection(), time};
}

std::vector<FormatEntry> FormatEntries() {
  std::vector<FormatEntry> entries;
  for (const FileFormat* format : FileFormats()) {
    entries.push_back({std::string(format->name), std::string(format->help),
                       std::string(format->streams), format->recognised()});
  }
  return entries;
}

}  // namespace hindsight
