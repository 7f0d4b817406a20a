#include "io/write/column_csv.h"

#include <cmath>
#include <utility>

#include "io/write/number_format.h"

namespace hindsight {

void AppendValue(const SolutionColumn& column, double value, std::string* out) {
  if (std::isnan(value)) return;
  if (column.digits == 0) {
    AppendShortest(value, out);
  } else if (column.digits < 0) {
    AppendGeneral(value, -column.digits, out);
  } else {
    AppendFixed(value, column.digits, out);
  }
}

ColumnCsv::ColumnCsv(const std::string& path, const std::string& comments,
                     std::vector<SolutionColumn> columns)
    : file_(path), columns_(std::move(columns)) {
  std::string titles;
  for (const SolutionColumn& column : columns_) {
    titles += (titles.empty() ? "" : ",") + column.Heading();
  }
  file_.Write(comments + titles + "\n");
}

void ColumnCsv::Append(const Eigen::MatrixXd& rows) {
  std::string line;
  for (Eigen::Index k = 0; k < rows.rows(); ++k) {
    line.clear();
    Eigen::Index i = 0;
    for (const SolutionColumn& column : columns_) {
      if (i > 0) line += ',';
      AppendValue(column, rows(k, i++), &line);
    }
    line += '\n';
    file_.Write(line);
  }
}

void ColumnCsv::Commit() { file_.Commit(); }

}  // namespace hindsight
