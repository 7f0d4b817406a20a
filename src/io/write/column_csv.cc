#include "io/write/column_csv.h"

#include <cmath>
#include <utility>

#include "io/write/number_format.h"

namespace hindsight {

namespace {

/// What AppendValue appends; returns where the next character goes.
char* PutField(const SolutionColumn& column, double value, char* to) {
  if (std::isnan(value)) return to;
  if (column.digits == 0) return PutShortest(value, to);
  if (column.digits < 0) return PutGeneral(value, -column.digits, to);
  return PutFixed(value, column.digits, to);
}

}  // namespace

void AppendValue(const SolutionColumn& column, double value, std::string* out) {
  char buffer[kLongestNumber];
  out->append(buffer, PutField(column, value, buffer));
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
  // As a rule for the whole line.
  constexpr std::ptrdiff_t kRoom = 4096;
  char buffer[kRoom];
  char* to = buffer;
  Eigen::Index i = 0;
  for (const SolutionColumn& column : columns_) {
    if (kRoom - (to - buffer) < std::ptrdiff_t{kLongestNumber} + 2) {
      out->append(buffer, to);
      to = buffer;
    }
    if (i > 0) *to++ = ',';
    to = PutField(column, rows(k, i++), to);
  }
  *to++ = '\n';
  out->append(buffer, to);
}

void ColumnCsv::Commit() { file_.Commit(); }

}  // namespace hindsight
