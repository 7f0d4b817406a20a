#ifndef HINDSIGHT_IO_READ_QUICK_NUMBER_H_
#define HINDSIGHT_IO_READ_QUICK_NUMBER_H_

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace hindsight {

/// 1, 10, 100, ...
template <typename Number, std::size_t kCount>
constexpr std::array<Number, kCount> PowersOfTen() {
  std::array<Number, kCount> powers = {1};
  for (std::size_t i = 1; i < kCount; ++i) powers[i] = 10 * powers[i - 1];
  return powers;
}

/// Reads a decimal number as most files have them: a sign or none, a digit or more, a
/// point, up to 15 digits, an exponent of two digits or none. The result is the
/// nearest double; it takes two thirds of the time that a parser of all numbers
/// takes, as of eight characters at once it is told how many are digits and what
/// these are worth, without a branch for each. Moves `at` behind the number. False,
/// and nothing moved or set, for what is written otherwise, has more than 2^53
/// without its point, or needs a power of ten beyond 10^22.
class QuickNumber {
 public:
  static bool Read(const char** at, const char* end, double* value) {
    if constexpr (std::endian::native != std::endian::little) return false;
    const char* p = *at;
    const bool negative = p != end && *p == '-';
    if (negative) ++p;
    std::uint64_t digits = 0;
    if (!ReadWhole(&p, end, &digits)) return false;
    const char* const fraction = ++p;
    if (!ReadFraction(&p, end, &digits)) return false;
    auto exponent = -static_cast<int>(p - fraction);
    if (p != end && (*p == 'e' || *p == 'E') &&
        !ReadExponent(&p, end, &exponent)) {
      return false;
    }
    if (exponent > 0 || exponent < -kLargestPower) return false;
    // Both are exact: what a division rounds is the number itself.
    const double size = static_cast<double>(digits) /
                        kPowersOfTen[static_cast<std::size_t>(-exponent)];
    *value = negative ? -size : size;
    *at = p;
    return true;
  }

 private:
  static constexpr std::size_t kWord = 8;  ///< characters that are read at once
  static constexpr int kLargestPower = 22;
  static constexpr std::uint64_t kZeros = 0x3030303030303030;  ///< "00000000"

  static constexpr auto kPowersOfTen = PowersOfTen<double, kLargestPower + 1>();
  static constexpr auto kWholePowers = PowersOfTen<std::uint64_t, kWord + 1>();
  /// Below these, digits and so many more of them stay within 2^53.
  static constexpr auto kRoom = [] {
    std::array<std::uint64_t, kWord> room = {};
    for (std::size_t i = 0; i < kWord; ++i) {
      room[i] = (std::uint64_t{1} << 53) / kWholePowers[i];
    }
    return room;
  }();

  static std::uint64_t DigitOf(char c) {
    return static_cast<std::uint64_t>(c) - '0';  // above 9 of others
  }

  /// Up to the point, which must be there.
  static bool ReadWhole(const char** at, const char* end,
                        std::uint64_t* digits) {
    constexpr std::uint64_t kLargest = 100'000'000;
    const char* p = *at;
    for (; p != end && *p != '.'; ++p) {
      const std::uint64_t digit = DigitOf(*p);
      if (digit > 9 || *digits > kLargest) return false;
      *digits = 10 * *digits + digit;
    }
    const bool is_read = p != end && p != *at;
    *at = p;
    return is_read;
  }

  static bool ReadFraction(const char** at, const char* end,
                           std::uint64_t* digits) {
    const char* p = *at;
    std::size_t count = 0;
    std::uint64_t value = 0;
    if (HasWord(p, end) && CountDigits(WordAt(p)) == kWord) {
      *digits = *digits * kWholePowers[kWord] + ValueOf(WordAt(p) - kZeros);
      p += kWord;
    }
    if (HasWord(p, end)) {
      const std::uint64_t word = WordAt(p);
      count = CountDigits(word);
      if (count == kWord) return false;
      // Behind as many zeros as there are other characters.
      if (count > 0) value = ValueOf((word - kZeros) << (8 * (kWord - count)));
    } else {
      for (; p + count != end && DigitOf(p[count]) <= 9; ++count) {
        value = 10 * value + DigitOf(p[count]);
      }
    }
    if (*digits >= kRoom[count]) return false;
    *digits = *digits * kWholePowers[count] + value;
    *at = p + count;
    return true;
  }

  /// Adds it.
  static bool ReadExponent(const char** at, const char* end, int* exponent) {
    const char* p = *at + 1;
    const bool negative = p != end && *p == '-';
    if (negative || (p != end && *p == '+')) ++p;
    if (end - p < 2) return false;
    const std::uint64_t tens = DigitOf(p[0]), ones = DigitOf(p[1]);
    p += 2;
    if (tens > 9 || ones > 9 || (p != end && DigitOf(*p) <= 9)) return false;
    const auto size = static_cast<int>(10 * tens + ones);
    *exponent += negative ? -size : size;
    *at = p;
    return true;
  }

  static bool HasWord(const char* p, const char* end) {
    return end - p >= static_cast<std::ptrdiff_t>(kWord);
  }
  /// The first character in the lowest byte.
  static std::uint64_t WordAt(const char* p) {
    std::uint64_t word = 0;
    std::memcpy(&word, p, kWord);
    return word;
  }
  /// How many there are before the first other character.
  static std::size_t CountDigits(std::uint64_t word) {
    // Above '9' one sum has its highest bit, below '0' the difference; a carry or
    // borrow comes from behind such a character alone.
    const std::uint64_t others =
        ((word + 0x4646464646464646) | (word - kZeros)) & 0x8080808080808080;
    return static_cast<std::size_t>(std::countr_zero(others)) / 8;
  }
  /// Of eight digits, the highest in the lowest byte: of pairs, of fours, of all.
  static std::uint64_t ValueOf(std::uint64_t digits) {
    constexpr std::uint64_t kFirstOfFour = 0x000000FF000000FF;
    digits = 10 * digits + (digits >> 8);
    const std::uint64_t first =
        (digits & kFirstOfFour) * (100 + (std::uint64_t{1'000'000} << 32));
    const std::uint64_t second =
        ((digits >> 16) & kFirstOfFour) * (1 + (std::uint64_t{10'000} << 32));
    return (first + second) >> 32;
  }
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_QUICK_NUMBER_H_
