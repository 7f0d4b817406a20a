#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "io/read/column_gatherer.h"
#include "io/read/file_columns.h"
#include "io/read/row_word.h"
#include "io/read/text_lines.h"
#include "io/read/text_tokens.h"
#include "io/read/title_words.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

/// Lines by which the column of the words is told.
constexpr std::size_t kTypedLines = 4000;
/// Columns in which it may be.
constexpr int kWordColumns = 4;
/// Loggers of whole autopilots write some eighty.
constexpr std::size_t kMostWords = 200;

bool IsName(std::string_view word) {
  constexpr std::size_t kLongest = 40;
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  };
  return !word.empty() && word.size() <= kLongest && is_letter(word[0]) &&
         !IsAbsentWord(word) && !ParseNumber(word);
}

/// Which sensor a word names, or -1.
int SensorOf(const std::string& word) {
  const std::vector<std::string> words = SplitWords(word);
  if (HasAnyWord(words, {"imu"})) return 0;
  if (HasAnyWord(words, {"gyro", "gyros", "gyr", "gyroscope"})) return 1;
  if (HasAnyWord(words, {"acc", "acce", "accel", "accelerometer"})) return 2;
  if (HasAnyWord(words, {"gps", "gnss", "fix", "location"})) return 3;
  return HasAnyWord(words, {"mag", "magn", "magnetometer"}) ? 4 : -1;
}

/// How many columns the rows of each word have, and how many of them.
using Widths = std::map<std::string, std::map<std::size_t, std::size_t>>;

/// Whether words tell apart rows of several sensors: rows of other widths, the
/// same for each word, or names of sensors.
bool TellSensors(const Widths& widths, int column) {
  constexpr std::size_t kFewest = 3;
  constexpr double kMost = 0.95;
  std::set<std::size_t> usual;
  std::set<int> sensors;
  std::size_t frequent = 0;
  bool steady = true;
  for (const auto& [word, counts] : widths) {
    std::size_t rows = 0;
    std::pair<std::size_t, std::size_t> best = {0, 0};  // rows, width
    for (const auto& [width, of_width] : counts) {
      rows += of_width;
      best = std::max(best, {of_width, width});
    }
    if (rows < kFewest) continue;
    ++frequent;
    usual.insert(best.second);
    steady = steady && static_cast<double>(best.first) >=
                           kMost * static_cast<double>(rows);
    if (const int sensor = SensorOf(word); sensor >= 0) sensors.insert(sensor);
  }
  const bool differ = column == 0 && steady && usual.size() > 1;
  return frequent > 1 && (differ || sensors.size() > 1);
}

struct TypedText {
  int column = 0;
  char delimiter = ',';
};

/// Nothing of a text whose rows are one sensor's.
std::optional<TypedText> FindWords(const std::string& path) {
  TextLines lines(path);
  std::array<Widths, kWordColumns> widths;
  std::array<std::size_t, kWordColumns> named = {};
  std::size_t rows = 0;
  std::optional<char> delimiter;
  std::string_view line;
  while (rows < kTypedLines && lines.Next(&line)) {
    if (IsComment(line)) continue;
    if (!delimiter) delimiter = GuessDelimiter(line);
    if (HoldsNoNumber(line, *delimiter)) continue;
    ++rows;
    const auto words = SplitLine(line, *delimiter);
    for (std::size_t i = 0; i < std::min(widths.size(), words.size()); ++i) {
      if (!IsName(words[i]) || widths[i].size() > kMostWords) continue;
      ++named[i];
      ++widths[i][std::string(words[i])][words.size()];
    }
  }
  for (std::size_t i = 0; i < widths.size(); ++i) {
    const int column = static_cast<int>(i);
    // A last line may be cut off.
    if (rows < 10 || 20 * named[i] < 19 * rows ||
        widths[i].size() > kMostWords || !TellSensors(widths[i], column)) {
      continue;
    }
    return TypedText{column, *delimiter};
  }
  return std::nullopt;
}

/// Three numbers behind the time are axes, or of a receiver none.
void TitleBySensor(int sensor, FileColumns* table) {
  std::vector<FileColumn*> numbers;
  for (FileColumn& column : table->columns) {
    if (column.holds == FileColumn::Holds::kNumbers) numbers.push_back(&column);
  }
  if (numbers.size() != 4) return;
  constexpr std::array kAxes = {"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i) {
    std::string& title = numbers[i + 1]->title;
    if (sensor == 3 && title == kAxes[i]) {
      title.clear();
    } else if (sensor > 0 && sensor != 3 && title.empty()) {
      title = kAxes[i];
    }
  }
}

