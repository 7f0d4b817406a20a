#ifndef HINDSIGHT_IO_WRITE_CSV_LINE_H_
#define HINDSIGHT_IO_WRITE_CSV_LINE_H_

#include <string>
#include <vector>

namespace hindsight {

/// A line of a CSV with its end. A field that holds a comma, a quote, a line
/// feed or '#', which begins comments, is quoted, its quotes doubled (RFC 4180).
std::string CsvLine(const std::vector<std::string>& fields);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_CSV_LINE_H_
