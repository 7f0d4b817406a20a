#include "measurements/standing_flags.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hindsight {
namespace {

MeasurementSeries Flags(double rate, double from, double to) {
  MeasurementSeries flags;
  for (int k = 0; from + k / rate < to - 1e-9; ++k) {
    flags.push_back({from + k / rate, 0, false, ZeroVelocity{0.05}});
  }
  return flags;
}

/// Sum of 1/sigma^2 in units of one measurement's.
double Information(const MeasurementSeries& flags) {
  double sum = 0.0;
  for (const Measurement& z : flags) {
    sum += std::pow(0.05 / std::get<ZeroVelocity>(z.model).sigma, 2);
  }
  return sum;
}

TEST(StandingFlags, StanceIsOneMeasurementAtAnyRate) {
  for (const double rate : {20.0, 60.0, 400.0}) {
    MeasurementSeries flags = Flags(rate, 3.0, 3.5);
    ShareErrorsOfStances(&flags);
    EXPECT_NEAR(Information(flags), 1.0, 1e-9) << rate;
    flags = Flags(rate, 3.0, 63.0);
    ShareErrorsOfStances(&flags);
    EXPECT_NEAR(Information(flags), 60.0, 3.0) << rate;
  }
}

TEST(StandingFlags, StepsASecondApartDoNotShare) {
  MeasurementSeries flags = Flags(60.0, 3.0, 3.4);
  for (const Measurement& z : Flags(60.0, 4.4, 4.8)) flags.push_back(z);
  ShareErrorsOfStances(&flags);
  EXPECT_NEAR(Information(flags), 2.0, 1e-9);
}

TEST(StandingFlags, SlowRowsAndOtherModelsStayAsTheyAre) {
  MeasurementSeries flags;
  flags.push_back({0.1, 1, false, HeightFix{1.0, 0.5}});
  for (const Measurement& z : Flags(1.0, 1.0, 20.0)) flags.push_back(z);
  ShareErrorsOfStances(&flags);
  EXPECT_EQ(std::get<HeightFix>(flags[0].model).sigma, 0.5);
  flags.EraseIf([](const Measurement& z) {
    return std::holds_alternative<HeightFix>(z.model);
  });
  EXPECT_EQ(Information(flags), 19.0);
}

}  // namespace
}  // namespace hindsight
