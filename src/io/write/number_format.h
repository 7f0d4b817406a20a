#ifndef HINDSIGHT_IO_WRITE_NUMBER_FORMAT_H_
#define HINDSIGHT_IO_WRITE_NUMBER_FORMAT_H_

#include <cstddef>
#include <string>

namespace hindsight {

/// Room for the longest: the fixed form of the largest double and its decimals.
inline constexpr std::size_t kLongestNumber = 400;

/// What AppendFixed, AppendGeneral and AppendShortest append, put where there is that
/// much room. Return where the next character goes.
char* PutFixed(double value, int decimals, char* to);
char* PutGeneral(double value, int digits, char* to);
char* PutShortest(double value, char* to);

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
