#include "io/write/table.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "state/evidence.h"

namespace hindsight {
namespace {

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The heading as rows of the table, aligned at the bottom.
std::vector<std::vector<std::string>> HeadingRows(
    const std::vector<std::string>& heading) {
  std::size_t height = 0;
  for (const std::string& cell : heading) {
    height = std::max(height, Lines(cell).size());
  }
  std::vector<std::vector<std::string>> rows(
      height, std::vector<std::string>(heading.size()));
  for (std::size_t c = 0; c < heading.size(); ++c) {
    const std::vector<std::string> lines = Lines(heading[c]);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      rows[height - lines.size() + i][c] = lines[i];
    }
  }
  return rows;
}

constexpr std::size_t kGap = 2;  // blanks between columns

/// The columns of each of the tables that a narrow terminal takes: those below
/// `keys` in each of them.
std::vector<std::vector<std::size_t>> FoldColumns(
    const std::vector<std::size_t>& columns,
    const std::vector<std::size_t>& width, std::size_t keys, std::size_t most) {
  std::vector<std::size_t> repeated;
  std::size_t least = 0;
  for (const std::size_t c : columns) {
    if (c >= keys) break;
    least += (repeated.empty() ? 0 : kGap) + width[c];
    repeated.push_back(c);
  }
  std::vector<std::vector<std::size_t>> tables = {repeated};
  std::size_t used = least;
  for (std::size_t i = repeated.size(); i < columns.size(); ++i) {
    const std::size_t more = kGap + width[columns[i]];
    if (most > 0 && used + more > most &&
        tables.back().size() > repeated.size()) {
      tables.push_back(repeated);
      used = least;
    }
    tables.back().push_back(columns[i]);
    used += more;
  }
  return tables;
}

/// Some cells of a row.
std::string Line(const std::vector<std::string>& row,
                 const std::vector<std::size_t>& columns,
                 const std::vector<std::size_t>& width,
                 const TableStyle& style) {
  std::string line;
  std::size_t blanks = 0;  // that only more text makes worth writing
  for (const std::size_t c : columns) {
    const bool first = c == 0;
    if (c != columns.front()) blanks += kGap;
    const std::size_t pad = width[c] - row[c].size();
    if (!first) blanks += pad;
    if (!row[c].empty()) {
      line += std::string(blanks, ' ') + PaintGrade(row[c], style);
      blanks = 0;
    }
    if (first) blanks += pad;
  }
  return line + '\n';
}

}  // namespace

ReportTable::ReportTable(std::vector<std::string> heading, std::size_t keys)
    : heading_(std::move(heading)), keys_(keys) {}

void ReportTable::AddRow(std::vector<std::string> cells) {
  if (cells.size() != heading_.size()) {
    throw std::logic_error("a table row must be as wide as the heading");
  }
  rows_.push_back(std::move(cells));
}

std::string PaintGrade(const std::string& grade, const TableStyle& style) {
  if (!style.colour) return grade;
  const char* colour = grade == GradeName(Grade::kUsable)     ? "32"
                       : grade == GradeName(Grade::kDoubtful) ? "33"
                       : grade == GradeName(Grade::kUnusable) ? "31"
                                                              : nullptr;
  if (colour == nullptr) return grade;
  return std::string("\033[") + colour + "m" + grade + "\033[0m";
}

std::string ReportTable::Render(const TableStyle& style) const {
  std::vector<std::vector<std::string>> all = HeadingRows(heading_);
  all.insert(all.end(), rows_.begin(), rows_.end());
  std::vector<std::size_t> width(heading_.size(), 0);
  std::vector<std::size_t> filled;
  for (std::size_t c = 0; c < heading_.size(); ++c) {
    for (const auto& row : all) width[c] = std::max(width[c], row[c].size());
    const bool any =
        std::any_of(rows_.begin(), rows_.end(),
                    [c](const auto& row) { return !row[c].empty(); });
    if (any) filled.push_back(c);
  }
  std::string text;
  for (const std::vector<std::size_t>& columns :
       FoldColumns(filled, width, keys_, style.width)) {
    if (!text.empty()) text += '\n';
    for (const auto& row : all) {
      const std::string line = Line(row, columns, width, style);
      // A line of the heading that none of these columns has.
      if (line != "\n") text += line;
    }
  }
  return text;
}

}  // namespace hindsight
