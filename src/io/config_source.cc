#include <array>
#include <charconv>

#include "base/error.h"
#include "io/config_streams.h"
#include "io/paths.h"

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
  if (const std::string near = NearestWord(name, names); !near.empty()) {
    expected = "perhaps '" + near + "'";
  } else {
    for (const std::string& known : names) {
      expected += (expected.empty() ? "one of " : ", ") + known;
    }
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
  if (name == "week") return mapping;
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

std::vector<ColumnMapping> ReadColumns(ConfigMap* map,
                                       const std::vector<FieldName>& fields) {
  std::vector<ColumnMapping> mappings;
  ConfigMap columns = map->Map("columns");
  for (const std::string& name : columns.Keys()) {
    const Quantity quantity = QuantityOf(&columns, name, fields);
    const ColumnMapping mapping = ReadColumn(&columns, name, quantity);
    mappings.insert(name == "week" ? mappings.begin() : mappings.end(),
                    mapping);
  }
  return mappings;
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

ClockMap ReadClock(ConfigMap* map, TextFormat::Kind format) {
  ClockMap clock;
  ConfigMap time = map->Map("time");
  clock.scale = static_cast<ClockMap::Scale>(time.Choice(
      "clock", {"dataset", "gps", "unix"}, CountsFrom1970(format) ? 2 : 0));
  if (time.Has("week")) {
    clock.week = time.Integer("week", 0);
    if (*clock.week > kLastWeek) time.Fail("week", "is no GPS week");
  }
  ReadStart(&time, &clock);
  clock.duration = time.OptionalNumber("duration", Quantity::kTime);
  clock.rate = time.OptionalNumber("rate", Quantity::kFrequency);
  if (clock.duration && !(*clock.duration > 0.0)) {
    time.Fail("duration", "must be greater than zero");
  }
  if (clock.rate && !(*clock.rate > 0.0)) {
    time.Fail("rate", "must be greater than zero");
  }
  const std::string stretch = time.Text("stretch", "1");
  const auto factor = ParseNumber(stretch);
  if (!factor || !(*factor > 0.0)) {
    time.Fail("stretch", "'" + stretch + "' is not a positive number");
  }
  clock.stretch = *factor;
  clock.week_rollovers = time.Integer("week_rollovers", 0);
  if (clock.week_rollovers > 10) {
    time.Fail("week_rollovers", "is too many; expected 1 or 2");
  }
  ReadSpan(&time, &clock);
  if (clock.week && clock.scale != ClockMap::Scale::kDataset) {
    time.Fail("week", "does not go with clock");
  }
  time.Finish();
  return clock;
}

}  // namespace

StreamSource ReadStreamSource(ConfigMap* map,
                              const std::filesystem::path& folder,
                              const std::vector<FieldName>& fields) {
  StreamSource source;
  source.name = map->name();
  source.config_path = map->file();
  const std::string file = map->Text("file");
  source.path = (folder / file).lexically_normal().string();
  source.config_line = map->Line("file");
  if (!PathExists(source.path)) {
    map->Fail("file", "there is no file " + source.path);
  }
  map->Resolve(
      "file",
      std::filesystem::absolute(source.path).lexically_normal().string());
  TextFormat& format = source.format;
  format.config_path = map->file();
  format.config_line = map->line();
  format.kind =
      static_cast<TextFormat::Kind>(map->Choice("format", FormatNames(), 0));
  if (TakesColumns(format.kind)) {
    if (!map->Has("columns")) map->Fail("columns", "is missing");
    format.config_line = map->Line("columns");
    format.columns = ReadColumns(map, fields);
  }
  constexpr std::array<char, 4> kDelimiters = {'\0', ',', ';', ' '};
  format.delimiter = kDelimiters[map->Choice(
      "delimiter", {"auto", "comma", "semicolon", "blank"}, 0)];
  format.skip_lines = map->Integer("skip_lines", 0);
  if (format.kind == TextFormat::Kind::kRosbag) {
    format.topic = map->OptionalText("topic").value_or("");
  }
  source.clock = ReadClock(map, format.kind);
  source.on_duplicate = static_cast<DuplicatePolicy>(
      map->Choice("on_duplicate", {"error", "drop_first", "drop_last"}, 0));
  source.sort = map->Choice("on_unordered", {"error", "sort"}, 0) == 1;
  source.absent_values = map->Flag("absent_values", false);
  source.allow_truncated_tail = map->Flag("allow_truncated_tail", false);
  return source;
}

}  // namespace hindsight
