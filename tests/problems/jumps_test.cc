#include <gtest/gtest.h>

#include <cmath>

#include "dataset/timeline_builder.h"
#include "filters/imm_smoother.h"
#include "problems/jump_comparison.h"
#include "problems/position_imm.h"
#include "problems/reconstruction.h"
#include "simulation/gps_jumps.h"

namespace hindsight {
namespace {

const JumpStatistics& Find(const std::vector<JumpStatistics>& all,
                           const std::string& name) {
  for (const JumpStatistics& one : all) {
    if (one.name == name) return one;
  }
  throw std::logic_error(name);
}

std::vector<JumpStatistics> Compare(const std::string& profile, double sigma,
                                    int runs) {
  const PerfectRecording recording(GpsJumps({profile, sigma, 1.0}));
  MonteCarloOptions options;
  options.runs = runs;
  return CompareOnJumps(
      [&](std::uint64_t seed) { return recording.Realize(seed); }, options);
}

TEST(PositionImm, HasThePapersEighteenStates) {
  const Dataset dataset = Simulate(GpsJumps({}), 1);
  const double forever = std::numeric_limits<double>::infinity();
  const Start start = FindStart(dataset, -forever, forever);
  const std::vector<ImmModel> models =
      PositionImmModels(dataset, start, PositionImmOptions{});
  ASSERT_EQ(models.size(), 2u);
  for (const ImmModel& model : models) {
    EXPECT_EQ(model.layout.dim(), 18);
    EXPECT_FALSE(model.layout.Find(BlockKind::kPosition)->active[2]);
    EXPECT_FALSE(model.layout.Find(BlockKind::kVelocity)->active[2]);
  }
  // (beta, A) = (10, 20): nearly white at 1 Hz, with standard deviation A.
  const Evolution& shaping =
      models[0].layout.Find(BlockKind::kColouredNoise, 0)->evolution;
  EXPECT_NEAR(shaping.Phi(1.0), std::exp(-10.0), 1e-12);
  EXPECT_NEAR(shaping.Q(1.0), 400.0 * (1.0 - std::exp(-20.0)), 1e-9);
  EXPECT_NEAR(shaping.Phi(0.1), std::exp(-1.0), 1e-12);
}

TEST(PositionImm, BeatsEitherFilterOnPulses) {
  const std::vector<JumpStatistics> all = Compare("pulses", 1.0, 4);
  const JumpStatistics& imm = Find(all, "imm");
  EXPECT_LT(imm.PositionRms(140.0, 200.0),
            0.5 * Find(all, "kf0").PositionRms(140.0, 200.0));
  EXPECT_LT(imm.PositionRms(140.0, 200.0),
            0.5 * Find(all, "kf1").PositionRms(140.0, 200.0));
  for (std::size_t k = 0; k < imm.t.size(); ++k) {
    EXPECT_NEAR(imm.probabilities[k].sum(), 1.0, 1e-9);
    if (imm.t[k] >= 140.0 && imm.t[k] < 150.0) {
      EXPECT_GT(imm.probabilities[k](0), 0.99) << imm.t[k];
    }
  }
  for (const JumpStatistics& one : all) {
    EXPECT_EQ(one.failed, 0) << one.name;
    EXPECT_EQ(one.t.size(), imm.t.size()) << one.name;
  }
}

TEST(RobustBatch, IsNoWorseThanTheImmAndRejectsPersistentSteps) {
  const std::vector<JumpStatistics> pulses = Compare("pulses", 1.0, 2);
  EXPECT_LT(Find(pulses, "robust_batch").PositionRms(10.0, 250.0),
            1.05 * Find(pulses, "imm").PositionRms(10.0, 250.0));
  const std::vector<JumpStatistics> steps = Compare("steps", 1.0, 2);
  EXPECT_LT(Find(steps, "robust_batch").PositionRms(10.0, 250.0),
            0.2 * Find(steps, "imm").PositionRms(10.0, 250.0));
}

TEST(RobustBatch, IsTheBatchWhereNothingIsWrong) {
  const std::vector<JumpStatistics> none = Compare("none", 1.0, 3);
  EXPECT_NEAR(Find(none, "robust_batch").PositionRms(10.0, 250.0),
              Find(none, "batch").PositionRms(10.0, 250.0), 0.03);
}

}  // namespace
}  // namespace hindsight
