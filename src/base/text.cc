#include "base/text.h"

#include <array>
#include <charconv>

namespace hindsight {

std::string FormatNumber(double value) {
  std::array<char, 32> buffer;
  const auto result =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return std::string(buffer.data(), result.ptr);
}

}  // namespace hindsight
