#ifndef HINDSIGHT_APP_LIST_FLAGS_H_
#define HINDSIGHT_APP_LIST_FLAGS_H_

#include <string>
#include <vector>

#include "app/command.h"

namespace hindsight {

/// "--FLAG=VALUE: what".
UsageError BadFlag(const std::string& flag, const std::string& value,
                   const std::string& what);

/// Whether `text` is a number that no double holds, such as 1e400.
bool IsOutOfRange(const std::string& text);

/// The words between the commas in the value of --`flag`; none if it is empty.
/// Throws UsageError for an empty word and for one that stands there twice.
std::vector<std::string> ReadWords(const std::string& flag,
                                   const std::string& value);

/// Numbers above zero, at least one and none twice, separated by commas in the
/// value of --`flag`. Throws UsageError.
std::vector<double> ReadPositiveNumbers(const std::string& flag,
                                        const std::string& value);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_LIST_FLAGS_H_
