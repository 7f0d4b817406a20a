#include "io/read/tick_clock.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hindsight {
namespace {

double Seconds(const Stamp& stamp) {
  return static_cast<double>(stamp.seconds) + stamp.fraction;
}

TEST(TickClock, IsExactForUnitsBelowASecond) {
  // The last nanosecond of a stamp that fits no double.
  const Stamp stamp = TickClock(1e-9).At(false, 1483228800123456789u);
  EXPECT_EQ(stamp.seconds, 1483228800);
  EXPECT_NEAR(stamp.fraction, 0.123456789, 1e-15);
}

TEST(TickClock, IsExactForUnitsAboveASecond) {
  EXPECT_EQ(Seconds(TickClock(60.0).At(false, 3)), 180.0);
  EXPECT_EQ(Seconds(TickClock(3600.0).At(true, 2)), -7200.0);
  EXPECT_EQ(TickClock(60.0).At(false, 24720480).seconds, 1483228800);
}

TEST(TickClock, IsExactWhereASecondIsNoWholeNumberOfTicks) {
  // 0.003 s: a clock of 333 Hz would be 0.1 % off, 1.5 million seconds here.
  const Stamp stamp = TickClock(0.003).At(false, 494409600001u);
  EXPECT_EQ(stamp.seconds, 1483228800);
  EXPECT_NEAR(stamp.fraction, 0.003, 1e-15);
  const Stamp thirds = TickClock(1.0 / 3.0).At(false, 4449686400001u);
  EXPECT_EQ(thirds.seconds, 1483228800000);
  EXPECT_NEAR(thirds.fraction, 1.0 / 3.0, 1e-15);
  const Stamp ntsc = TickClock(1.001 / 30.0).At(false, 30000);
  EXPECT_EQ(ntsc.seconds, 1001);
  EXPECT_EQ(ntsc.fraction, 0.0);
}

TEST(TickClock, OfNoUsualLengthIsGoodToRounding) {
  for (const double tick : {0.01234567890123, 7.891e-7, 1e-12, 12.3456789e6}) {
    const std::uint64_t count = 1234567;
    const double expected = tick * static_cast<double>(count);
    EXPECT_NEAR(Seconds(TickClock(tick).At(false, count)), expected,
                4e-16 * expected);
  }
}

}  // namespace
}  // namespace hindsight
