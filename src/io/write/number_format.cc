#include "io/write/number_format.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

namespace hindsight {
namespace {

// Room for the fixed form of the largest double and its decimals.
constexpr std::size_t kLongestNumber = 400;

// What is quick here is exact, and several times as fast as std::to_chars with a
// precision, which gets the numbers that it leaves out.
__extension__ using Wide = unsigned __int128;

constexpr int kMantissaBits = std::numeric_limits<double>::digits;
constexpr double kLeastNormal = std::numeric_limits<double>::min();
/// The largest power of ten of which a product with a mantissa is Wide.
constexpr int kLargestPower = 22;

constexpr auto kPowersOfTen = [] {
  std::array<Wide, kLargestPower + 1> powers = {1};
  for (std::size_t i = 1; i < powers.size(); ++i) {
    powers[i] = 10 * powers[i - 1];
  }
  return powers;
}();

Wide PowerOfTen(int exponent) {
  return kPowersOfTen[static_cast<std::size_t>(exponent)];
}

/// value = mantissa * 2^exponent of a normal value > 0.
struct Binary {
  explicit Binary(double value)
      : mantissa((std::bit_cast<std::uint64_t>(value) & (kHidden - 1)) |
                 kHidden),
        exponent(static_cast<int>(std::bit_cast<std::uint64_t>(value) >>
                                  (kMantissaBits - 1)) -
                 kBias) {}

  static constexpr std::uint64_t kHidden = std::uint64_t{1}
                                           << (kMantissaBits - 1);
  static constexpr int kBias = 1023 + kMantissaBits - 1;
  std::uint64_t mantissa;
  int exponent;
};

/// value * 10^power to the nearest whole number, half to even; a normal value
/// between 0 and 2^kMantissaBits, 0 <= power <= kLargestPower.
Wide Scaled(const Binary& value, int power) {
  constexpr int kWideBits = 128;
  const Wide product = value.mantissa * PowerOfTen(power);
  const int shift = -value.exponent;
  if (shift == 0) return product;
  if (shift >= kWideBits) return 0;  // the product is below half of that
  const Wide floor = product >> shift;
  const Wide rest = product - (floor << shift);
  const Wide half = Wide{1} << (shift - 1);
  const bool up = rest > half || (rest == half && (floor & 1) != 0);
  return up ? floor + 1 : floor;
}

// What is quick here is composed in a buffer and appended at once.
constexpr std::size_t kLongestQuick = 48;
using QuickBuffer = std::array<char, kLongestQuick>;

/// Where the next character goes.
char* PutWhole(std::uint64_t value, char* to) {
  constexpr std::ptrdiff_t kMostDigits = 20;
  return std::to_chars(to, to + kMostDigits, value).ptr;
}

/// False, and nothing appended, for numbers that it leaves out.
bool AppendFixedQuickly(double value, int decimals, std::string* out) {
  constexpr double kLargest = 1e8;
  constexpr int kMostDecimals = 10;
  const double size = std::abs(value);
  if (!(size >= kLeastNormal && size < kLargest) || decimals < 1 ||
      decimals > kMostDecimals) {
    return false;
  }
  const auto digits =
      static_cast<std::uint64_t>(Scaled(Binary(size), decimals));
  const auto one = static_cast<std::uint64_t>(PowerOfTen(decimals));
  QuickBuffer buffer;
  char* to = buffer.data();
  if (value < 0.0 && digits > 0) *to++ = '-';
  char* const point = PutWhole(digits / one, to);
  to = PutWhole(one + digits % one, point);  // a digit more, for zeros in front
  *point = '.';
  out->append(buffer.data(), static_cast<std::size_t>(to - buffer.data()));
  return true;
}

/// A number of some digits, of which the first stands for 10^exponent.
struct Decimal {
  std::uint64_t digits = 0;
  int exponent = 0;
};

/// 0 < value < 2^kMantissaBits rounded to `count` digits, nothing for numbers that
/// it leaves out.
std::optional<Decimal> Rounded(double value, int count) {
  constexpr int kMostDigits = 17;
  if (count < 1 || count > kMostDigits) return std::nullopt;
  const Binary binary(value);
  // The exponent or one less, by log10(2) = 78913 / 2^18.
  int exponent = ((binary.exponent + kMantissaBits - 1) * 78913) >> 18;
  while (true) {
    const int power = count - 1 - exponent;
    if (power < 0 || power > kLargestPower) return std::nullopt;
    const Wide scaled = Scaled(binary, power);
    if (scaled < PowerOfTen(count)) {
      return Decimal{static_cast<std::uint64_t>(scaled), exponent};
    }
    ++exponent;
  }
}

/// As AppendFixedQuickly.
bool AppendGeneralQuickly(double value, int count, std::string* out) {
  constexpr double kLargest = 9007199254740992.0;  // 2^kMantissaBits
  constexpr int kLeastFixed = -4;                  // as printf's %g
  const double size = std::abs(value);
  if (!(size >= kLeastNormal && size < kLargest)) return false;
  const std::optional<Decimal> decimal = Rounded(size, count);
  if (!decimal) return false;
  const int exponent = decimal->exponent;
  const bool scientific = exponent < kLeastFixed || exponent >= count;
  QuickBuffer buffer;
  char* to = buffer.data();
  if (value < 0.0) *to++ = '-';
  if (!scientific && exponent < 0) {
    *to++ = '0';
    *to++ = '.';
    to = std::fill_n(to, -exponent - 1, '0');
  }
  char* const first = to;
  to = PutWhole(decimal->digits, to);
  const std::ptrdiff_t whole = scientific ? 1 : std::max(exponent + 1, 0);
  while (to - first > std::max<std::ptrdiff_t>(whole, 1) && to[-1] == '0') --to;
  if (whole > 0 && to - first > whole) {
    std::copy_backward(first + whole, to, to + 1);
    first[whole] = '.';
    ++to;
  }
  if (scientific) {
    *to++ = 'e';
    *to++ = exponent < 0 ? '-' : '+';
    if (std::abs(exponent) < 10) *to++ = '0';
    to = PutWhole(static_cast<std::uint64_t>(std::abs(exponent)), to);
  }
  out->append(buffer.data(), static_cast<std::size_t>(to - buffer.data()));
  return true;
}

}  // namespace

void AppendFixed(double value, int decimals, std::string* out) {
  if (AppendFixedQuickly(value, decimals, out)) return;
  char buffer[kLongestNumber];
  const auto result = std::to_chars(buffer, buffer + kLongestNumber, value,
                                    std::chars_format::fixed, decimals);
  const std::string_view text(buffer,
                              static_cast<std::size_t>(result.ptr - buffer));
  const bool is_zero = text.find_first_not_of("-0.") == std::string_view::npos;
  out->append(is_zero && text.starts_with('-') ? text.substr(1) : text);
}

void AppendGeneral(double value, int digits, std::string* out) {
  if (AppendGeneralQuickly(value, digits, out)) return;
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
