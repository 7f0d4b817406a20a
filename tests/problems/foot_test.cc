#include <gtest/gtest.h>

#include <filesystem>

#include "evaluation/grade.h"
#include "evaluation/trajectory_error.h"
#include "io/config/config.h"
#include "problems/reconstruction.h"
#include "problems/rest_by_estimate.h"
#include "support/recordings.h"

namespace hindsight {
namespace {

/// A walk of 63 m with the IMU on a foot, position from the flags of standing
/// alone, the speed of the shoe in a stance stated as the parameter [m/s].
class Foot : public ::testing::TestWithParam<double> {};

TEST_P(Foot, IsKnownToAMetreAndWhatIsUsableIsHonest) {
  const std::string source = HINDSIGHT_SOURCE_DIR;
  const std::filesystem::path root = testing::RecordingsFolder();
  if (!std::filesystem::exists(root / "foot_zupt")) {
    GTEST_SKIP() << "the recording foot_zupt is not here";
  }
  Dataset dataset =
      LoadDataset(source + "/data/foot_zupt.yaml", {root.string()});
  constexpr double kStated = 0.05;
  for (Measurement& z : dataset.streams.at(0).measurements.Edited()) {
    ScaleSigma(GetParam() / kStated, &z);
  }
  std::vector<double> times;
  for (const TruthPoint& point : dataset.truth) times.push_back(point.t);
  Reconstruction reconstruction(dataset, {});
  for (const std::string method : {"rts", "batch"}) {
    const Solution solution = reconstruction.Run(method);
    const TrajectoryStatistics s = EvaluateTrajectory(
        TableFromSolution(reconstruction.Sample(solution, times)),
        dataset.truth, {.truth_lever_arm_b = dataset.truth_lever_arm_b});
    EXPECT_LT(s.position->horizontal.rms, 0.8) << solution.method;
    if (!solution.usable()) continue;
    EXPECT_LT(*s.position_nees, 3.0 * kDoubtfulError * kDoubtfulError)
        << solution.method;
  }
}

/// Of the stances that the IMU itself shows, with what a shoe may turn and
/// yield in one (data/README.md) as thresholds.
TEST(FootAtRest, IsKnownToAMetreWithoutFlags) {
  const std::string source = HINDSIGHT_SOURCE_DIR;
  const std::filesystem::path root = testing::RecordingsFolder();
  if (!std::filesystem::exists(root / "foot_zupt")) {
    GTEST_SKIP() << "the recording foot_zupt is not here";
  }
  Dataset dataset =
      LoadDataset(source + "/data/foot_rest.yaml", {root.string()});
  AddDecidedRest(dataset.imu.t_begin(), dataset.imu.t_end(), &dataset);
  std::vector<double> times;
  for (const TruthPoint& point : dataset.truth) times.push_back(point.t);
  Reconstruction reconstruction(dataset, {});
  const Solution solution = reconstruction.Run("batch");
  const TrajectoryStatistics s = EvaluateTrajectory(
      TableFromSolution(reconstruction.Sample(solution, times)), dataset.truth,
      {.truth_lever_arm_b = dataset.truth_lever_arm_b});
  EXPECT_LT(s.position->total.rms, 1.0);
  EXPECT_LT(*s.position_nees, 3.0 * kDoubtfulError * kDoubtfulError);
}

INSTANTIATE_TEST_SUITE_P(Recorded, Foot, ::testing::Values(0.05, 0.2));

}  // namespace
}  // namespace hindsight
