#include "imu/sample_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace hindsight {
namespace {

ImuStream StreamOf(const std::vector<double>& stamps) {
  ImuStream imu;
  for (const double t : stamps) imu.samples.push_back({.t = t});
  return imu;
}

/// Against the standard library, between, at and beside all stamps.
void ExpectFound(const std::vector<double>& stamps) {
  const ImuStream imu = StreamOf(stamps);
  std::vector<double> times = {-1e9, 1e9, 0.0};
  for (const double t : stamps) {
    for (const double d : {-0.3, -1e-9, 0.0, 1e-9, 0.3}) times.push_back(t + d);
  }
  for (const double t : times) {
    const auto at = std::lower_bound(stamps.begin(), stamps.end(), t);
    const auto after = std::upper_bound(stamps.begin(), stamps.end(), t);
    EXPECT_EQ(FirstSampleAt(imu, t),
              static_cast<std::size_t>(at - stamps.begin()))
        << t;
    EXPECT_EQ(FirstSampleAfter(imu, t),
              static_cast<std::size_t>(after - stamps.begin()))
        << t;
  }
}

TEST(SampleSearch, FindsAmongStampsThatAreRegularOrNot) {
  std::vector<double> regular;
  std::vector<double> bent;
  std::vector<double> with_gap;
  for (int k = 0; k < 500; ++k) {
    regular.push_back(0.01 * k - 1.0);
    bent.push_back(std::exp(0.02 * k));
    with_gap.push_back(k < 20 ? 0.01 * k : 3600.0 + 0.01 * k);
  }
  ExpectFound(regular);
  ExpectFound(bent);
  ExpectFound(with_gap);
}

TEST(SampleSearch, FindsAmongFewSamples) {
  ExpectFound({});
  ExpectFound({2.0});
  ExpectFound({2.0, 3.0});
  ExpectFound({-2.0, 2.5, 3.0});
}

}  // namespace
}  // namespace hindsight
