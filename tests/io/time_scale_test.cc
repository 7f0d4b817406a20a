#include "io/read/time_scale.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>

#include "io/read/date_text.h"

namespace hindsight {
namespace {

TEST(TimeScale, NanosecondStampsKeepEveryDigit) {
  const auto a = ParseStamp("1403636579763555584", 1'000'000'000);
  const auto b = ParseStamp("1403636579763555585", 1'000'000'000);
  ASSERT_TRUE(a && b);
  EXPECT_NEAR(b->Since(*a), 1e-9, 1e-15);
  EXPECT_EQ(a->seconds, 1403636579);
}

TEST(TimeScale, LongDecimalSecondsKeepEveryDigit) {
  const auto a = ParseStamp("1403636579.763555584", 1);
  const auto b = ParseStamp("1403636579.763555585", 1);
  ASSERT_TRUE(a && b);
  EXPECT_NEAR(b->Since(*a), 1e-9, 1e-15);
}

TEST(TimeScale, ShortStampsReadAsTheNearestDouble) {
  EXPECT_EQ(ParseStamp("243258.499", 1)->Since({}), 243258.499);
  EXPECT_EQ(ParseStamp("-0.25", 1)->Since({}), -0.25);
  EXPECT_EQ(ParseStamp("2.5e3", 1000)->Since({}), 2.5);
  EXPECT_FALSE(ParseStamp("12:30", 1));
  EXPECT_FALSE(ParseStamp("nan", 1));
}

TEST(TimeScale, GpsTimeOfKnownInstants) {
  // Week 2374, Tuesday: 2374 * 604800 + 2 * 86400.
  const auto gps = ParseDateTime("2025-07-08 00:00:00 GPST");
  ASSERT_TRUE(gps);
  EXPECT_EQ(gps->seconds, 2374 * kWeekSeconds + 2 * 86400);
  // Eighteen leap seconds since 2017.
  const auto utc = ParseDateTime("2025/07/08 00:00:00.5 UTC");
  ASSERT_TRUE(utc);
  EXPECT_DOUBLE_EQ(utc->Since(*gps), 18.5);
  EXPECT_EQ(ParseDateTime("1980-01-06 00:00:00 UTC")->seconds, 0);
}

TEST(TimeScale, LeapSecondOfTheEndOf2016) {
  const auto before = ParseDateTime("2016-12-31 23:59:59 UTC");
  const auto inside = ParseDateTime("2016-12-31 23:59:60 UTC");
  const auto after = ParseDateTime("2017-01-01 00:00:00 UTC");
  ASSERT_TRUE(before && inside && after);
  EXPECT_EQ(inside->seconds - before->seconds, 1);
  EXPECT_EQ(after->seconds - before->seconds, 2);
}

TEST(TimeScale, IsoTimesHaveZonesAndLeapSeconds) {
  const auto noon = ParseDateTime("2025-07-08 12:00:00.25 UTC");
  for (const char* text :
       {"2025-07-08T12:00:00.25", "2025-07-08 12:00:00.25Z",
        "2025-07-08T14:00:00.25+02:00", "2025-07-08T08:30:00.25-0330",
        "2025-07-09T02:00:00.25+14"}) {
    const auto stamp = ParseIsoTime(text, true);
    ASSERT_TRUE(stamp) << text;
    EXPECT_EQ(stamp->Since(*noon), 0.0) << text;
  }
  EXPECT_EQ(ParseIsoTime("2025-07-08T12:00:18.25", false)->Since(*noon), 0.0);
  EXPECT_FALSE(ParseIsoTime("2025-07-08T12:00:18Z", false));
  const auto inside = ParseIsoTime("2016-12-31T23:59:60Z", true);
  const auto after = ParseIsoTime("2017-01-01T01:00:00+01:00", true);
  ASSERT_TRUE(inside && after);
  EXPECT_EQ(after->Since(*inside), 1.0);
  for (const char* text : {"2025-07-08", "2025-07-08T", "2025-07-08T25:00:00",
                           "2025-13-08T12:00:00", "2025-07-08T12:00:00+1:00",
                           "2025-07-08T12:00:00+99:00", "12:00:00", "17"}) {
    EXPECT_FALSE(ParseIsoTime(text, true)) << text;
  }
}

TEST(TimeScale, DatesAreReadInTheOrderThatIsSaid) {
  using enum DateOrder;
  const auto eighth = ParseDateTime("2025-07-08 13:04:05.5 UTC");
  const auto since = [&](const char* text, DateOrder order) {
    const auto stamp = ParseIsoTime(text, true, order);
    return stamp ? stamp->Since(*eighth) : -1.0;
  };
  EXPECT_EQ(since("8.7.2025 13:04:05.5", kYearFirst), 0.0);
  EXPECT_EQ(since("08.07.2025T13:04:05.5Z", kMonthFirst), 0.0);
  EXPECT_EQ(since("08/07/2025 13:04:05.5", kDayFirst), 0.0);
  EXPECT_EQ(since("7/8/2025 1:04:05.5 PM", kMonthFirst), 0.0);
  EXPECT_EQ(since("07/08/2025 01:04:05.5 pm", kMonthFirst), 0.0);
  EXPECT_EQ(since("2025/07/08 13:04:05.5", kDayFirst), 0.0);
  EXPECT_EQ(since("2025-07-08 12:04:05.5 AM", kYearFirst), -13.0 * 3600.0);
  EXPECT_EQ(since("2025-07-08 12:04:05.5 PM", kYearFirst), -3600.0);
  for (const char* text :
       {"08/07/2025 13:04:05", "8.7.25 13:04:05", "2025-07-08 13:04:05 PM",
        "2025-07-08 0:04:05 AM", "2025-07-08 13:4:05", "2025-07-08 -1:04:05"}) {
    EXPECT_FALSE(ParseIsoTime(text, true)) << text;
  }
  EXPECT_FALSE(ParseIsoTime("29/06/2025 13:04:05", true, kMonthFirst));
}

TEST(TimeScale, UnixTimeGainsTheLeapSeconds) {
  const Stamp gps = GpsFromUnix({1483228800, 0.25});  // 2017-01-01 UTC
  const auto date = ParseDateTime("2017-01-01 00:00:00 UTC");
  EXPECT_DOUBLE_EQ(gps.Since(*date), 0.25);
}

TEST(TimeScale, RefusesWhatIsNoDate) {
  for (const char* text : {"2025-07-08 00:00:00", "2025-02-30 00:00:00 GPST",
                           "2025-07-08 25:00:00 UTC", "08/07/2025 00:00:00 UTC",
                           "31.02.2025 00:00:00 UTC", "GPST"}) {
    EXPECT_FALSE(ParseDateTime(text)) << text;
  }
}

TEST(TimeScale, FormatReadsBack) {
  const std::int64_t ns = 1'435'000'000'123'456'789;
  const auto again = ParseDateTime(FormatGpsTime(ns));
  ASSERT_TRUE(again);
  EXPECT_EQ(Nanoseconds(*again), ns);
}

TEST(TimeScale, InstantsBefore1980AreFormattedToo) {
  EXPECT_EQ(FormatGpsTime(-500'000'000), "1980-01-05 23:59:59.500000000 GPST");
  EXPECT_EQ(FormatUtcTime(-500'000'000), "1980-01-05T23:59:59.500Z");
  EXPECT_EQ(GpsWeekOf(-500'000'000).week, -1);
  EXPECT_EQ(GpsWeekOf(-500'000'000).seconds,
            static_cast<double>(kWeekSeconds) - 0.5);
}

/// Of the International Earth Rotation Service, as the system has them: lines
/// of seconds since 1900 and TAI - UTC from then on, which is 19 s at the
/// beginning of GPS time.
TEST(TimeScale, LeapSecondsAreThoseOfTheSystem) {
  std::ifstream file("/usr/share/zoneinfo/leap-seconds.list");
  if (!file) GTEST_SKIP() << "the system has no list of leap seconds";
  const std::int64_t epoch =
      std::int64_t{(70 * 365 + 17) * 24} * 3600;  // 1970 since 1900
  int count = 0;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::int64_t since_1900 = 0;
    int tai = 0;
    if (!(words >> since_1900 >> tai) || tai < 19) continue;
    const std::int64_t since_1970 = since_1900 - epoch;
    EXPECT_EQ(LeapSeconds(since_1970), tai - 19) << line;
    EXPECT_EQ(LeapSeconds(since_1970 - 1), std::max(0, tai - 20)) << line;
    ++count;
  }
  EXPECT_GE(count, 19);
}

}  // namespace
}  // namespace hindsight
