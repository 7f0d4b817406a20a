#include "base/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace hindsight {
namespace {

// From an implementation in unbounded integers, itself checked against the
// published outputs of xoshiro256++ (41943041, 58720359, 3588806011781223 from
// the state 1 2 3 4; 5987356902031041503 from splitmix64 of 0).
TEST(Random, FirstValuesAreFixed) {
  Random zero(0);
  EXPECT_EQ(zero.NextBits(), 5226295891941712017u);
  EXPECT_EQ(zero.NextBits(), 5547022123706608281u);
  EXPECT_EQ(zero.NextBits(), 18144476329041699521u);
  Random first(42);
  EXPECT_EQ(first.NextBits(), 4041048026548471592u);
  EXPECT_EQ(first.NextBits(), 16112358804465243869u);
  Random second(42, 1);
  EXPECT_EQ(second.NextBits(), 5585924880351132218u);
  EXPECT_EQ(second.NextBits(), 11806727509546900607u);
}

TEST(Random, UniformTakesTheUpper53Bits) {
  Random random(0);
  EXPECT_EQ(random.Uniform(),
            std::ldexp(static_cast<double>(5226295891941712017u >> 11), -53));
}

TEST(Random, UniformFillsTheUnitInterval) {
  constexpr int kCount = 100000;
  constexpr int kBins = 20;
  Random random(3);
  int counts[kBins] = {};
  for (int i = 0; i < kCount; ++i) {
    const double u = random.Uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    ++counts[static_cast<int>(u * kBins)];
  }
  double chi2 = 0.0;
  constexpr double kExpected = static_cast<double>(kCount) / kBins;
  for (const int count : counts) {
    chi2 += (count - kExpected) * (count - kExpected) / kExpected;
  }
  // 19 degrees of freedom: exceeded with probability 0.001.
  EXPECT_LT(chi2, 43.8);
}

TEST(Random, NormalHasTheMomentsOfTheNormalDistribution) {
  constexpr int kCount = 200000;
  Random random(5);
  double sum[5] = {};
  for (int i = 0; i < kCount; ++i) {
    double power = 1.0;
    const double x = random.Normal();
    for (double& s : sum) {
      s += power;
      power *= x;
    }
  }
  // Sample moment p has variance (E x^2p - (E x^p)^2) / N; four sigma.
  const double four = 4.0 / std::sqrt(static_cast<double>(kCount));
  EXPECT_NEAR(sum[1] / kCount, 0.0, four * 1.0);
  EXPECT_NEAR(sum[2] / kCount, 1.0, four * std::sqrt(3.0 - 1.0));
  EXPECT_NEAR(sum[3] / kCount, 0.0, four * std::sqrt(15.0));
  EXPECT_NEAR(sum[4] / kCount, 3.0, four * std::sqrt(105.0 - 9.0));
}

TEST(Random, StreamsAndSuccessiveValuesAreUncorrelated) {
  constexpr int kCount = 100000;
  Random a(9, 0);
  Random b(9, 1);
  double between = 0.0;
  double successive = 0.0;
  double previous = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double x = a.Normal();
    between += x * b.Normal();
    successive += x * previous;
    previous = x;
  }
  const double four = 4.0 / std::sqrt(static_cast<double>(kCount));
  EXPECT_NEAR(between / kCount, 0.0, four);
  EXPECT_NEAR(successive / kCount, 0.0, four);
}

TEST(Random, VectorTakesThreeDeviatesInOrder) {
  Random scalar(11);
  Random vector(11);
  const Eigen::Vector3d v = vector.NormalVector3();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(v(i), scalar.Normal());
}

}  // namespace
}  // namespace hindsight
