#ifndef HINDSIGHT_BASE_TEXT_H_
#define HINDSIGHT_BASE_TEXT_H_

#include <string>

namespace hindsight {

/// Shortest text that reads back as the same double.
std::string FormatNumber(double value);

/// A probability in per cent, of two significant digits: "0.12 %", "51 %"; beyond 99 %
/// with a decimal, "99.6 %", and at last "over 99.9 %".
std::string FormatProbability(double probability);

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_TEXT_H_
