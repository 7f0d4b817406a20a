#include "base/text.h"

#include <fmt/core.h>

#include <array>
#include <charconv>

namespace hindsight {

std::string FormatNumber(double value) {
  std::array<char, 32> buffer;
  const auto result =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return std::string(buffer.data(), result.ptr);
}

std::string FormatProbability(double probability) {
  const double percent = 100.0 * probability;
  if (percent > 99.9) return "over 99.9 %";
  if (percent > 99.0) return fmt::format("{:.1f} %", percent);
  return fmt::format("{:.2g} %", percent);
}

}  // namespace hindsight
