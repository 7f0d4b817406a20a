
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "io/config/scenario_config.h"
#include "support/navigation_study.h"
#include "support/study.h"

namespace hindsight {
namespace {

/// 10 m while accelerating for 5 s, then 4 m/s; the last while standing.
const std::vector<double> kReferenceTimes = {502.5, 1002.5, 1502.5, 2005.0};

Scenario TunnelSurvey(const ScenarioChanges& changes = {}) {
  return FindScenario("tunnel_survey", changes);
}

StudyResult Survey(const PerfectRecording& recording,
                   std::vector<std::string> methods, int runs, int threads) {
  return testing::RunStudy(
      testing::NavigationStudy(recording, {.methods = std::move(methods),
                                           .leg_ends = kReferenceTimes}),
      {.runs = runs, .threads = threads});
}

TEST(TunnelSurvey, EveryPathIs8kmIn2005Seconds) {
  for (const std::string path : {"winding", "serpentine", "straight"}) {
    const Scenario scenario = TunnelSurvey({"path=" + path});
    const auto trajectory = MakeTrajectory(scenario);
    EXPECT_NEAR(trajectory->t_end(), 2005.0, 1e-9) << path;
    double length = 0.0;
    constexpr double kStep = 0.01;
    for (int i = 0; i < 200500; ++i) {
      length += kStep * trajectory->At((i + 0.5) * kStep).v_e.norm();
    }
    EXPECT_NEAR(length, 8000.0, 1e-3) << path;
    int turns = 0;
    int ramps = 0;
    for (const Segment& segment : scenario.segments) {
      turns += segment.kind == Segment::Kind::kTurn ? 1 : 0;
      ramps += segment.kind == Segment::Kind::kPitch ? 1 : 0;
    }
    EXPECT_GE(turns, 10) << path;
    EXPECT_GE(ramps, 10) << path;
  }
}

TEST(TunnelSurvey, ReferencePointsStandEvery2Km) {
  const Dataset dataset = Simulate(TunnelSurvey(), 1);
  std::vector<double> times;
  for (const Measurement& z : dataset.streams[1].measurements) {
    times.push_back(z.t);
  }
  EXPECT_EQ(times, kReferenceTimes);
}

TEST(TunnelSurvey, RefusesWhatCannotBe) {
  EXPECT_THROW(TunnelSurvey({"path=circular"}), InputError);
  EXPECT_THROW(TunnelSurvey({"aiding.odometer.sigma=0 m/s"}), InputError);
  EXPECT_THROW(TunnelSurvey({"aiding.reference.spacing=0 m"}), InputError);
}

TEST(TunnelSurvey, MethodsAgreeAsTheirLinearisationsSay) {
  const PerfectRecording recording(TunnelSurvey());
  const StudyResult result =
      Survey(recording,
             {"two_filter", "two_filter_conventional", "two_filter_euler",
              "rts", "iterated", "batch"},
             2, 2);
  EXPECT_EQ(testing::ValueOf(result, {"batch"}, "states"), 16);
  const auto agreement = [&](const char* first, const char* second,
                             const char* figure) {
    return testing::ValueOf(result, {first, second}, figure, kAgreement);
  };
  EXPECT_LT(agreement("two_filter", "rts", "position"), 1e-6);
  EXPECT_LT(agreement("two_filter", "rts", "attitude"), 1e-9);
  EXPECT_LT(agreement("two_filter_conventional", "two_filter", "position"),
            1e-4);
  EXPECT_LT(agreement("batch", "iterated", "position"), 1e-3);
  // First order only: far apart where the filter is, close where it is not.
  EXPECT_GT(agreement("two_filter_euler", "two_filter", "position"),
            10.0 * agreement("two_filter_euler", "two_filter",
                             "position_after_first_leg"));
}

TEST(TunnelSurvey, ResultsDoNotDependOnTheNumberOfThreads) {
  const PerfectRecording recording(TunnelSurvey());
  const StudyResult one = Survey(recording, {"two_filter"}, 3, 1);
  const StudyResult three = Survey(recording, {"two_filter"}, 3, 3);
  EXPECT_EQ(one.rows[0][0].curves, three.rows[0][0].curves);
  EXPECT_EQ(testing::ValueOf(one, {"two_filter"}, "nis"),
            testing::ValueOf(three, {"two_filter"}, "nis"));
}

TEST(TunnelSurvey, IterationRepairsTheOverconfidenceOfTheFirstLeg) {
  const PerfectRecording recording(TunnelSurvey({"path=straight"}));
  constexpr int kRuns = 12;
  const StudyResult result =
      Survey(recording, {"two_filter", "iterated"}, kRuns, 2);
  // Epochs of a leg are correlated; four standard deviations of one epoch.
  const double bound = 4.0 * std::sqrt(2.0 * 16.0 / kRuns);
  EXPECT_GT(testing::ValueOf(result, {"two_filter"}, "leg1_anees"),
            16.0 + bound);
  EXPECT_NEAR(testing::ValueOf(result, {"iterated"}, "leg1_anees"), 16.0,
              bound);
}

}  // namespace
}  // namespace hindsight
