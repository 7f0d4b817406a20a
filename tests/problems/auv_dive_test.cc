#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "base/chi_square.h"
#include "base/units.h"
#include "evaluation/trajectory_error.h"
#include "io/config/config.h"
#include "problems/reconstruction.h"
#include "support/recordings.h"

namespace hindsight {
namespace {

/// Real dives of one vehicle, with INS and DVL alone.
class AuvDive : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const std::string source = HINDSIGHT_SOURCE_DIR;
    const std::filesystem::path root = testing::RecordingsFolder();
    if (!std::filesystem::exists(root / "auv_dvl")) {
      GTEST_SKIP() << "the recording auv_dvl is not here";
    }
    dataset_ =
        LoadDataset(source + "/data/" + GetParam() + ".yaml", {root.string()});
  }

  TrajectoryStatistics Evaluate(const Reconstruction& reconstruction,
                                const Solution& solution) const {
    std::vector<double> times;
    for (const TruthPoint& point : dataset_.truth) {
      if (point.t < solution.states.front().t) continue;
      if (point.t <= solution.states.back().t) times.push_back(point.t);
    }
    const Solution sampled = reconstruction.Sample(solution, times);
    TrajectoryErrorOptions options;
    options.truth_lever_arm_b = dataset_.truth_lever_arm_b;
    options.truth_sigma = dataset_.truth_sigma;
    return EvaluateTrajectory(TableFromSolution(sampled), dataset_.truth,
                              options);
  }

  static const ConstantEstimate& Find(const Solution& solution,
                                      const std::string& name) {
    for (const ConstantEstimate& c : solution.constants) {
      if (c.name == name) return c;
    }
    throw std::out_of_range(name);
  }

  Dataset dataset_;
};

TEST_P(AuvDive, DeadReckoningAndGeometry) {
  Reconstruction reconstruction(dataset_, {});
  for (const std::string method : {"ekf", "rts", "batch"}) {
    const Solution solution = reconstruction.Run(method);
    const TrajectoryStatistics s = Evaluate(reconstruction, solution);
    // The truth is good for 0.2 to 0.3 % of the way.
    EXPECT_LT(*s.final_horizontal, 0.006 * *s.distance) << solution.method;
    EXPECT_LT(s.attitude->axis[0].rms, 0.01 * kDegree) << solution.method;
    // Errors that last for the whole dive are one draw each.
    const double bound = AneesBounds(1, 3, 0.998).upper;
    EXPECT_LT(*s.position_nees, bound) << solution.method;
    EXPECT_LT(*s.velocity_nees, bound) << solution.method;
    EXPECT_LT(*s.attitude_nees, bound) << solution.method;
    // What is known of the vehicle: the log within 0.1 m of the IMU fore and
    // aft, and row k at k + 1.02 s to some 10 ms.
    EXPECT_NEAR(Find(solution, "dvl_lever_arm[x]").value, 0.0, 0.15);
    EXPECT_NEAR(Find(solution, "dvl_time_offset").value, 0.0, 0.03);
    EXPECT_EQ(Find(solution, "dvl_lever_arm[x]").verdict,
              ConstantEstimate::Verdict::kObserved);
    // Without a position nothing tells an error over the ground that lasts.
    const Block& ground = *solution.layout.Find(BlockKind::kGroundBias, 0);
    const ErrorMatrix P = solution.covariances.Get(solution.states.size() - 1);
    EXPECT_GT(std::sqrt(P(ground.offset, ground.offset)),
              0.9 * ground.sigma0.x());
    // In dive 4 something vertical is not modelled, which the innovations show.
    const bool known_doubt = std::string(GetParam()) == "auv_dvl_4";
    EXPECT_EQ(solution.grade, known_doubt ? Grade::kDoubtful : Grade::kUsable)
        << solution.verdict;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Recorded, AuvDive, ::testing::Values("auv_dvl_2", "auv_dvl_4", "auv_dvl_5"),
    [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace hindsight
