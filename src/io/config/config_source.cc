#include <array>
#include <charconv>

#include "base/error.h"
#include "io/config/config_key.h"
#include "io/config/config_streams.h"
#include "io/read/paths.h"

namespace hindsight {
namespace {

Quantity QuantityOf(ConfigMap* columns, const std::string& name,
                    const std::vector<FieldName>& fields) {
  if (name == "t") return Quantity::kTime;
  if (name == "week") return Quantity::kRatio;
  std::vector<std::string> names = {"t", "week"};
  for (const FieldName& field : fields) {
    if (name == field.name) return field.quantity;
    names.emplace_back(field.name);
  }
  std::string expected;
  for (const std::string& known : names) {
    expected += (expected.empty() ? "one of " : ", ") + known;
  }
  if (const std::string near = NearestWord(name, names); !near.empty()) {
    expected = "perhaps '" + near + "', or " + expected;
  }
  columns->Fail(name, "is not a quantity of this stream; expected " + expected);
}

/// Of a file.
constexpr int kMostColumns = 100000;

/// A column is a number from 1, or else a title; false for a number beyond the
/// last column that there can be.
bool SetColumn(const std::string& text, ColumnMapping* mapping) {
  int number = 0;
  const auto result =
      std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = result.ptr == text.data() + text.size() && !text.empty();
  if (whole && result.ec == std::errc::result_out_of_range) return false;
  if (whole && result.ec == std::errc() && number >= 1) {
    mapping->column = number - 1;
  } else {
    mapping->title = text;
  }
  return number <= kMostColumns;
}

std::string TooManyColumns() {
  return "expected a column of 1 to " + std::to_string(kMostColumns);
}

ColumnMapping ReadColumn(ConfigMap* columns, const std::string& name,
                         Quantity quantity) {
  ColumnMapping mapping;
  mapping.quantity = name;
  if (columns->IsMap(name)) {
    ConfigMap entry = columns->Map(name);
    if (!SetColumn(entry.Text("column"), &mapping)) {
      entry.Fail("column", TooManyColumns());
    }
    mapping.unit = entry.Text("unit", "");
    const std::string scale = entry.Text("scale", "1");
    const auto number = ParseNumber(scale);
    if (!number || *number == 0.0) {
      entry.Fail("scale", "'" + scale + "' is not a number other than zero");
    }
    mapping.scale = *number;
    entry.Finish();
  } else {
    auto [title, unit] = SplitTitle(columns->Text(name));
    if (title.starts_with('-')) {
      mapping.scale = -1.0;
      title.erase(0, 1);
    }
    if (!SetColumn(title, &mapping)) columns->Fail(name, TooManyColumns());
    mapping.unit = unit;
  }
  // Dates, whose unit is their scale.
  const bool date =
      name == "t" && (mapping.unit == "UTC" || mapping.unit == "GPST");
  if (name == "week" || date) return mapping;
  if (mapping.unit.empty() && mapping.column >= 0) {
    columns->Fail(name, std::string("has no unit; expected COLUMN [UNIT] with "
                                    "one of ") +
                            UnitExamples(quantity));
  } else if (!mapping.unit.empty() && !UnitFactor(mapping.unit, quantity)) {
    columns->Fail(name, "has the unit '" + mapping.unit +
                            "'; expected one of " + UnitExamples(quantity));
  }
  return mapping;
}

/// `{constant: VALUE}` in place of a column; nothing if it is a column.
std::optional<ConstantColumn> ReadConstant(
    ConfigMap* columns, const std::string& name, Quantity quantity,
    const std::vector<FieldName>& fields) {
  if (!columns->IsMap(name)) return std::nullopt;
  ConfigMap entry = columns->Map(name);
  if (!entry.Has("constant")) return std::nullopt;
  if (name == "t" || name == "week") {
    entry.Fail("constant", "time does not stand still; expected a column");
  }
  if (&fields == &ImuFields()) {
    entry.Fail("constant",
               "what every row repeats is no inertial reading; expected a "
               "column");
  }
  for (const char* key : {"column", "unit", "scale"}) {
    if (entry.Has(key))
      entry.Fail("constant", std::string("does not go with ") + key);
  }
  const ConstantColumn constant = {name, entry.Number("constant", quantity)};
  entry.Finish();
  return constant;
}

void ReadColumns(ConfigMap* map, const std::vector<FieldName>& fields,
                 TextFormat* format) {
  std::vector<ColumnMapping>& mappings = format->columns;
  ConfigMap columns = map->Map("columns");
  for (const std::string& name : columns.Keys()) {
    const Quantity quantity = QuantityOf(&columns, name, fields);
    if (const auto constant = ReadConstant(&columns, name, quantity, fields)) {
      format->constants.push_back(*constant);
      continue;
    }
    const ColumnMapping mapping = ReadColumn(&columns, name, quantity);
    mappings.insert(name == "week" ? mappings.begin() : mappings.end(),
                    mapping);
  }
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

/// These formats count from 1970 unless the configuration says otherwise.
bool CountsFrom1970(TextFormat::Kind format) {
  return format == TextFormat::Kind::kEuroc ||
         format == TextFormat::Kind::kNclt;
}

/// With what decides its defaults.
struct ClockConfig : ClockMap {
  TextFormat::Kind format = TextFormat::Kind::kCsv;
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
                           CountsFrom1970(clock->format) ? 2 : 0));
        }},
        .help = "dataset, gps, unix: what stamps count from",
        .fallback = "dataset; unix for euroc and nclt"},
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

