#include "io/write/number_format.h"

#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace hindsight {
namespace {

constexpr int kMostDecimals = 12;
constexpr int kMostDigits = 18;

std::string Reference(double value, std::chars_format format, int precision) {
  char buffer[400];
  const auto result =
      std::to_chars(buffer, buffer + sizeof buffer, value, format, precision);
  return {buffer, result.ptr};
}

std::string ReferenceFixed(double value, int decimals) {
  const std::string text = Reference(value, std::chars_format::fixed, decimals);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && text.front() == '-' ? text.substr(1) : text;
}

/// Both signs, in every form.
void ExpectAsTheStandard(double size) {
  for (const double value : {size, -size}) {
    for (int decimals = 0; decimals <= kMostDecimals; ++decimals) {
      ASSERT_EQ(FormatFixed(value, decimals), ReferenceFixed(value, decimals));
    }
    for (int digits = 1; digits <= kMostDigits; ++digits) {
      ASSERT_EQ(FormatGeneral(value, digits),
                Reference(value, std::chars_format::general, digits));
    }
  }
}

TEST(NumberFormat, IsTheStandardOneOfNumbersOfAnySize) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-25.0, 20.0);
  for (int i = 0; i < 20000; ++i) {
    ExpectAsTheStandard(std::pow(10.0, exponent(random)));
  }
}

TEST(NumberFormat, RoundsHalvesToEven) {
  for (int i = 0; i < 500; ++i) {
    for (int halvings = 1; halvings < 14; ++halvings) {
      ExpectAsTheStandard(std::ldexp(i, -halvings));
    }
  }
  EXPECT_EQ(FormatFixed(0.125, 2), "0.12");
  EXPECT_EQ(FormatGeneral(0.375, 2), "0.38");
}

TEST(NumberFormat, IsTheStandardOneBesidePowersOfTen) {
  for (int exponent = -30; exponent <= 25; ++exponent) {
    for (const double part : {1.0, 5.0, 9.5, 9.99999995, 9.99999999999999}) {
      const double value = part * std::pow(10.0, exponent);
      ExpectAsTheStandard(value);
      ExpectAsTheStandard(std::nextafter(value, 0.0));
      ExpectAsTheStandard(std::nextafter(value, 2.0 * value));
    }
  }
}

TEST(NumberFormat, IsTheStandardOneAtTheEndsOfTheRange) {
  using Limits = std::numeric_limits<double>;
  for (const double value :
       {0.0, Limits::denorm_min(), Limits::min(), Limits::max(), 0x1p53,
        0x1p53 - 1.0, Limits::infinity()}) {
    ExpectAsTheStandard(value);
  }
}

}  // namespace
}  // namespace hindsight
