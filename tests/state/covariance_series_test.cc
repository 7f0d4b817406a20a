#include "state/covariance_series.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/random.h"

namespace hindsight {
namespace {

constexpr int kDim = 5;

ErrorMatrix Draw(Random* random) {
  ErrorMatrix P(kDim, kDim);
  for (int j = 0; j < kDim; ++j) {
    for (int i = j; i < kDim; ++i) P(i, j) = P(j, i) = random->Normal();
  }
  return P;
}

TEST(CovarianceSeries, GivesPartsAsTheWhole) {
  constexpr std::size_t kCount = 3;
  Random random(3);
  CovarianceSeries series(kDim, kCount);
  for (std::size_t k = 0; k < kCount; ++k) series.Set(k, Draw(&random));
  for (std::size_t k = 0; k < kCount; ++k) {
    const ErrorMatrix P = series.Get(k);
    EXPECT_EQ(series.Variances(k), ErrorVector(P.diagonal())) << k;
    for (int i = 0; i < kDim; ++i) {
      for (int j = 0; j < kDim; ++j) EXPECT_EQ(series.At(k, i, j), P(i, j));
    }
  }
}

TEST(CovarianceSeries, SeesWhatIsNotFinite) {
  Random random(4);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()}) {
    for (int i = 0; i < kDim; ++i) {
      for (int j = 0; j <= i; ++j) {
        CovarianceSeries series(kDim, 2);
        ErrorMatrix P = Draw(&random);
        series.Set(0, P);
        P(i, j) = P(j, i) = bad;
        series.Set(1, P);
        EXPECT_TRUE(series.IsFinite(0));
        EXPECT_FALSE(series.IsFinite(1)) << i << " " << j;
      }
    }
  }
}

}  // namespace
}  // namespace hindsight
