#include <algorithm>
#include <array>

#include "base/error.h"
#include "io/config/config_columns.h"
#include "io/config/config_key.h"
#include "io/config/config_streams.h"
#include "io/read/file_format.h"
#include "io/read/paths.h"

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

void ReadStart(ConfigMap* time, ClockMap* clock) {
  const auto text = time->OptionalText("start");
  if (!text) return;
  clock->start_date = ParseDateTime(*text);
  if (clock->start_date) return;
  if (text->find("GPST") != text->npos || text->find("UTC") != text->npos) {
    time->Fail("start", "'" + *text +
                            "' is not a date; expected yyyy-mm-dd hh:mm:ss.sss "
                            "GPST or UTC");
  }
  clock->start = time->Number("start", Quantity::kTime);
}

void ReadSpan(ConfigMap* time, ClockMap* clock) {
  if (const auto from = time->OptionalNumber("from", Quantity::kTime)) {
    clock->from = *from;
  }
  if (const auto until = time->OptionalNumber("until", Quantity::kTime)) {
    clock->until = *until;
  }
  if (!(clock->until > clock->from)) {
    time->Fail("until", "must lie behind from");
  }
}

/// With what decides its defaults.
struct ClockConfig : ClockMap {
  bool counts_from_1970 = false;
};

void ReadStretch(ConfigMap* time, ClockConfig* clock) {
  const std::string stretch = time->Text("stretch", "1");
  const auto factor = ParseNumber(stretch);
  if (!factor || !(*factor > 0.0)) {
    time->Fail("stretch", "'" + stretch + "' is not a positive number");
  }
  clock->stretch = *factor;
}

const ConfigTable<ClockConfig>& TimeTable() {
  using Key = ConfigKey<ClockConfig>;
  static const ConfigTable<ClockConfig> kTable = {
      "time",
      "Of a stream.",
      {{.name = "clock",
        .value = Key::Special{[](ConfigMap* time, ClockConfig* clock) {
          clock->scale = static_cast<ClockMap::Scale>(
              time->Choice("clock", {"dataset", "gps", "unix"},
                           clock->counts_from_1970 ? 2 : 0));
        }},
        .help = "dataset, gps, unix: what stamps count from"},
       {.name = "week",
        .value = Key::Special{[](ConfigMap* time, ClockConfig* clock) {
          if (!time->Has("week")) return;
          clock->week = time->Integer("week", 0);
          if (*clock->week > kLastWeek) time->Fail("week", "is no GPS week");
        }},
        .help = "stamps are seconds of this GPS week, and may run over its "
                "end"},
       {.name = "start",
        .value = Key::Special{[](ConfigMap* time, ClockConfig* clock) {
          ReadStart(time, clock);
        }},
        .help = "first row is at this date or time; the rest follows"},
       {.name = "duration",
        .quantity = Quantity::kTime,
        .value =
            Key::OptionalNumber{&ClockConfig::duration, KeyRange::kPositive},
        .help = "last row is this much later; stamps in between are stretched"},
       {.name = "rate",
        .quantity = Quantity::kFrequency,
        .value = Key::OptionalNumber{&ClockConfig::rate, KeyRange::kPositive},
        .help = "stamps are row number / rate"},
       {.name = "stretch",
        .value = Key::Special{ReadStretch},
        .help = "factor on the time since the first row",
        .fallback = "1"},
       {.name = "week_rollovers",
        .value = Key::Special{[](ConfigMap* time, ClockConfig* clock) {
          clock->week_rollovers = time->Integer("week_rollovers", 0);
          if (clock->week_rollovers > 10) {
            time->Fail("week_rollovers", "is too many; expected 1 or 2");
          }
        }},
        .help = "times 1024 weeks that dates lack",
        .fallback = "0"},
       {.name = "from",
        .value = Key::Special{[](ConfigMap* time, ClockConfig* clock) {
          ReadSpan(time, clock);
        }},
        .help = "only rows this much behind the first are used"},
       {.name = "until", .value = Key::Special{}, .help = "the same"}}};
  return kTable;
}

ClockMap ReadClock(ConfigMap* map, const FileFormat& format) {
  ClockConfig clock;
  clock.counts_from_1970 = format.counts_from_1970;
  ConfigMap time = map->Map("time");
  ReadTable(TimeTable(), &time, &clock);
  if (clock.week && clock.scale != ClockMap::Scale::kDataset) {
    time.Fail("week", "does not go with clock");
  }
  time.Finish();
  return clock;
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
    if (!PathExists(paths.back())) {
      map->Fail("file", "there is no file " + paths.back());
    }
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
  if (!stream->format.kind->takes_columns) return;
  if (!map->Has("columns")) map->Fail("columns", "is missing");
  stream->format.config_line = map->Line("columns");
  ReadColumns(map, *stream->fields, &stream->format);
}

void ReadDelimiter(ConfigMap* map, StreamConfig* stream) {
  constexpr std::array<char, 4> kDelimiters = {'\0', ',', ';', ' '};
  stream->format.delimiter = kDelimiters[map->Choice(
      "delimiter", {"auto", "comma", "semicolon", "blank"}, 0)];
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
        .help = "auto, comma, semicolon, blank",
        .fallback = "auto"},
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
  KeySection time = Documented(TimeTable());
  EntryOf("format", &stream)->meaning =
      MeaningOf(FormatNames([](const FileFormat&) { return true; }), "");
  KeyEntry* columns = EntryOf("columns", &stream);
  columns->meaning =
      "of " + MeaningOf(FormatNames([](const FileFormat& format) {
                          return format.takes_columns;
                        }),
                        columns->meaning);
  EntryOf("clock", &time)->fallback =
      "dataset; of " + MeaningOf(FormatNames([](const FileFormat& format) {
                                   return format.counts_from_1970;
                                 }),
                                 "unix");
  for (const FileFormat* format : FileFormats()) {
    for (const FormatKey& key : format->keys) {
      stream.keys.push_back({std::string(key.name), std::string(key.help),
                             std::string(key.fallback),
                             "format: " + std::string(format->name)});
    }
  }
  return {stream, time};
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
