#include "io/write/number_format.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>

namespace hindsight {
namespace {

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
  const Wide halves = product >> (shift - 1);
  const Wide rest = product - (halves << (shift - 1));
  // Up from a half, of a half alone if that makes it even: no branch, as nobody
  // guesses it.
  const auto last = static_cast<unsigned>(halves);
  const unsigned up = last & (last >> 1 | static_cast<unsigned>(rest != 0)) & 1;
  return (halves >> 1) + up;
}

// What is quick returns where the next character goes; nullptr, and nothing that was
// put counts, for numbers that it leaves out.

char* PutWhole(std::uint64_t value, char* to) {
  constexpr std::ptrdiff_t kMostDigits = 20;
  return std::to_chars(to, to + kMostDigits, value).ptr;
}

constexpr auto kPairs = [] {
  std::array<char, 200> pairs = {};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::size_t pair = i / 2;
    pairs[i] = static_cast<char>('0' + (i % 2 == 0 ? pair / 10 : pair % 10));
  }
  return pairs;
}();

void PutPair(std::uint64_t value, char* to) {
  std::memcpy(to, kPairs.data() + 2 * value, 2);
}

/// The last digits of a number, as many as `count` says, with zeros in front.
char* PutDigits(std::uint64_t value, int count, char* to) {
  char* const end = to + count;
  char* at = end;
  for (; at - to >= 4; value /= 10000) {
    const std::uint64_t four = value % 10000;
    at -= 4;
    PutPair(four / 100, at);
    PutPair(four % 100, at + 2);
  }
  for (; at > to; value /= 10) *--at = static_cast<char>('0' + value % 10);
  return end;
}

char* PutFixedQuickly(double value, int decimals, char* to) {
  constexpr double kLargest = 1e8;
  constexpr int kMostDecimals = 10;
  const double size = std::abs(value);
  if (!(size >= kLeastNormal && size < kLargest) || decimals < 1 ||
      decimals > kMostDecimals) {
    return nullptr;
  }
  const auto digits =
      static_cast<std::uint64_t>(Scaled(Binary(size), decimals));
  const auto one = static_cast<std::uint64_t>(PowerOfTen(decimals));
  if (value < 0.0 && digits > 0) *to++ = '-';
  to = PutWhole(digits / one, to);
  *to++ = '.';
  return PutDigits(digits % one, decimals, to);
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

char* PutGeneralQuickly(double value, int count, char* to) {
  constexpr double kLargest = 9007199254740992.0;  // 2^kMantissaBits
  constexpr int kLeastFixed = -4;                  // as printf's %g
  const double size = std::abs(value);
  if (!(size >= kLeastNormal && size < kLargest)) return nullptr;
  const std::optional<Decimal> decimal = Rounded(size, count);
  if (!decimal) return nullptr;
  const int exponent = decimal->exponent;
  const bool scientific = exponent < kLeastFixed || exponent >= count;
  if (value < 0.0) *to++ = '-';
  if (!scientific && exponent < 0) {
    *to++ = '0';
    *to++ = '.';
    for (int i = -1; i > exponent; --i) *to++ = '0';
  }
  // With room for the point, before which there is not much.
  const int whole = scientific ? 1 : std::max(exponent + 1, 0);
  char* const point = to + whole;
  char* const first = whole > 0 ? to + 1 : to;
  to = PutDigits(decimal->digits, count, first);
  while (to - first > std::max(whole, 1) && to[-1] == '0') --to;
  if (whole > 0) {
    for (char* at = point - whole; at < point; ++at) *at = at[1];
    if (to == point + 1) {
      to = point;
    } else {
      *point = '.';
    }
  }
  if (scientific) {
    *to++ = 'e';
    *to++ = exponent < 0 ? '-' : '+';
    if (std::abs(exponent) < 10) *to++ = '0';
    to = PutWhole(static_cast<std::uint64_t>(std::abs(exponent)), to);
  }
  return to;
}

}  // namespace

char* PutFixed(double value, int decimals, char* to) {
  if (char* const end = PutFixedQuickly(value, decimals, to)) return end;
  char* const end = std::to_chars(to, to + kLongestNumber, value,
                                  std::chars_format::fixed, decimals)
                        .ptr;
  const bool is_zero = std::string_view(to, static_cast<std::size_t>(end - to))
                           .find_first_not_of("-0.") == std::string_view::npos;
  return is_zero && *to == '-' ? std::copy(to + 1, end, to) : end;
}

char* PutGeneral(double value, int digits, char* to) {
  if (char* const end = PutGeneralQuickly(value, digits, to)) return end;
  return std::to_chars(to, to + kLongestNumber, value,
                       std::chars_format::general, digits)
      .ptr;
}

char* PutShortest(double value, char* to) {
  return std::to_chars(to, to + kLongestNumber, value, std::chars_format::fixed)
      .ptr;
}

void AppendFixed(double value, int decimals, std::string* out) {
  char buffer[kLongestNumber];
  out->append(buffer, PutFixed(value, decimals, buffer));
}

void AppendGeneral(double value, int digits, std::string* out) {
  char buffer[kLongestNumber];
  out->append(buffer, PutGeneral(value, digits, buffer));
}

void AppendShortest(double value, std::string* out) {
  char buffer[kLongestNumber];
  out->append(buffer, PutShortest(value, buffer));
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