ClockMap ReadClock(ConfigMap* map, TextFormat::Kind format) {
  ClockConfig clock;
  clock.format = format;
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
  const std::string file = map->Text("file");
  stream->path = (stream->folder / file).lexically_normal().string();
  stream->config_line = map->Line("file");
  if (!PathExists(stream->path)) {
    map->Fail("file", "there is no file " + stream->path);
  }
  map->Resolve(
      "file",
      std::filesystem::absolute(stream->path).lexically_normal().string());
}

void ReadFormat(ConfigMap* map, StreamConfig* stream) {
  TextFormat& format = stream->format;
  format.config_path = map->file();
  format.config_line = map->line();
  format.kind =
      static_cast<TextFormat::Kind>(map->Choice("format", FormatNames(), 0));
}

void ReadColumnsOf(ConfigMap* map, StreamConfig* stream) {
  if (!TakesColumns(stream->format.kind)) return;
  if (!map->Has("columns")) map->Fail("columns", "is missing");
  stream->format.config_line = map->Line("columns");
  ReadColumns(map, *stream->fields, &stream->format);
}

void ReadDelimiter(ConfigMap* map, StreamConfig* stream) {
  constexpr std::array<char, 4> kDelimiters = {'\0', ',', ';', ' '};
  stream->format.delimiter = kDelimiters[map->Choice(
      "delimiter", {"auto", "comma", "semicolon", "blank"}, 0)];
}

const std::string& FormatHelp() {
  static const std::string kHelp = MeaningOf(FormatNames(), "");
  return kHelp;
}

const ConfigTable<StreamConfig>& StreamTable() {
  using Key = ConfigKey<StreamConfig>;
  static const ConfigTable<StreamConfig> kTable = {
      "stream",
      "What imu, truth and aiding streams share.",
      {{.name = "file",
        .value = Key::Special{ReadFile},
        .help = "plain or gzip; a folder for oxts and npy",
        .needed = true},
       {.name = "format",
        .value = Key::Special{ReadFormat},
        .help = FormatHelp(),
        .fallback = "csv"},
       {.name = "columns",
        .value = Key::Special{ReadColumnsOf},
        .help =
            "of columns, npy, mat: QUANTITY: COLUMN [UNIT]; COLUMN is a number "
            "from 1 or a title, of npy and mat ARRAY or ARRAY:NUMBER; a "
            "leading \"-\" turns the sign; or {column, unit, scale}; or "
            "{constant: VALUE}, the same in every row"},
       {.name = "delimiter",
        .value = Key::Special{ReadDelimiter},
        .help = "auto, comma, semicolon, blank",
        .fallback = "auto"},
       {.name = "skip_lines",
        .value = Key::Special{[](ConfigMap* map, StreamConfig* stream) {
          stream->format.skip_lines = map->Integer("skip_lines", 0);
        }},
        .help = "lines before the header or data",
        .fallback = "0"},
       {.name = "topic",
        .value = Key::Special{[](ConfigMap* map, StreamConfig* stream) {
          if (stream->format.kind != TextFormat::Kind::kRosbag) return;
          stream->format.topic = map->OptionalText("topic").value_or("");
        }},
        .help = "of a rosbag",
        .fallback = "the only one that fits"},
       {.name = "time",
        .value = Key::Special{[](ConfigMap* map, StreamConfig* stream) {
          stream->clock = ReadClock(map, stream->format.kind);
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
  return {Documented(StreamTable()), Documented(TimeTable())};
}

}  // namespace hindsight
