#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <type_traits>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "io/config/load_streams.h"
#include "io/read/reader.h"
#include "io/recording_folder.h"

namespace hindsight {
namespace {

static_assert(!std::is_move_constructible_v<StreamsBeside>,
              "another thread reads into it");

/// An IMU at rest and many fixes beside it.
class ReadBeside : public RecordingFolder {
 protected:
  ReadBeside() { SetThreadCount(2); }
  ~ReadBeside() override { SetThreadCount(before_); }

  /// `last` is what stands in the last row for a rate.
  void WriteRecording(const std::string& last) const {
    Write("config.yaml",
          "imu:\n"
          "  file: imu.csv\n"
          "  max_gap: 2 s\n"
          "  noise: {gyro: 0.1 deg/sqrt(h), accel: 0.05 m/s/sqrt(h),\n"
          "    gyro_bias_walk: 1e-07 rad/s/sqrt(s),\n"
          "    accel_bias_walk: 1e-05 m/s^2/sqrt(s)}\n"
          "aiding:\n"
          "  gnss: {type: position, file: gnss.csv,\n"
          "    lever_arm: [0 m, 0 m, 0 m]}\n");
    std::string imu =
        "t[s],gyro_x[rad/s],gyro_y[rad/s],gyro_z[rad/s],accel_x[m/s^2],"
        "accel_y[m/s^2],accel_z[m/s^2]\n";
    for (int k = 0; k <= kSeconds; ++k) {
      imu += std::to_string(k) + ",0,0," + (k < kSeconds ? "0" : last) +
             ",0,0,-9.8\n";
    }
    Write("imu.csv", imu);
    std::string gnss =
        "t[s],lat[deg],lon[deg],h[m],sigma_n[m],sigma_e[m],sigma_d[m]\n";
    for (int k = 0; k < kFixes; ++k) {
      gnss += std::to_string(kSeconds * (k / static_cast<double>(kFixes))) +
              ",48,11,500,1,1,1\n";
    }
    Write("gnss.csv", gnss);
  }
  static constexpr int kSeconds = 100;
  static constexpr int kFixes = 1000;

 private:
  const int before_ = ThreadCount();
};

TEST_F(ReadBeside, EndsWithWhatIsWrongWithTheImu) {
  WriteRecording("0");
  EXPECT_EQ(LoadError(), "");
  WriteRecording("x");
  EXPECT_EQ(LoadError(),
            "imu.csv:102: column 4 (gyro_z): 'x' is not a finite number");
}

TEST_F(ReadBeside, OfWhichNobodyWantsTheRowsEndsAtOnce) {
  WriteRecording("0");
  std::atomic<bool> abandoned = false;
  StreamSource source;
  source.name = "truth";
  source.path = Path("gnss.csv");
  source.abandoned = &abandoned;
  StreamClock clock;
  std::vector<PolicyCount> policies;
  EXPECT_EQ(ReadTruth(source, {}, &clock, &policies).size(),
            static_cast<std::size_t>(kFixes));
  abandoned = true;
  EXPECT_THROW(ReadTruth(source, {}, &clock, &policies), Interrupted);
}

}  // namespace
}  // namespace hindsight
