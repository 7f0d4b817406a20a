#include "io/write/number_format.h"

#include <charconv>
#include <string_view>

namespace hindsight {
namespace {

// Room for the fixed form of the largest double and its decimals.
constexpr std::size_t kLongestNumber = 400;

}  // namespace

void AppendFixed(double value, int decimals, std::string* out) {
  char buffer[kLongestNumber];
  const auto result = std::to_chars(buffer, buffer + kLongestNumber, value,
                                    std::chars_format::fixed, decimals);
  const std::string_view text(buffer,
                              static_cast<std::size_t>(result.ptr - buffer));
  const bool is_zero = text.find_first_not_of("-0.") == std::string_view::npos;
  out->append(is_zero && text.starts_with('-') ? text.substr(1) : text);
}

void AppendGeneral(double value, int digits, std::string* out) {
  char buffer[kLongestNumber];
  const auto result = std::to_chars(buffer, buffer + kLongestNumber, value,
                                    std::chars_format::general, digits);
  out->append(buffer, result.ptr);
}

void AppendShortest(double value, std::string* out) {
  char buffer[kLongestNumber];
  const auto result = std::to_chars(buffer, buffer + kLongestNumber, value,
                                    std::chars_format::fixed);
  out->append(buffer, result.ptr);
}

std::string FormatFixed(double value, int decimals) {
  std::string text;
  AppendFixed(value, decimals, &text);
  return text;
}

std::string FormatGeneral(double value, int digits) {
  std::string text;
  AppendGeneral(value, digits, &text);
  return text;
}

}  // namespace hindsight