/// The column that counts devices of a kind ("I" of ArduPilot's logs), or -1.
int DeviceColumn(std::string_view title, char delimiter) {
  const auto titles = SplitLine(title, delimiter);
  const auto counts =
      std::find_if(titles.begin(), titles.end(), [](std::string_view word) {
        return word == "I" || word == "instance" || word == "Instance";
      });
  return counts == titles.end() ? -1
                                : static_cast<int>(counts - titles.begin());
}

/// There are but few of a kind.
bool IsDeviceCount(std::string_view word) {
  return word.size() == 1 && word[0] >= '0' && word[0] <= '9';
}

class TypedColumns {
 public:
  explicit TypedColumns(const TypedText& text) : text_(text) {}

  void Add(std::string_view line, bool terminated) {
    if (IsComment(line)) {
      const std::size_t at = line.find_first_not_of("#%/ ");
      if (at == line.npos) return;
      const std::string word(WordAt(line.substr(at), text_.delimiter, 0));
      titles_[word] = line;
      return;
    }
    if (!begun_ && HoldsNoNumber(line, text_.delimiter)) {
      common_title_ = line;
      return;
    }
    begun_ = true;
    const std::string word(WordAt(line, text_.delimiter, text_.column));
    if (word == "FMT") {
      TakeFormat(line);
    } else if (ColumnGatherer* gatherer = GathererOf(RowsOf(word, line))) {
      gatherer->Add(line, terminated);
    }
  }

  std::vector<FileColumns> Finish() {
    std::vector<FileColumns> tables;
    for (auto& [rows, gatherer] : gatherers_) {
      auto table = gatherer.Finish();
      if (!table) continue;
      if (CountDevices(rows.word) == 1) {
        table->row_word = {text_.column, rows.word};
      }
      TitleBySensor(SensorOf(rows.word), &*table);
      tables.push_back(std::move(*table));
    }
    return tables;
  }

 private:
  /// ArduPilot's logs tell the columns of a message by another: FMT, number,
  /// length, name, types, columns.
  void TakeFormat(std::string_view line) {
    constexpr std::size_t kName = 3;
    constexpr std::size_t kFirst = 5;
    const auto words = SplitLine(line, text_.delimiter);
    if (words.size() <= kFirst) return;
    const std::string name(words[kName]);
    std::string title = "#" + name;
    for (std::size_t i = kFirst; i < words.size(); ++i) {
      title.append(1, text_.delimiter).append(words[i]);
    }
    titles_[name] = title;
  }

  /// "" if rows of the word have none.
  const std::string& TitleOf(const std::string& word) const {
    const auto title = titles_.find(word);
    return title != titles_.end() ? title->second : common_title_;
  }

  RowWord RowsOf(const std::string& word, std::string_view line) {
    RowWord rows = {text_.column, word};
    const auto [known, is_new] = device_columns_.try_emplace(word, -1);
    if (is_new) known->second = DeviceColumn(TitleOf(word), text_.delimiter);
    if (known->second < 0) return rows;
    rows.device = WordAt(line, text_.delimiter, known->second);
    if (!IsDeviceCount(rows.device)) {
      known->second = -1;
      return {text_.column, word};
    }
    rows.device_column = known->second;
    return rows;
  }

  long CountDevices(const std::string& word) const {
    return std::count_if(
        gatherers_.begin(), gatherers_.end(),
        [&](const auto& gatherer) { return gatherer.first.word == word; });
  }

  ColumnGatherer* GathererOf(const RowWord& rows) {
    const auto known = std::find_if(
        gatherers_.begin(), gatherers_.end(),
        [&](const auto& gatherer) { return gatherer.first == rows; });
    if (known != gatherers_.end()) {
      return known->second.wants_more() ? &known->second : nullptr;
    }
    if (!IsName(rows.word) || gatherers_.size() == kMostWords) return nullptr;
    ColumnGatherer& gatherer =
        gatherers_.emplace_back(rows, ColumnGatherer(rows)).second;
    const std::string& title = TitleOf(rows.word);
    if (!title.empty()) gatherer.Add(title, true);
    return &gatherer;
  }

  TypedText text_;
  bool begun_ = false;
  std::string common_title_;
  std::map<std::string, std::string> titles_;  ///< by word
  std::map<std::string, int> device_columns_;  ///< by word; -1: none
  std::vector<std::pair<RowWord, ColumnGatherer>> gatherers_;
};

}  // namespace

std::vector<FileColumns> ReadTypedColumns(const std::string& path) {
  const auto text = FindWords(path);
  if (!text) return {};
  TextLines lines(path);
  TypedColumns tables(*text);
  std::string_view line;
  while (lines.Next(&line)) tables.Add(line, lines.terminated());
  return tables.Finish();
}

std::vector<FileColumns> ReadTextTables(const std::string& path) {
  std::vector<FileColumns> tables = ReadTypedColumns(path);
  if (!tables.empty()) return tables;
  if (auto table = ReadTextColumns(path)) tables.push_back(std::move(*table));
  return tables;
}

}  // namespace hindsight
