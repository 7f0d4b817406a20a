#include "dataset/resolution.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hindsight {
namespace {

constexpr ReadingRounding kFine = {.relative = 1e-12};
constexpr ReadingRounding kCoarse = {.absolute = 1e-6};

TEST(Resolution, IsTheStepBeyondTheRoundingOfUnits) {
  const double step = 0.1 / 3.0;
  const std::vector<double> readings = {7 * step, 3 * step, 8 * step,
                                        8 * step * (1.0 + 1e-15), 20 * step};
  EXPECT_NEAR(Resolution(readings, kFine, ReadingCourse::kToAndFro), step,
              1e-12);
  EXPECT_NEAR(
      Resolution({1.0, 1.0 + 1e-7, 1.5}, kCoarse, ReadingCourse::kToAndFro),
      0.5, 1e-6);
}

TEST(Resolution, OfWhatOnlyGrowsIsThatOfItsDifferences) {
  const std::vector<double> readings = {0.0, 3.0, 7.0, 10.0, 15.0};
  EXPECT_EQ(Resolution(readings, kCoarse, ReadingCourse::kToAndFro), 3.0);
  EXPECT_EQ(Resolution(readings, kCoarse, ReadingCourse::kAnyhow), 1.0);
}

TEST(Resolution, OfEqualReadingsIsInfinite) {
  for (const auto course : {ReadingCourse::kToAndFro, ReadingCourse::kAnyhow}) {
    EXPECT_TRUE(std::isinf(Resolution({2.0, 2.0}, kFine, course)));
    EXPECT_TRUE(std::isinf(Resolution({}, kFine, course)));
  }
}

}  // namespace
}  // namespace hindsight
