#include "io/read/numeric_array.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace hindsight {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the bytes of the file are used as they stand");

template <typename T>
T Load(const char* data, bool big_endian) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, data, sizeof(T));
  if (big_endian) std::reverse(bytes, bytes + sizeof(T));
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

/// Calls `take` with the number in its own type.
template <typename Take>
auto Visit(const NumericArray& array, std::size_t row, std::size_t column,
           const Take& take) {
  const std::size_t at = array.column_major ? column * array.rows + row
                                            : row * array.columns + column;
  const char* data = array.bytes.data() + at * Width(array.type);
  const bool big = array.big_endian;
  switch (array.type) {
    case NumberType::kI1:
      return take(Load<std::int8_t>(data, big));
    case NumberType::kU1:
      return take(Load<std::uint8_t>(data, big));
    case NumberType::kI2:
      return take(Load<std::int16_t>(data, big));
    case NumberType::kU2:
      return take(Load<std::uint16_t>(data, big));
    case NumberType::kI4:
      return take(Load<std::int32_t>(data, big));
    case NumberType::kU4:
      return take(Load<std::uint32_t>(data, big));
    case NumberType::kI8:
      return take(Load<std::int64_t>(data, big));
    case NumberType::kU8:
      return take(Load<std::uint64_t>(data, big));
    case NumberType::kF4:
      return take(Load<float>(data, big));
    default:
      return take(Load<double>(data, big));
  }
}

}  // namespace

std::size_t Width(NumberType type) {
  switch (type) {
    case NumberType::kI1:
    case NumberType::kU1:
      return 1;
    case NumberType::kI2:
    case NumberType::kU2:
      return 2;
    case NumberType::kI4:
    case NumberType::kU4:
    case NumberType::kF4:
      return 4;
    default:
      return 8;
  }
}

double NumericArray::at(std::size_t row, std::size_t column) const {
  return Visit(*this, row, column,
               [](auto value) { return static_cast<double>(value); });
}

bool NumericArray::IsInteger() const {
  return type != NumberType::kF4 && type != NumberType::kF8;
}

std::pair<bool, std::uint64_t> NumericArray::IntegerAt(
    std::size_t row, std::size_t column) const {
  return Visit(*this, row, column, [](auto value) {
    const bool negative = value < decltype(value){0};
    const auto magnitude = static_cast<std::uint64_t>(+value);
    return std::pair(negative, negative ? 0 - magnitude : magnitude);
  });
}

}  // namespace hindsight
