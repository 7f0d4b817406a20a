#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "app/recording.h"
#include "support/recordings.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;

struct WrongColumns {
  const char*
      columns;  ///< in place of the gyros' or accelerometers' of the file
  int status;
  const char* says;
};

class AxesOfAFlight : public ::testing::TestWithParam<WrongColumns> {};

/// Half a minute to and fro with sigmas that are four times what the innovations
/// say, in which no residual is odd.
TEST_P(AxesOfAFlight, AreToldWhereTheyAreNotWhatIsSaid) {
  const std::filesystem::path recordings = testing::RecordingsFolder();
  if (!std::filesystem::exists(recordings / "drone_paths")) {
    GTEST_SKIP() << "the recording drone_paths is not here";
  }
  std::string config = ReadFile(std::filesystem::path(HINDSIGHT_SOURCE_DIR) /
                                "data" / "drone_path_27.yaml");
  const std::string columns = GetParam().columns;
  const auto begin = config.find("columns: {t: \"time [s]\", accel_x");
  ASSERT_NE(begin, std::string::npos);
  config.replace(begin, config.find('}', begin) + 1 - begin,
                 "columns: {t: \"time [s]\", " + columns + "}");
  const TemporaryFolder folder;
  WriteFile(folder.path() / "flight.yaml", config);
  const Outcome outcome =
      Hindsight({"run", "flight.yaml", "--data-root=" + recordings.string(),
                 "--methods=batch", "--out=out"},
                folder.path());
  EXPECT_EQ(outcome.status, GetParam().status) << outcome.out << outcome.err;
  EXPECT_THAT(
      nlohmann::json::parse(ReadFile(
          folder.path() / "out/summary.json"))["methods"]["batch"]["evidence"]
          .dump(),
      HasSubstr(GetParam().says));
}

INSTANTIATE_TEST_SUITE_P(
    Columns, AxesOfAFlight,
    ::testing::Values(
        WrongColumns{"accel_x: \"Acc_X [m/s^2]\", accel_y: \"-Acc_Y [m/s^2]\", "
                     "accel_z: \"-Acc_Z [m/s^2]\", gyro_x: \"Gyr_X [deg/s]\", "
                     "gyro_y: \"-Gyr_Y [deg/s]\", gyro_z: \"-Gyr_Z [deg/s]\"",
                     0, "position to "},
        WrongColumns{"accel_x: \"Acc_X [m/s^2]\", accel_y: \"-Acc_Y [m/s^2]\", "
                     "accel_z: \"-Acc_Z [m/s^2]\", gyro_x: \"-Gyr_X [deg/s]\", "
                     "gyro_y: \"Gyr_Y [deg/s]\", gyro_z: \"Gyr_Z [deg/s]\"",
                     1, "all gyros have the other sign"},
        WrongColumns{
            "accel_x: \"Acc_Y [m/s^2]\", accel_y: \"-Acc_X [m/s^2]\", "
            "accel_z: \"-Acc_Z [m/s^2]\", gyro_x: \"Gyr_X [deg/s]\", "
            "gyro_y: \"-Gyr_Y [deg/s]\", gyro_z: \"-Gyr_Z [deg/s]\"",
            1,
            "accelerometer x and y stand for each other, with the other "
            "sign"}));

}  // namespace
}  // namespace hindsight
