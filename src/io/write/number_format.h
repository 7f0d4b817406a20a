#ifndef HINDSIGHT_IO_WRITE_NUMBER_FORMAT_H_
#define HINDSIGHT_IO_WRITE_NUMBER_FORMAT_H_

#include <string>

namespace hindsight {

/// Appends `value` with a fixed number of decimals, locale-independent. A
/// value that rounds to zero has no sign.
void AppendFixed(double value, int decimals, std::string* out);

/// Appends `value` with `digits` significant digits, trailing zeros dropped.
void AppendGeneral(double value, int digits, std::string* out);

/// Appends the shortest text without exponent that reads back as exactly
/// `value`.
void AppendShortest(double value, std::string* out);

std::string FormatFixed(double value, int decimals);
std::string FormatGeneral(double value, int digits);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_NUMBER_FORMAT_H_
