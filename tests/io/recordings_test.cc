#include "support/recordings.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "io/config/config.h"

namespace hindsight {
namespace {

/// A configuration of data/ and what its files hold.
struct Recording {
  const char* name;
  const char* folder;
  std::size_t samples;
  std::size_t streams;
  std::size_t fixes;  ///< of the first stream
  bool position_truth;
};

void PrintTo(const Recording& recording, std::ostream* out) {
  *out << recording.name;
}

class Recordings : public ::testing::TestWithParam<Recording> {};

TEST_P(Recordings, ConfigurationLoads) {
  const Recording& expected = GetParam();
  const std::string source = HINDSIGHT_SOURCE_DIR;
  const std::filesystem::path root = testing::RecordingsFolder();
  if (!std::filesystem::exists(root / expected.folder)) {
    GTEST_SKIP() << "the recording " << expected.folder << " is not here";
  }
  const Dataset data =
      LoadDataset(source + "/data/" + expected.name + ".yaml", {root.string()});
  EXPECT_EQ(data.imu.samples.size(), expected.samples);
  ASSERT_EQ(data.streams.size(), expected.streams);
  EXPECT_EQ(data.streams[0].measurements.size(), expected.fixes);
  ASSERT_FALSE(data.truth.empty());
  EXPECT_EQ(data.truth[0].p_e.has_value(), expected.position_truth);
}

INSTANTIATE_TEST_SUITE_P(
    All, Recordings,
    ::testing::Values(
        Recording{"car_odometer", "car_odometer", 6256, 3, 60, true},
        Recording{"car_ublox_1", "car_ublox", 39703, 4, 799, true},
        Recording{"car_ublox_2", "car_ublox", 52994, 4, 1065, true},
        Recording{"drone_quad", "drone_quad", 40520, 4, 4235, false},
        Recording{"auv_dvl_2", "auv_dvl", 40000, 1, 400, true},
        Recording{"auv_dvl_4", "auv_dvl", 40000, 1, 400, true},
        Recording{"auv_dvl_5", "auv_dvl", 40000, 1, 400, true},
        Recording{"auv_dvl_12", "auv_dvl", 40000, 1, 400, true},
        Recording{"auv_dvl_2_fix", "auv_dvl", 40000, 2, 400, true},
        Recording{"auv_dvl_4_fix", "auv_dvl", 40000, 2, 400, true},
        Recording{"auv_dvl_5_fix", "auv_dvl", 40000, 2, 400, true},
        Recording{"auv_dvl_12_fix", "auv_dvl", 40000, 2, 400, true}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace hindsight
