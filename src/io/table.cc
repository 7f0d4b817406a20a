#include "io/table.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <utility>

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

}  // namespace

ReportTable::ReportTable(std::vector<std::string> heading)
    : heading_(std::move(heading)) {}

void ReportTable::AddRow(std::vector<std::string> cells) {
  if (cells.size() != heading_.size()) {
    throw std::logic_error("a table row must be as wide as the heading");
  }
  rows_.push_back(std::move(cells));
}

std::string ReportTable::Render() const {
  std::vector<std::vector<std::string>> all = HeadingRows(heading_);
  all.insert(all.end(), rows_.begin(), rows_.end());
  std::vector<std::size_t> width(heading_.size(), 0);
  std::vector<bool> filled(heading_.size(), false);
  for (std::size_t c = 0; c < heading_.size(); ++c) {
    for (const auto& row : all) width[c] = std::max(width[c], row[c].size());
    for (const auto& row : rows_) filled[c] = filled[c] || !row[c].empty();
  }
  std::string text;
  for (const auto& row : all) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (!filled[c]) continue;
      const std::string pad(width[c] - row[c].size(), ' ');
      if (!line.empty()) line += "  ";
      line += c == 0 ? row[c] + pad : pad + row[c];
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

}  // namespace hindsight
