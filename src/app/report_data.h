#ifndef HINDSIGHT_APP_REPORT_DATA_H_
#define HINDSIGHT_APP_REPORT_DATA_H_

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace hindsight {

/// How much of a table a page carries.
enum class ReportDetail {
  kFull,      ///< extremes to draw first, and every row, deflated
  kExtremes,  ///< extremes alone, where there are more rows than these
  kSome       ///< every so many rows to draw first, and every row, deflated
};

/// Columns over a common time, of equal length.
struct ReportSeries {
  std::vector<double> t;  ///< [s]
  std::map<std::string, std::vector<double>> columns;
  ReportDetail detail = ReportDetail::kFull;
};

/// One line of a chart.
struct ChartLine {
  int table = 0;
  std::string column = {};
  std::string label = {};
  int group = -1;       ///< solution that switches it on and off; -1: none
  int colour = 0;       ///< of the page's palette; -1: grey
  double factor = 1.0;  ///< the column is multiplied by it
  /// Column of the same table about which it stands; empty: zero.
  std::string centre = {};
  std::string style = "line";  ///< "line", "points", "dash"
  /// Column with the standard deviation of the row: those far above the usual
  /// one do not count for the chart's range. Empty: all rows count.
  std::string spread = {};
};

/// One chart: what is drawn over time, in one unit.
struct Chart {
  std::string title = {};
  std::string unit = {};
  std::string note = {};  ///< how to read it, a sentence
  std::vector<ChartLine> lines = {};
  std::vector<double> levels = {};  ///< horizontal lines
  bool logarithmic = false;
  /// Lines are differences from the solution that the reader chooses.
  bool difference = false;
};

/// The series of a page and the charts that show them.
class ReportData {
 public:
  /// Its number. Columns without a finite value are dropped.
  int Add(ReportSeries table);
  const ReportSeries& table(int number) const {
    return tables_[static_cast<std::size_t>(number)];
  }
  bool Has(int table, const std::string& column) const;

  /// The figure that shows a chart, as HTML: title, place, summary and table of
  /// figures. Lines whose column is not there are left out; "" if none is left.
  std::string Figure(Chart chart);

  /// {"tables": [...], "charts": [...]} without the rows that are deflated.
  nlohmann::ordered_json Json() const;
  /// Elements that hold the deflated rows.
  std::string Blobs() const;

 private:
  std::vector<ReportSeries> tables_;
  std::vector<Chart> charts_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_APP_REPORT_DATA_H_
