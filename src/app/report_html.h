#ifndef HINDSIGHT_APP_REPORT_HTML_H_
#define HINDSIGHT_APP_REPORT_HTML_H_

#include <string>
#include <vector>

namespace hindsight {

/// A table of a page. Text is escaped; the first column is a heading of its
/// row. A column whose cells are all empty is left out.
class HtmlTable {
 public:
  explicit HtmlTable(std::vector<std::string> heading);

  /// A row as wide as the heading.
  void AddRow(std::vector<std::string> cells);
  /// The same; clicking it zooms everything to [from, to] [s].
  void AddRow(std::vector<std::string> cells, double from, double to);

  /// The same; its heading leads to the address `href`.
  void AddRow(std::vector<std::string> cells, const std::string& href);

  bool empty() const { return rows_.empty(); }
  /// "" without rows.
  std::string Render() const;

 private:
  struct Row {
    std::vector<std::string> cells;
    std::string attributes = {};
    std::string href = {};
  };
  std::vector<std::string> heading_;
  std::vector<Row> rows_;
};

/// <p class="absent">: why a panel is left out.
std::string Absent(const std::string& why);

/// An element with escaped text.
std::string Element(const std::string& name, const std::string& text);

/// Bars about their expectation as a small picture (SVG) with a text beside.
struct BarPicture {
  std::string title;
  std::string summary;
  std::vector<double> bars;    ///< from left to right
  std::vector<double> curve;   ///< points over the same width; empty: none
  std::vector<double> levels;  ///< dashed lines
  double low = 0.0;            ///< of the vertical axis
  double high = 1.0;
  std::string left;   ///< label of the horizontal axis' left end
  std::string right;  ///< of its right end
};
std::string Render(const BarPicture& picture);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_REPORT_HTML_H_
