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
  file_.WriteLines(static_cast<std::size_t>(rows.rows()),
                   [&](std::size_t k, std::string* line) {
                     AppendLine(rows, static_cast<Eigen::Index>(k), line);
                   });
}

void ColumnCsv::Append(const Eigen::MatrixXd& rows,
                       const std::vector<bool>& some, ColumnCsv* other) {
  const AtomicFile::Copy copy = {&other->file_,
                                 [&some](std::size_t k) { return some[k]; }};
  file_.WriteLines(
      static_cast<std::size_t>(rows.rows()),
      [&](std::size_t k, std::string* line) {
        AppendLine(rows, static_cast<Eigen::Index>(k), line);
      },
      &copy);
}

void ColumnCsv::AppendLine(const Eigen::MatrixXd& rows, Eigen::Index k,
                           std::string* out) const {
  Eigen::Index i = 0;
  for (const SolutionColumn& column : columns_) {
    if (i > 0) *out += ',';
    AppendValue(column, rows(k, i++), out);
  }
  *out += '\n';
}

void ColumnCsv::Commit() { file_.Commit(); }

}  // namespace hindsight
