#ifndef HINDSIGHT_IO_READ_CSV_RECORDS_H_
#define HINDSIGHT_IO_READ_CSV_RECORDS_H_

#include <string>
#include <vector>

namespace hindsight {

/// A line of a table of words.
struct CsvRecord {
  long line = 0;  ///< of the file, from 1
  std::vector<std::string> fields;
};

/// The records of a CSV as spreadsheets write it: fields between commas, blanks
/// about them trimmed, or within quotes, "" for a quote, which then may hold
/// commas and line feeds. Empty lines and those that begin with '#' are left
/// out. Throws InputError for a quote that is not closed and for a record that
/// is not as wide as the first.
std::vector<CsvRecord> ReadCsvRecords(const std::string& path);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_CSV_RECORDS_H_
