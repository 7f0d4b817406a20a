#include "app/report_html.h"

#include <fmt/core.h>

#include <algorithm>

#include "io/write/html.h"

namespace hindsight {

HtmlTable::HtmlTable(std::vector<std::string> heading)
    : heading_(std::move(heading)) {}

void HtmlTable::AddRow(std::vector<std::string> cells) {
  rows_.push_back({std::move(cells)});
}

void HtmlTable::AddRow(std::vector<std::string> cells,
                       const std::string& href) {
  rows_.push_back({.cells = std::move(cells), .href = href});
}

void HtmlTable::AddRow(std::vector<std::string> cells, double from, double to) {
  rows_.push_back(
      {std::move(cells),
       fmt::format(" class=\"zooms\" tabindex=\"0\" data-from=\"{:.6f}\" "
                   "data-to=\"{:.6f}\"",
                   from, to)});
}

std::string HtmlTable::Render() const {
  constexpr std::size_t kLongCell = 40;  // letters that want a line of width
  if (rows_.empty()) return "";
  std::vector<bool> used(heading_.size(), false);
  for (const Row& row : rows_) {
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      used[i] = used[i] || !row.cells[i].empty();
    }
  }
  std::string html = "<div class=\"table\"><table><thead><tr>";
  for (std::size_t i = 0; i < heading_.size(); ++i) {
    if (used[i])
      html += "<th scope=\"col\">" + EscapeHtml(heading_[i]) + "</th>";
  }
  html += "</tr></thead><tbody>";
  for (const Row& row : rows_) {
    html += "<tr" + row.attributes + ">";
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      if (!used[i]) continue;
      std::string text = EscapeHtml(row.cells[i]);
      if (i == 0 && !row.href.empty()) {
        text = "<a href=\"" + EscapeHtml(row.href) + "\">" + text + "</a>";
      }
      const bool is_long = row.cells[i].size() > kLongCell;
      html += i == 0    ? "<th scope=\"row\">" + text + "</th>"
              : is_long ? "<td class=\"long\">" + text + "</td>"
                        : "<td>" + text + "</td>";
    }
    html += "</tr>";
  }
  return html + "</tbody></table></div>\n";
}

std::string Absent(const std::string& why) {
  return "<p class=\"absent\">" + EscapeHtml(why) + "</p>\n";
}

std::string Element(const std::string& name, const std::string& text) {
  return "<" + name + ">" + EscapeHtml(text) + "</" + name + ">\n";
}

std::string Render(const BarPicture& p) {
  constexpr double kWidth = 320.0;
  constexpr double kHeight = 120.0;
  const auto y = [&](double value) {
    const double share = (value - p.low) / (p.high - p.low);
    return kHeight * (1.0 - std::clamp(share, 0.0, 1.0));
  };
  std::string html =
      "<figure class=\"bars\"><figcaption><b>" + EscapeHtml(p.title) +
      "</b></figcaption><svg viewBox=\"0 0 320 140\" role=\"img\" "
      "aria-label=\"" +
      EscapeHtml(p.title + ". " + p.summary) + "\">";
  const double step = kWidth / static_cast<double>(p.bars.size());
  const double zero = y(std::max(p.low, 0.0));
  for (std::size_t i = 0; i < p.bars.size(); ++i) {
    const double top = std::min(y(p.bars[i]), zero);
    html += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>",
        static_cast<double>(i) * step + 0.1 * step, top, 0.8 * step,
        std::max(y(p.bars[i]), zero) - top);
  }
  for (const double level : p.levels) {
    html +=
        fmt::format("<path class=\"level\" d=\"M0 {:.1f}H320\"/>", y(level));
  }
  std::string path;
  for (std::size_t i = 0; i < p.curve.size(); ++i) {
    path += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L",
                        kWidth * static_cast<double>(i) /
                            static_cast<double>(p.curve.size() - 1),
                        y(p.curve[i]));
  }
  if (!path.empty()) html += "<path class=\"curve\" d=\"" + path + "\"/>";
  html += fmt::format("<path class=\"axis\" d=\"M0 {:.1f}H320\"/>", zero);
  html += "<text x=\"0\" y=\"136\">" + EscapeHtml(p.left) +
          "</text><text x=\"320\" y=\"136\" text-anchor=\"end\">" +
          EscapeHtml(p.right) + "</text></svg>";
  return html + Element("p", p.summary) + "</figure>\n";
}

}  // namespace hindsight
