#ifndef HINDSIGHT_IO_READ_TIME_LIST_H_
#define HINDSIGHT_IO_READ_TIME_LIST_H_

#include <string>
#include <vector>

namespace hindsight {

/// Times [s] from a text or gzip file, one a line; empty lines, lines that
/// start with '#' and a header line "t[s]" are skipped. Throws InputError
/// "file:line: ..." for a line that is no finite number, a time that does not
/// increase, and a file without times.
std::vector<double> ReadTimeList(const std::string& path);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_TIME_LIST_H_
