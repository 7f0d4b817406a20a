#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <memory>

#include "base/chi_square.h"
#include "dataset/timeline_builder.h"
#include "filters/imm_smoother.h"
#include "io/config/scenario_config.h"
#include "measurements/sensor_kind.h"
#include "problems/papers/jump_comparison.h"
#include "problems/position_imm.h"
#include "problems/reconstruction.h"
#include "support/study.h"
#include "support/truth_at.h"

namespace hindsight {
namespace {

StudyResult Compare(const std::string& profile, double sigma, int runs,
                    std::uint64_t first_seed = 1) {
  const PerfectRecording recording(FindScenario(
      "gps_jumps", {"errors=" + profile,
                    "aiding.gnss.sigma=" + std::to_string(sigma) + " m"}));
  const Recording realize = [&](std::uint64_t seed) {
    return recording.Realize(seed);
  };
  return testing::RunStudy({"",
                            {},
                            {JumpTable()},
                            {{{}, [realize] { return realize; }, JumpTrial()}}},
                           {.runs = runs, .first_seed = first_seed});
}

double PositionRms(const StudyResult& all, const char* method) {
  return testing::ValueOf(all, {method}, "position_rms");
}

/// A figure against time.
std::vector<double> CurveOf(const StudyResult& all, const char* method,
                            const std::string& name) {
  const std::vector<FigureCurve>& curves = all.tables[0].curves;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (curves[i].name == name) return testing::RowOf(all, {method}).curves[i];
  }
  throw std::logic_error(name);
}

TEST(PositionImm, HasThePapersEighteenStates) {
  const Dataset dataset = Simulate(FindScenario("gps_jumps"), 1);
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

/// Means over times in [from, to] of the north position's RMS, and its peak.
struct North {
  double mean = 0.0;
  double peak = 0.0;
};

North NorthOver(const StudyResult& all, const char* method, double from,
                double to) {
  North out;
  int count = 0;
  const std::vector<double> rms = CurveOf(all, method, "position_rms_n");
  const std::vector<double>& t = testing::RowOf(all, {method}).t;
  for (std::size_t k = 0; k < t.size(); ++k) {
    if (t[k] < from || t[k] > to) continue;
    out.mean += rms[k];
    out.peak = std::max(out.peak, rms[k]);
    ++count;
  }
  out.mean /= count;
  return out;
}

TEST(PositionImm, KeepsThePapersBoundsOnPulses) {
  const StudyResult all = Compare("pulses", 1.0, 4);
  EXPECT_LT(NorthOver(all, "imm", 140.0, 200.0).mean, 0.45);
  EXPECT_LT(NorthOver(all, "imm", 140.0, 160.0).peak, 0.7);
  EXPECT_LT(NorthOver(all, "imm", 120.0, 130.0).peak, 0.95);
  EXPECT_GT(NorthOver(all, "kf0", 140.0, 200.0).mean, 1.5);
  EXPECT_GT(NorthOver(all, "kf1", 140.0, 200.0).mean, 1.5);
  const std::vector<double> wide = CurveOf(all, "imm", "probability_0");
  const std::vector<double> narrow = CurveOf(all, "imm", "probability_1");
  const FigureRow& imm = testing::RowOf(all, {"imm"});
  double quiet = 0.0;
  int count = 0;
  for (std::size_t k = 0; k < imm.t.size(); ++k) {
    const double t = imm.t[k];
    EXPECT_NEAR(wide[k] + narrow[k], 1.0, 1e-9);
    if (t >= 140.0 && t < 150.0) {
      EXPECT_GT(wide[k], 0.99) << t;
    }
    if (t < 10.0 || (t >= 120.0 && t < 126.0) || (t >= 140.0 && t < 151.0)) {
      continue;
    }
    quiet += wide[k];
    ++count;
  }
  EXPECT_LT(quiet / count, 0.01);
  EXPECT_EQ(all.rows[0].size(), 8u);
  for (const FigureRow& one : all.rows[0]) {
    EXPECT_EQ(testing::ValueOf(all, one.labels, "failed"), 0) << one.labels[0];
    EXPECT_EQ(one.t.size(), imm.t.size()) << one.labels[0];
  }
}

class RobustBatchOn : public ::testing::TestWithParam<const char*> {};

TEST_P(RobustBatchOn, IsNoWorseThanTheImmAndHonest) {
  constexpr int kRuns = 2;
  constexpr std::uint64_t kTookNoPart = 901;  // in any choice
  const StudyResult all = Compare(GetParam(), 1.0, kRuns, kTookNoPart);
  EXPECT_EQ(testing::ValueOf(all, {"robust_batch"}, "failed"), 0);
  EXPECT_LT(PositionRms(all, "robust_batch"), 1.05 * PositionRms(all, "imm"));
  // When an error began is one guess a run, which moves all positions under it:
  // at worst a run is one draw of two components.
  EXPECT_LT(testing::ValueOf(all, {"robust_batch"}, "anees_horizontal"),
            AneesBounds(kRuns, 2, 0.98).upper);
  const std::string profile = GetParam();
  if (profile == "steps" || profile == "ramp" || profile == "multipath") {
    EXPECT_LT(PositionRms(all, "robust_batch"), 0.2 * PositionRms(all, "imm"));
  }
}

INSTANTIATE_TEST_SUITE_P(Profiles, RobustBatchOn,
                         ::testing::Values("pulses", "spikes", "steps", "ramp",
                                           "multipath"),
                         [](const auto& info) {
                           return std::string(info.param);
                         });

/// One flight on which the robust batch is right and says so.
void ExpectFound(const std::string& profile, double sigma, std::uint64_t seed,
                 double largest_rms) {
  const StudyResult all = Compare(profile, sigma, 1, seed);
  EXPECT_LT(PositionRms(all, "robust_batch"), largest_rms);
  EXPECT_LT(testing::ValueOf(all, {"robust_batch"}, "anees_horizontal"),
            AneesBounds(1, 2, 0.98).upper);
}

TEST(RobustBatch, RemembersForAHundredSecondsThatItMayBeARamp) {
  // Until it ends, a velocity step of the IMU explains the ramp of this seed as
  // well and is the likelier of the two.
  ExpectFound("ramp", 1.0, 27, 0.5);
}

TEST(RobustBatch, KnowsTheErroneousStretchFromTheGoodOne) {
  // Of this seed a narrow search says that the receiver was wrong before the
  // step and is right after it, until the parameters are fitted.
  ExpectFound("steps", 1.0, 98, 0.5);
}

TEST(RobustBatch, FindsABurstOfWhatSizeItMayBe) {
  ExpectFound("multipath", 0.3, 2, 0.15);
}

TEST(RobustBatch, DoesNotTakeTheFirstFixAtItsWord) {
  // 15 m off for the first 10 s, and nothing else gives a position.
  Dataset dataset = Simulate(FindScenario("short_drive"), 1);
  for (auto& stream : dataset.streams) {
    if (!stream.sensor.kind->is_position) continue;
    for (Measurement& z : stream.measurements.Edited()) {
      auto& fix = std::get<PositionFix>(z.model);
      if (z.t > 10.0) continue;
      fix.p_e += NedAxes(fix.p_e) * Eigen::Vector3d(15.0, 0.0, 0.0);
    }
  }
  Reconstruction reconstruction(dataset, {});
  const Solution solution = reconstruction.Run("robust_batch");
  const State& x = solution.states.back();
  const Eigen::Vector2d e =
      (x.C_en().transpose() *
       (testing::TruthAt(dataset, x.t).p_e.value() - x.p_e))
          .head<2>();
  const Eigen::Matrix2d P = solution.covariances.Get(solution.states.size() - 1)
                                .topLeftCorner<2, 2>();
  // Anchored to the first fixes it would be 15 m off and sure of centimetres.
  EXPECT_LT(e.dot(P.llt().solve(e)), -2.0 * std::log(0.01));
}

TEST(RobustBatch, IsTheBatchWhereNothingIsWrong) {
  const StudyResult none = Compare("none", 1.0, 3, 901);
  EXPECT_NEAR(PositionRms(none, "robust_batch"), PositionRms(none, "batch"),
              0.03);
}

}  // namespace
}  // namespace hindsight
