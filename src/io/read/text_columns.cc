#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "io/read/file_columns.h"
#include "io/read/file_formats.h"
#include "io/read/text_layout.h"
#include "io/read/text_tokens.h"
#include "io/read/units.h"

namespace hindsight {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kFewestRows = 3;
/// Lines by which the shape of the table is told.
constexpr std::size_t kShapeLines = 60;

/// The numbers of a line; nothing if a word of it is none. A word that is
/// missing is NaN.
bool ParseRow(std::string_view line, char delimiter,
              std::vector<double>* values) {
  values->clear();
  bool any = false;
  for (const std::string_view token : SplitLine(line, delimiter)) {
    const auto number = ParseNumber(token);
    const bool absent = token.empty() || token == "nan" || token == "NaN";
    if (!number && !absent) return false;
    any = any || number;
    values->push_back(number.value_or(kMissing));
  }
  return any;
}

struct Shape {
  char delimiter = ',';
  std::size_t columns = 0;
};

/// What most of the first lines that are numbers look like.
std::optional<Shape> FindShape(const std::vector<std::string>& lines) {
  std::map<std::pair<char, std::size_t>, std::size_t> count;
  std::vector<double> values;
  for (const std::string& line : lines) {
    if (IsComment(line)) continue;
    const char delimiter = GuessDelimiter(line);
    if (ParseRow(line, delimiter, &values)) ++count[{delimiter, values.size()}];
  }
  std::optional<Shape> shape;
  std::size_t most = kFewestRows - 1;
  for (const auto& [form, lines_of] : count) {
    if (lines_of <= most) continue;
    most = lines_of;
    shape = Shape{form.first, form.second};
  }
  return shape;
}

class TextColumns {
 public:
  explicit TextColumns(const std::string& path) : lines_(path) {}

  std::optional<FileColumns> Read() {
    std::vector<std::string> first;
    std::string_view line;
    while (first.size() < kShapeLines && lines_.Next(&line)) {
      first.emplace_back(line);
    }
    const auto shape = FindShape(first);
    if (!shape) return std::nullopt;
    shape_ = *shape;
    found_.format = &ColumnsFormat();
    found_.columns.resize(shape_.columns);
    for (const std::string& early : first) Take(early, true);
    while (found_.complete && lines_.Next(&line)) {
      Take(line, lines_.terminated());
    }
    if (found_.rows < kFewestRows) return std::nullopt;
    Finish();
    return std::move(found_);
  }

 private:
  void Take(std::string_view line, bool terminated) {
    ++number_;
    if (IsComment(line)) {
      if (found_.rows == 0 && !Trim(line).empty()) {
        comment_ = line.substr(line.find_first_of("#%") + 1);
      }
      return;
    }
    const bool numbers = ParseRow(line, shape_.delimiter, &values_);
    if (!numbers || values_.size() != shape_.columns) {
      if (found_.rows == 0) {
        title_ = line;
        ++early_;
      } else if (terminated) {
        ++found_.text_rows;
      } else {
        found_.cut_tail = true;
      }
      return;
    }
    if (found_.rows == 0) found_.skip_lines = number_ - 1;
    for (std::size_t i = 0; i < values_.size(); ++i) {
      found_.columns[i].values.push_back(values_[i]);
    }
    ++found_.rows;
    found_.complete = found_.rows * shape_.columns < kMostProbedNumbers;
  }

  void Finish() {
    NameColumns();
    SkipZeroRows();
    if (early_ > 0 && !titled_) {
      found_.remarks.emplace_back(
          "the lines before the first whole row of numbers are passed over");
    }
    if (found_.cut_tail) {
      found_.remarks.emplace_back("the last line is cut off and left out");
    }
    if (found_.text_rows > 0) {
      found_.remarks.push_back(
          std::to_string(found_.text_rows) +
          " rows further down are no rows of numbers (notes, repeated titles) "
          "and left out");
    }
  }

  /// By the line before the numbers, if it has as many words, or one less than
  /// the rows, whose last word is then empty.
  void NameColumns() {
    for (std::size_t i = 0; i < found_.columns.size(); ++i) {
      found_.columns[i].reference = std::to_string(i + 1);
    }
    for (const std::string& text : {title_, comment_}) {
      const auto titles = SplitLine(text, shape_.delimiter);
      std::vector<double> none;
      if (titles.size() + 1 < shape_.columns ||
          titles.size() > shape_.columns + 1 ||
          ParseRow(text, shape_.delimiter, &none)) {
        continue;
      }
      titled_ = true;
      for (std::size_t i = 0; i < std::min(titles.size(), shape_.columns);
           ++i) {
        found_.columns[i].title = Trim(titles[i]);
      }
      return;
    }
  }

  /// Rows at the start in which every column that is not zero later is zero,
  /// but for those that count.
  void SkipZeroRows() {
    constexpr std::size_t kMost = 10;
    std::vector<const std::vector<double>*> sensed;
    for (const FileColumn& column : found_.columns) {
      const auto& v = column.values;
      const bool counts = std::is_sorted(v.begin(), v.end());
      const auto zeros = std::count(v.begin(), v.end(), 0.0);
      if (!counts && static_cast<std::size_t>(zeros) < v.size() / 10) {
        sensed.push_back(&v);
      }
    }
    std::size_t rows = 0;
    while (rows < std::min(kMost, found_.rows / 2) && sensed.size() >= 3 &&
           std::count_if(sensed.begin(), sensed.end(),
                         [&](const auto* v) { return (*v)[rows] == 0.0; }) >=
               static_cast<std::ptrdiff_t>(
                   std::min<std::size_t>(sensed.size(), 6))) {
      ++rows;
    }
    if (rows == 0) return;
    for (FileColumn& column : found_.columns) {
      column.values.erase(
          column.values.begin(),
          column.values.begin() + static_cast<std::ptrdiff_t>(rows));
    }
    found_.rows -= rows;
    found_.skip_lines += static_cast<int>(rows);
    found_.remarks.push_back("the first " + std::to_string(rows) +
                             (rows == 1 ? " row holds" : " rows hold") +
                             " zeros alone and is left out");
  }

  TextLines lines_;
  Shape shape_;
  FileColumns found_;
  std::vector<double> values_;
  std::string title_;
  std::string comment_;
  bool titled_ = false;
  int number_ = 0;
  int early_ = 0;
};

}  // namespace

std::optional<FileColumns> ReadTextColumns(const std::string& path) {
  return TextColumns(path).Read();
}

}  // namespace hindsight
