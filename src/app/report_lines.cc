#include "app/report_lines.h"

#include "app/report_html.h"

namespace hindsight {

std::vector<ChartLine> LinesOf(const ReportContext& context,
                               const std::string& column) {
  std::vector<ChartLine> lines;
  for (std::size_t i = 0; i < context.solutions.size(); ++i) {
    const ReportSolution& solution = context.solutions[i];
    const int number = static_cast<int>(i);
    lines.push_back({.table = solution.table,
                     .column = column,
                     .label = solution.label,
                     .group = number,
                     .colour = number});
  }
  return lines;
}

std::string Grid(const std::string& figures, const std::string& why_none) {
  if (figures.empty()) return Absent(why_none);
  return "<div class=\"grid\">" + figures + "</div>\n";
}

ReportDetail DetailOf(const ReportSolution& solution, std::size_t number) {
  constexpr std::size_t kShort = 6000;  // rows
  return number == 0 || solution.t().size() <= kShort ? ReportDetail::kFull
                                                      : ReportDetail::kExtremes;
}

void EraseWhatOnlyTheFirstShows(
    std::map<std::string, std::vector<double>>* columns) {
  for (const char* name : {"cov_ne", "sd_n", "sd_e", "sd_v_n", "sd_v_e",
                           "sd_roll", "sd_pitch", "v_n", "v_e"}) {
    columns->erase(name);
  }
  std::erase_if(*columns, [](const auto& column) {
    const std::string& name = column.first;
    return name.starts_with("sd_b") ||
           (name.starts_with("sd_") && name.ends_with("]"));
  });
}

}  // namespace hindsight
