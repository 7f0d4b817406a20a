#ifndef HINDSIGHT_APP_REPORT_LINES_H_
#define HINDSIGHT_APP_REPORT_LINES_H_

#include <map>
#include <string>
#include <vector>

#include "app/report_panels.h"

namespace hindsight {

/// A column that is shown of every solution.
struct ShownQuantity {
  const char* column;
  const char* title;
  const char* unit;
};

/// Lines of all solutions, the recommended one as a broad ground.
std::vector<ChartLine> LinesOf(const ReportContext& context,
                               const std::string& column);

/// Figures side by side; the reason where there are none.
std::string Grid(const std::string& figures, const std::string& why_none);

/// Residuals by fate, in units ("used", "rejected", "withheld") and over sigma
/// ("used_over", ...), "sigma", and "weight" where one is not 1.
ReportSeries ResidualTable(const ResidualSeries& residuals);

/// Every row of the recommended solution, number 0, and of short ones.
ReportDetail DetailOf(const ReportSolution& solution, std::size_t number);

/// Drops what is drawn of the recommended solution alone, as ellipses and
/// bands, or of the others at some rows alone.
void EraseWhatOnlyTheFirstShows(
    std::map<std::string, std::vector<double>>* columns);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_REPORT_LINES_H_
