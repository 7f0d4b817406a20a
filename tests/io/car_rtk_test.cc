#include <gtest/gtest.h>

#include <filesystem>

#include "io/config/config.h"
#include "measurements/sensor_kind.h"
#include "support/recordings.h"

namespace hindsight {
namespace {

TEST(CarRtk, ConfigurationLoadsTheRecording) {
  const std::string source = HINDSIGHT_SOURCE_DIR;
  const std::filesystem::path root = testing::RecordingsFolder();
  if (!std::filesystem::exists(root / "car_rtk")) {
    GTEST_SKIP() << "the recording car_rtk is not here";
  }
  const Dataset data =
      LoadDataset(source + "/data/car_rtk.yaml", {root.string()});
  EXPECT_EQ(data.imu.samples.size(), 54860u);
  EXPECT_NEAR(data.imu.t_begin(), 0.854, 1e-9);
  EXPECT_NEAR(data.imu.t_end(), 549.444, 1e-9);
  // Positions, one in a second, the constraint and the prior on its roll.
  ASSERT_EQ(data.streams.size(), 3u);
  EXPECT_EQ(data.streams[0].measurements.size(), 549u);
  EXPECT_NEAR(data.streams[0].measurements.front().t, -2.501, 1e-9);
  EXPECT_EQ(data.streams[1].sensor.kind, &NonHolonomicKind());
  EXPECT_EQ(data.streams[2].sensor.kind, &VehicleLevelKind());
  ASSERT_EQ(data.outages.size(), 8u);
  EXPECT_NEAR(data.outages[7].t_end - data.outages[0].t_begin, 7 * 60.0 + 15.0,
              1e-9);
}

}  // namespace
}  // namespace hindsight
