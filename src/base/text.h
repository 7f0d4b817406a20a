#ifndef HINDSIGHT_BASE_TEXT_H_
#define HINDSIGHT_BASE_TEXT_H_

#include <string>

namespace hindsight {

/// Shortest text that reads back as the same double.
std::string FormatNumber(double value);

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_TEXT_H_
