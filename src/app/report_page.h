#ifndef HINDSIGHT_APP_REPORT_PAGE_H_
#define HINDSIGHT_APP_REPORT_PAGE_H_

#include <filesystem>
#include <string>
#include <vector>

#include "app/report_source.h"

namespace hindsight {

/// Name of the page in a folder of results.
inline constexpr char kReportName[] = "report.html";

/// The page that shows results side by side, the first being the reference: one
/// file without references to any other. Throws InputError if a folder holds no
/// results, or files that cannot be read.
std::string ReportPage(const std::vector<ReportPlace>& places);

/// The same of one solution that was compared with a truth.
std::string ReportPage(EvaluatedSolution evaluated);

/// A page of the same looks that holds `body`, which is HTML, and no charts.
std::string StaticPage(const std::string& title, const std::string& body);

/// Whether the file begins as these pages do. Throws InputError if it cannot be
/// read.
bool IsReportPage(const std::string& path);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_REPORT_PAGE_H_
