#include "io/read/quick_number.h"

#include <fast_float/fast_float.h>
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace hindsight {
namespace {

/// Whether it reads what a parser of all numbers reads, to the bit and to the end of
/// it; false if it leaves the number to that.
bool ReadsTheSame(const std::string& text) {
  // In memory of its own, so that reading behind it is seen.
  const std::vector<char> own(text.begin(), text.end());
  const char* at = own.data();
  const char* const end = at + own.size();
  double value = 7.0;
  if (!QuickNumber::Read(&at, end, &value)) {
    EXPECT_EQ(at, own.data()) << text;
    EXPECT_EQ(value, 7.0) << text;
    return false;
  }
  double expected = 0.0;
  const auto result = fast_float::from_chars(own.data(), end, expected);
  EXPECT_EQ(result.ec, std::errc()) << text;
  EXPECT_EQ(at, result.ptr) << text;
  EXPECT_EQ(std::bit_cast<std::uint64_t>(value),
            std::bit_cast<std::uint64_t>(expected))
      << text;
  return true;
}

std::vector<std::string> Written(double value) {
  std::vector<std::string> texts;
  for (int digits = 0; digits <= 17; ++digits) {
    texts.push_back(fmt::format("{:.{}g}", value, digits + 1));
    texts.push_back(fmt::format("{:.{}f}", value, digits));
    texts.push_back(fmt::format("{:.{}e}", value, digits));
  }
  return texts;
}

TEST(QuickNumber, ReadsWhatAParserOfAllNumbersReads) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> mantissa(-10.0, 10.0);
  std::uniform_int_distribution<int> power(-12, 9);
  int quick = 0, all = 0;
  for (int i = 0; i < 2000; ++i) {
    const double value = mantissa(random) * std::pow(10.0, power(random));
    for (const std::string& text : Written(value)) {
      for (const char* behind : {"", ",", ",1.5,2.25e-07,", " 12345678"}) {
        quick += ReadsTheSame(text + behind) ? 1 : 0;
        ++all;
      }
    }
  }
  EXPECT_GT(quick, all / 3);
}

TEST(QuickNumber, TakesWhatFilesOfReadingsHold) {
  for (const char* text :
       {"0.005", "86399.995", "-0.0490683411859", "-2.72514002448e-06",
        "0.000124237229092", "48.0000053795812", "501.2510778", "0.0", "-0.000",
        "5.", "1.5E+00", "123456789.125"}) {
    EXPECT_TRUE(ReadsTheSame(text)) << text;
    EXPECT_TRUE(ReadsTheSame(std::string(text) + ",17")) << text;
  }
}

/// At each length that it may be cut off to, and with each character in its place.
TEST(QuickNumber, LeavesTheRestToTheParser) {
  for (const std::string whole :
       {"-2.72514002448e-06,", "123456.7890123,", "0.12345678e+12,",
        "9007199254.740993,", "0.9007199254740993,"}) {
    for (std::size_t length = 0; length <= whole.size(); ++length) {
      ReadsTheSame(whole.substr(0, length));
    }
    for (std::size_t i = 0; i < whole.size(); ++i) {
      for (int c = 0; c < 256; ++c) {
        std::string other = whole;
        other[i] = static_cast<char>(c);
        ReadsTheSame(other);
      }
    }
  }
  for (const char* text :
       {"", "-", "+1.5", ".5", "-.5", "5", "1e5", "nan", "inf", "1.5e400",
        "1.5e-100", "1.5e-", "1.5e-6", "1.2345678901234567", "12345678901.5",
        "9007199254740993.0", "0.0000000000000000000000000015"}) {
    EXPECT_FALSE(ReadsTheSame(text)) << text;
  }
}

}  // namespace
}  // namespace hindsight
