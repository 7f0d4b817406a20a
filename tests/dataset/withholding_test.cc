#include <gtest/gtest.h>

#include "base/error.h"
#include "dataset/dataset.h"

namespace hindsight {
namespace {

/// An IMU from 0 to 100 s and a fix every second from 0.5 s to 99.5 s.
Dataset Recording() {
  Dataset data;
  for (int i = 0; i <= 1000; ++i) {
    data.imu.samples.push_back(
        {0.1 * i, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
  }
  AidingStream stream;
  stream.sensor.name = "gnss";
  for (int i = 0; i < 100; ++i) {
    stream.measurements.push_back({0.5 + i, 0, false, PositionFix{}});
  }
  data.streams.push_back(stream);
  return data;
}

int Withheld(const Dataset& data) {
  int count = 0;
  for (const Measurement& z : data.streams[0].measurements) {
    count += z.withheld ? 1 : 0;
  }
  return count;
}

TEST(Withholding, FirstOutageStartsOnePeriodAfterTheFirstFix) {
  Dataset data = Recording();
  data.withholdings.push_back({"position", 30.0, 10.0, {}});
  ApplyWithholding(&data);
  // 30.5, 60.5 and 90.5 s; the last would end after the last fix.
  ASSERT_EQ(data.outages.size(), 2u);
  EXPECT_DOUBLE_EQ(data.outages[0].t_begin, 30.5);
  EXPECT_DOUBLE_EQ(data.outages[1].t_end, 70.5);
  EXPECT_EQ(Withheld(data), 20);
  EXPECT_FALSE(data.streams[0].measurements[29].withheld);
  EXPECT_TRUE(data.streams[0].measurements[30].withheld);
  EXPECT_TRUE(data.streams[0].measurements[39].withheld);
  EXPECT_FALSE(data.streams[0].measurements[40].withheld);
}

TEST(Withholding, FromMovesTheFirstOutage) {
  Dataset data = Recording();
  data.withholdings.push_back({"gnss", 40.0, 10.0, 5.0});
  ApplyWithholding(&data);
  ASSERT_EQ(data.outages.size(), 3u);
  EXPECT_DOUBLE_EQ(data.outages[0].t_begin, 5.5);
  EXPECT_DOUBLE_EQ(data.outages[2].t_begin, 85.5);
}

TEST(Withholding, TimeOffsetCounts) {
  Dataset data = Recording();
  data.streams[0].sensor.time_offset = 0.25;
  data.withholdings.push_back({"gnss", 30.0, 10.0, {}});
  ApplyWithholding(&data);
  EXPECT_DOUBLE_EQ(data.outages[0].t_begin, 30.75);
  EXPECT_TRUE(data.streams[0].measurements[30].withheld);
}

TEST(Withholding, FixesBeforeTheImuDoNotCountAsFirst) {
  Dataset data = Recording();
  data.imu.samples.erase(data.imu.samples.begin(),
                         data.imu.samples.begin() + 100);
  data.withholdings.push_back({"gnss", 30.0, 10.0, {}});
  ApplyWithholding(&data);
  EXPECT_DOUBLE_EQ(data.outages[0].t_begin, 40.5);
}

TEST(Withholding, FromCountsFromTheStreamsFirstFix) {
  Dataset data = Recording();
  data.imu.samples.erase(data.imu.samples.begin(),
                         data.imu.samples.begin() + 200);
  data.withholdings.push_back({"gnss", 40.0, 10.0, 5.0});
  ApplyWithholding(&data);
  // That of 5.5 s lies before the IMU's record.
  ASSERT_EQ(data.outages.size(), 2u);
  EXPECT_DOUBLE_EQ(data.outages[0].t_begin, 45.5);
  EXPECT_EQ(Withheld(data), 20);
}

TEST(Withholding, ApplyingAgainStartsAfresh) {
  Dataset data = Recording();
  data.withholdings.push_back({"gnss", 30.0, 10.0, {}});
  ApplyWithholding(&data);
  data.withholdings = {{"gnss", 60.0, 5.0, {}}};
  ApplyWithholding(&data);
  EXPECT_EQ(data.outages.size(), 1u);
  EXPECT_EQ(Withheld(data), 5);
}

TEST(Withholding, UnknownNameIsAnError) {
  Dataset data = Recording();
  data.withholdings.push_back({"velocity", 30.0, 10.0, {}});
  EXPECT_THROW(ApplyWithholding(&data), InputError);
}

}  // namespace
}  // namespace hindsight
