#include "io/sample_folder.h"

namespace hindsight {
namespace {

/// Heights whose stamps are under test, in a column without a unit of its own.
class Clocks : public SampleFolder {
 protected:
  Clocks() {
    Write("imu.csv", std::string(kRestingImu) + "9.9,0,0,0,0,0,-9.8\n");
  }
  Dataset LoadStamps(const std::vector<std::string>& stamps,
                     const std::string& unit, const std::string& keys,
                     const std::string& epoch = "") const {
    std::string text;
    for (const std::string& stamp : stamps) text += stamp + " 1 1\n";
    Write("h.txt", text);
    Write("config.yaml",
          epoch +
              "imu:\n  file: imu.csv\n  max_gap: 10 s\n"
              "  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}\n"
              "aiding:\n  h: {type: height, file: h.txt, format: columns, "
              "columns: {t: '1 [" +
              unit + "]', h: '2 [m]', sigma_h: '3 [m]'}" + keys + "}\n");
    return Load();
  }
  static double Time(const Dataset& data, std::size_t i) {
    return data.streams[0].measurements[i].t;
  }
};

TEST_F(Clocks, StampsInEveryUnit) {
  EXPECT_DOUBLE_EQ(Time(LoadStamps({"1.5"}, "s", ""), 0), 1.5);
  EXPECT_DOUBLE_EQ(Time(LoadStamps({"1500"}, "ms", ""), 0), 1.5);
  EXPECT_DOUBLE_EQ(Time(LoadStamps({"1500000"}, "us", ""), 0), 1.5);
  EXPECT_DOUBLE_EQ(Time(LoadStamps({"1500000000"}, "ns", ""), 0), 1.5);
}

TEST_F(Clocks, SecondsOfWeekGoOverItsEnd) {
  const Dataset data =
      LoadStamps({"604799.5", "0.5"}, "s", ", time: {week: 2374}",
                 "epoch: 2025-07-12 23:59:59 GPST\n");
  EXPECT_NEAR(Time(data, 0), 0.5, 1e-9);
  EXPECT_NEAR(Time(data, 1), 1.5, 1e-9);
}

TEST_F(Clocks, DateAndTimeOfDayInTwoColumns) {
  const std::string epoch = "epoch: 2025-07-12 23:59:59 GPST\n";
  const std::string head =
      epoch +
      "imu:\n  file: imu.csv\n  max_gap: 10 s\n"
      "  noise: {gyro: 0.2 deg/sqrt(h), accel: 70 ug/sqrt(Hz)}\n"
      "aiding:\n  h: {type: height, file: h.txt, format: columns, columns: ";
  const auto times = [&](const std::string& rows, const std::string& columns) {
    Write("h.txt", rows);
    Write("config.yaml", head + columns + "}\n");
    const Dataset data = Load();
    EXPECT_EQ(data.streams[0].measurements.size(), 2u);
    EXPECT_NEAR(Time(data, 0), 1.5, 1e-9) << rows;
    EXPECT_NEAR(Time(data, 1), 2.5, 1e-9) << rows;
  };
  // Separated by blanks, as the numbers are: by number, without and with zones.
  const std::string by_number = "{t: '1 [UTC]', h: '3 [m]', sigma_h: '4 [m]'}";
  times("2025-07-12 23:59:42.5 1 1\n2025-07-12 23:59:43.5 1 1\n", by_number);
  times("2025/07/13 01:59:42.5+02:00 1 1\n2025/07/12 23:59:43.5Z 1 1\n",
        by_number);
  // By title: one for both, or one each.
  const std::string by_title =
      "{t: 'time [GPST]', h: 'alt [m]', sigma_h: 'sd [m]'}";
  const std::string rows =
      "2025-07-13 00:00:00.5 1 1\n2025-07-13 00:00:01.5 1 1\n";
  times("time alt sd\n" + rows, by_title);
  times("time of_day alt sd\n" + rows, by_title);
  // Declared, in any order.
  const std::string declared =
      "{date: 'Date [UTC]', t: Time, h: 'alt [m]', sigma_h: 'sd [m]'}";
  times(
      "Date,Time,alt,sd\n2025-07-12,23:59:42.5,1,1\n"
      "2025-07-12,23:59:43.5,1,1\n",
      declared);
  times(
      "Time,alt,Date,sd\n23:59:42.5,1,2025-07-12,1\n"
      "23:59:43.5,1,2025-07-12,1\n",
      declared);
  Write("config.yaml", head + "{date: 1, t: 2, h: '3 [m]'}}\n");
  EXPECT_NE(LoadError().find("date: expected COLUMN [UTC] or COLUMN [GPST]"),
            std::string::npos)
      << LoadError();
  Write("h.txt", "2025-07-12,23:61:42.5,1,1\n");
  Write("config.yaml",
        head + "{date: '1 [UTC]', t: 2, h: '3 [m]', sigma_h: '4 [m]'}}\n");
  EXPECT_NE(LoadError().find("'2025-07-12 23:61:42.5' is not a time"),
            std::string::npos)
      << LoadError();
}

TEST_F(Clocks, DatesOfIso8601) {
  const std::string epoch = "epoch: 2025-07-12 23:59:59 GPST\n";
  const Dataset gps = LoadStamps({"2025-07-13T00:00:00.5"}, "GPST", "", epoch);
  EXPECT_NEAR(Time(gps, 0), 1.5, 1e-9);
  const Dataset utc =
      LoadStamps({"2025-07-12T23:59:42.5Z", "2025-07-13T01:59:43.5+02:00"},
                 "UTC", "", epoch);
  EXPECT_NEAR(Time(utc, 0), 1.5, 1e-9);
  EXPECT_NEAR(Time(utc, 1), 2.5, 1e-9);
  EXPECT_THROW(LoadStamps({"2025-07-12"}, "UTC", "", epoch), InputError);
  EXPECT_NE(LoadError().find("'2025-07-12' is not a time"), std::string::npos)
      << LoadError();
}

TEST_F(Clocks, WeekNumbersThatStartedAgainFromZero) {
  const Dataset data =
      LoadStamps({"1.5"}, "s", ", time: {week: 327, week_rollovers: 2}",
                 "epoch: 2025-07-13 00:00:00 GPST\n");
  EXPECT_NEAR(Time(data, 0), 1.5, 1e-9);
}

TEST_F(Clocks, RowNumbersAndStretchedClocks) {
  const Dataset rows =
      LoadStamps({"7", "3", "9"}, "s", ", time: {rate: 2 Hz, start: -0.44 s}");
  EXPECT_NEAR(Time(rows, 2), 0.56, 1e-12);
  const Dataset stretched =
      LoadStamps({"10", "12"}, "s",
                 ", time: {start: 1 s, stretch: 0.9975}, time_offset: 30 ms");
  EXPECT_NEAR(Time(stretched, 1), 1.0 + 2.0 * 0.9975, 1e-12);
  EXPECT_DOUBLE_EQ(stretched.streams[0].sensor.time_offset, 0.03);
}

TEST_F(Clocks, PartOfAStream) {
  const Dataset data = LoadStamps({"1", "2", "3", "4"}, "s",
                                  ", time: {from: 1 s, until: 2.5 s}");
  ASSERT_EQ(data.streams[0].measurements.size(), 2u);
  EXPECT_DOUBLE_EQ(Time(data, 0), 2.0);
  EXPECT_EQ(data.policies.back().count, 2);
}

TEST_F(Clocks, RowsOutOfOrderAreAnErrorOrSorted) {
  EXPECT_THROW(LoadStamps({"1", "3", "2"}, "s", ""), InputError);
  EXPECT_EQ(LoadError().find("h.txt:3: time runs backwards"), 0u)
      << LoadError();
  const Dataset data = LoadStamps({"1", "3", "2"}, "s", ", on_unordered: sort");
  ASSERT_EQ(data.streams[0].measurements.size(), 3u);
  EXPECT_DOUBLE_EQ(Time(data, 1), 2.0);
  EXPECT_DOUBLE_EQ(Time(data, 2), 3.0);
  EXPECT_EQ(data.policies.back().action, "row out of order sorted");
  EXPECT_EQ(data.policies.back().count, 1);
}

}  // namespace
}  // namespace hindsight
