#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/recording.h"
#include "support/recordings.h"

namespace hindsight {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

/// Beside fixes and an IMU that are better than stated nothing tells whose what is slow is,
/// also where it jumps: it moves nothing, and covariances hold it.
TEST(SlightErrors, AtNearlyEveryFixMoveNothing) {
  const std::filesystem::path root = testing::RecordingsFolder();
  if (!std::filesystem::exists(root / "drone_paths")) {
    GTEST_SKIP() << "the recording drone_paths is not here";
  }
  const TemporaryFolder folder;
  Hindsight({"run", HINDSIGHT_SOURCE_DIR "/data/drone_path_23.yaml",
             "--data-root=" + root.string(), "--methods=batch,robust_batch",
             "--inject=rtk:spikes=0.3m,share=20%,from=28.0s,to=35.5s",
             "--seed=668054", "--out=out"},
            folder.path());
  const nlohmann::json methods = nlohmann::json::parse(
      ReadFile(folder.path() / "out/summary.json"))["methods"];
  const nlohmann::json& robust = methods["robust_batch"];
  const auto error = [](const nlohmann::json& method) {
    return method["error"]["horizontal_rms_m"].get<double>();
  };
  EXPECT_NEAR(error(robust), error(methods["batch"]), 0.001);
  const auto found = robust["found"].get<std::vector<std::string>>();
  EXPECT_THAT(found, Contains(HasSubstr("slight at nearly every fix")));
  EXPECT_THAT(found, Contains(HasSubstr("covariances hold it")));
}

}  // namespace
}  // namespace hindsight
