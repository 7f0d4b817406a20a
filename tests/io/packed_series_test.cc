#include "io/write/packed_series.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace hindsight {
namespace {

using ::testing::ElementsAre;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(PackedSeries, GivesValuesBackToHalfAQuantum) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> step(0.0, 3.0);
  for (const double quantum : {1e-12, 1e-6, 1e-3, 1.0, 1000.0}) {
    std::vector<double> values;
    double value = -40.0;
    for (int k = 0; k < 5000; ++k) {
      value += step(random);
      values.push_back(k % 97 == 0 ? kNan : value);
    }
    const std::string bytes = PackSeries(values, quantum);
    std::size_t offset = 0;
    const std::vector<double> back =
        UnpackSeries(bytes, values.size(), quantum, &offset);
    EXPECT_EQ(offset, bytes.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (std::isnan(values[k])) {
        EXPECT_TRUE(std::isnan(back[k])) << k;
      } else {
        EXPECT_NEAR(back[k], values[k], 0.5 * quantum + 1e-13) << k;
      }
    }
  }
}

TEST(PackedSeries, PacksDifferencesByTheRule) {
  // 0 for no number; zigzag of +3, -1, then 200 in two bytes.
  EXPECT_EQ(PackSeries({3.0, kNan, 2.0, 202.0}, 1.0),
            std::string("\x07\x00\x02\x91\x03", 5));
}

TEST(PackedSeries, HoldsTheLargestMagnitudes) {
  const double most = 4503599627370496.0;
  const std::string bytes = PackSeries({1e300, -1e300, 0.0}, 1.0);
  std::size_t offset = 0;
  EXPECT_THAT(UnpackSeries(bytes, 3, 1.0, &offset),
              ElementsAre(most, -most, 0.0));
}

TEST(PackedSeries, RefusesWhatIsCutOff) {
  const std::string bytes = PackSeries({1000.0}, 1.0);
  std::size_t offset = 0;
  EXPECT_THROW(UnpackSeries(bytes.substr(0, 1), 1, 1.0, &offset),
               std::invalid_argument);
}

TEST(PackedSeries, QuantumIsFineAgainstRangeAndMagnitude) {
  EXPECT_DOUBLE_EQ(QuantumOf({100.0, 200.0, 300.0}), 1e-2);
  // A sigma that settles: a 500th of its median.
  EXPECT_DOUBLE_EQ(QuantumOf({100.0, 0.02, 0.02, 0.02, 0.02}), 2e-5);
  EXPECT_DOUBLE_EQ(QuantumOf({100.0, 260.0, 200.0}), 5e-3);
  EXPECT_DOUBLE_EQ(QuantumOf({0.0, 0.0}), 1.0);
  EXPECT_DOUBLE_EQ(QuantumOf({kNan}), 1.0);
}

TEST(PackedSeries, ExtremesComeInTheirOrder) {
  const std::vector<double> values = {1.0, 5.0, 3.0, 4.0, 9.0, 2.0, kNan, kNan};
  const std::vector<double> extremes = Extremes(values, 4);
  EXPECT_EQ(extremes[0], 1.0);
  EXPECT_EQ(extremes[1], 5.0);
  EXPECT_EQ(extremes[4], 9.0);
  EXPECT_EQ(extremes[5], 2.0);
  EXPECT_TRUE(std::isnan(extremes[6]) && std::isnan(extremes[7]));
  EXPECT_THAT(ExtremeTimes({0, 1, 2, 3, 4, 5, 6, 7}, 2),
              ElementsAre(0.0, 2.0, 4.0, 6.0));
}

TEST(PackedSeries, Base64FollowsTheStandard) {
  // RFC 4648, section 10.
  EXPECT_EQ(Base64(""), "");
  EXPECT_EQ(Base64("f"), "Zg==");
  EXPECT_EQ(Base64("fo"), "Zm8=");
  EXPECT_EQ(Base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(Base64("\xff\xff\xff"), "////");
}

}  // namespace
}  // namespace hindsight
