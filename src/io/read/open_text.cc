#include "io/read/open_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "io/read/text_layout.h"
#include "io/read/text_tokens.h"

namespace hindsight {
namespace {

bool NextData(TextLines* lines, const RowWord& rows, char delimiter,
              std::string* line) {
  std::string_view view;
  while (lines->Next(&view)) {
    if (IsComment(view) || !rows.IsIn(view, delimiter)) continue;
    *line = view;
    return true;
  }
  return false;
}

/// Whether the stamp, a date and a time of day, stands in two columns of `row`:
/// where blanks separate columns, and date and time as well.
bool SplitsDate(const std::string& row, const TableLayout& layout) {
  if (layout.clock != TableLayout::Clock::kIso &&
      layout.clock != TableLayout::Clock::kIsoUtc) {
    return false;
  }
  const auto tokens = SplitLine(row, layout.delimiter);
  const auto at = static_cast<std::size_t>(layout.time_column);
  return at + 1 < tokens.size() &&
         ParseDate(tokens[at], "00:00:00", false, layout.date_order) &&
         tokens[at + 1].find(':') != std::string_view::npos;
}

/// A title that stands above both counts as one, and what stands right of it is
/// a column further on.
void SplitDate(const std::string& row, TableLayout* layout) {
  layout->clock = layout->clock == TableLayout::Clock::kIsoUtc
                      ? TableLayout::Clock::kDateUtc
                      : TableLayout::Clock::kDate;
  const auto columns =
      static_cast<int>(SplitLine(row, layout->delimiter).size());
  if (layout->column_count == 0 || columns != layout->column_count + 1) return;
  layout->column_count = columns;
  for (TableLayout::Field& field : layout->fields) {
    if (field.column > layout->time_column) ++field.column;
  }
}

[[noreturn]] void FailWithoutSuch(const TableRequest& request) {
  const RowWord& rows = request.format.rows;
  if (rows.column < 0) FailWithoutRows(request.path);
  std::string what =
      fmt::format("the file holds no rows that have '{}' in column {}",
                  rows.word, rows.column + 1);
  if (rows.device_column >= 0) {
    what += fmt::format(" and '{}' in column {}", rows.device,
                        rows.device_column + 1);
  }
  throw InputError(request.path, 0, what);
}

/// `titled`: the columns are those of the header line that name a quantity.
OpenedTable OpenDelimited(const TableRequest& request,
                          std::vector<ColumnMapping> columns, bool titled) {
  OpenedTable opened = OpenLines(request);
  const bool has_header = titled || std::any_of(columns.begin(), columns.end(),
                                                [](const ColumnMapping& c) {
                                                  return c.column < 0;
                                                });
  std::string row;
  char delimiter = request.format.delimiter;
  const RowWord& rows = request.format.rows;
  // The titles of all rows stand above them.
  const RowWord all;
  if (!NextData(opened.lines.get(), has_header ? all : rows, delimiter, &row)) {
    FailWithoutSuch(request);
  }
  if (delimiter == '\0') {
    delimiter = GuessDelimiter(row);
    if (delimiter == request.format.decimal) delimiter = ' ';
  }
  TableHeader header;
  std::string header_text;
  if (has_header) {
    header_text.swap(row);
    header = {SplitLine(header_text, delimiter), opened.lines->number()};
    if (titled) columns = TitledColumns(request.path, header, request.fields);
    if (!NextData(opened.lines.get(), rows, delimiter, &row)) {
      FailWithoutSuch(request);
    }
  }
  TableLayout layout = BuildLayout(request.path, request.format, request.fields,
                                   columns, header);
  layout.delimiter = delimiter;
  layout.rows = rows;
  layout.bad_values = request.format.bad_values;
  layout.date_order = request.format.date_order;
  layout.decimal = request.format.decimal != '\0'
                       ? request.format.decimal
                       : GuessDecimal(row, delimiter);
  const bool split = SplitsDate(row, layout);
  if (has_header) layout.column_count = static_cast<int>(header.titles.size());
  if (split) SplitDate(row, &layout);
  opened.dated = layout.clock == TableLayout::Clock::kWeek ||
                 layout.clock == TableLayout::Clock::kIso ||
                 layout.clock == TableLayout::Clock::kIsoUtc ||
                 layout.clock == TableLayout::Clock::kDays ||
                 layout.clock == TableLayout::Clock::kDate ||
                 layout.clock == TableLayout::Clock::kDateUtc;
  opened.table = std::make_unique<TextTable>(
      opened.lines.get(), std::move(layout), request.options, std::move(row));
  return opened;
}

}  // namespace

ColumnMapping ColumnAt(int number, const std::string& quantity,
                       const char* unit) {
  ColumnMapping mapping;
  mapping.quantity = quantity;
  mapping.column = number - 1;
  mapping.unit = unit;
  return mapping;
}

void AppendVector(int number, const std::string& stem, const char* unit,
                  std::vector<ColumnMapping>* columns) {
  for (const char* axis : {"_x", "_y", "_z"}) {
    columns->push_back(ColumnAt(number++, stem + axis, unit));
  }
}

OpenedTable OpenLines(const TableRequest& request) {
  OpenedTable opened;
  opened.lines =
      std::make_unique<TextLines>(request.path, request.options.digests);
  std::string_view skipped;
  for (int i = 0; i < request.format.skip_lines; ++i) {
    if (!opened.lines->Next(&skipped)) FailWithoutRows(request.path);
  }
  return opened;
}

OpenedTable OpenColumns(const TableRequest& request,
                        const std::vector<ColumnMapping>& columns) {
  if (columns.empty()) {
    throw InputError(request.format.config_path, request.format.config_line,
                     "the format " + std::string(request.format.kind->name) +
                         " holds no such stream");
  }
  return OpenDelimited(request, columns, false);
}

OpenedTable OpenTitled(const TableRequest& request) {
  return OpenDelimited(request, {}, true);
}

OpenedTable OpenBuffer(RowBuffer rows, bool dated) {
  OpenedTable opened;
  opened.table = std::make_unique<RowBuffer>(std::move(rows));
  opened.dated = dated;
  return opened;
}

std::vector<double> NumbersOf(const std::string& line) {
  std::vector<double> numbers;
  for (const std::string_view token : SplitLine(line, ' ')) {
    const auto number = ParseNumber(token);
    if (!number) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

void FailWithoutRows(const std::string& path) {
  throw InputError(path, 0, "the file holds no rows of data");
}

}  // namespace hindsight
