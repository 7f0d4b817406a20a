#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <ostream>

#include "app/command_line.h"
#include "support/recordings.h"
#include "support/seed_count.h"

namespace hindsight {
namespace {

struct RealStart {
  std::string recording;  ///< its folder
  std::string config;     ///< in data/
};

void PrintTo(const RealStart& start, std::ostream* out) {
  *out << start.config;
}

class AlignmentOfRecordings : public ::testing::TestWithParam<RealStart> {};

/// None of the configurations gives an attitude: velocity finds it.
TEST_P(AlignmentOfRecordings, StartsFromTheVelocityByDefault) {
  const std::filesystem::path source = HINDSIGHT_SOURCE_DIR;
  const std::filesystem::path recordings = testing::RecordingsFolder();
  if (!std::filesystem::exists(recordings / GetParam().recording)) {
    GTEST_SKIP() << "the recording " << GetParam().recording << " is not here";
  }
  if (testing::kSanitized && GetParam().config == "drone_quad.yaml") {
    GTEST_SKIP() << "a quarter of an hour under a sanitizer";
  }
  const TemporaryFolder folder;
  const Outcome outcome = Hindsight(
      {"run", (source / "data" / GetParam().config).string(),
       "--data-root=" + recordings.string(), "--methods=ekf", "--out=out"},
      folder.path());
  // What the filter makes of the start is not asked here.
  ASSERT_EQ(outcome.err, "") << outcome.out;
  const nlohmann::json start = nlohmann::json::parse(
      ReadFile(folder.path() / "out/summary.json"))["start"];
  EXPECT_EQ(start["alignment"], "velocity") << start;
  EXPECT_LT(start["attitude_sigma_deg"][2], 3.0) << start;
}

INSTANTIATE_TEST_SUITE_P(
    All, AlignmentOfRecordings,
    ::testing::Values(RealStart{"car_rtk", "car_rtk.yaml"},
                      RealStart{"car_ublox", "car_ublox_1.yaml"},
                      RealStart{"car_ublox", "car_ublox_2.yaml"},
                      RealStart{"drone_quad", "drone_quad.yaml"}),
    [](const auto& info) {
      return info.param.config.substr(0, info.param.config.find('.'));
    });

}  // namespace
}  // namespace hindsight
