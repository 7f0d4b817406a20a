#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/command_line.h"

namespace hindsight {
namespace {

/// A vehicle that never moves, its heading a degree short of north.
TEST(HeadingSensor, GivesTheHeadingOfAVehicleThatNeverMoves) {
  const TemporaryFolder folder;
  WriteFile(folder.path() / "scenario.yaml",
            "start: {position: [48 deg, 11.5 deg, 500 m], heading: 359.9 deg}\n"
            "segments:\n  - {type: stop, duration: 60 s}\n"
            "imu:\n  rate: 50 Hz\n  noise: {gyro: 0.3 deg/sqrt(h), accel: "
            "0.05 m/s/sqrt(h)}\n  gyro_bias_sigma: 50 deg/h\n"
            "  accel_bias_sigma: 1 mg\n"
            "aiding:\n  gnss: {type: position, sigma: 0.5 m}\n"
            "  antennas: {type: heading, rate: 2 Hz, sigma: 0.3 deg, baseline: "
            "[0.3 m, 1.2 m, -0.1 m]}\n");
  ASSERT_EQ(
      Hindsight({"simulate", "scenario.yaml", "--out=data"}, folder.path())
          .status,
      0);
  const Outcome outcome = Hindsight(
      {"run", "data/config.yaml", "--methods=rts", "--out=out"}, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.err << outcome.out;
  const nlohmann::json summary =
      nlohmann::json::parse(ReadFile(folder.path() / "out/summary.json"));
  EXPECT_EQ(summary["start"]["alignment"], "heading");
  EXPECT_LT(summary["start"]["attitude_sigma_deg"][2], 1.3);
  const double error =
      summary["methods"]["rts"]["error"]["attitude_rms_deg"][2];
  EXPECT_LT(error, 0.1);
}

}  // namespace
}  // namespace hindsight
