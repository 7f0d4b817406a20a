#include "simulation/tunnel_survey.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "evaluation/chi_square.h"
#include "problems/montecarlo.h"

namespace hindsight {
namespace {

MonteCarloOptions Options(int runs, int threads) {
  MonteCarloOptions options;
  options.runs = runs;
  options.threads = threads;
  options.leg_ends = ReferenceTimes(2000.0);
  options.anees_bounds = [](int n, int dim) {
    const Interval bounds = AneesBounds(n, dim, 0.95);
    return std::pair(bounds.lower, bounds.upper);
  };
  return options;
}

MonteCarloCase CaseOf(const PerfectRecording& recording,
                      std::vector<std::string> methods) {
  return {"",
          [&recording](std::uint64_t seed) { return recording.Realize(seed); },
          std::move(methods)};
}

const Agreement& Find(const MonteCarloResult& result, const std::string& first,
                      const std::string& second) {
  for (const Agreement& a : result.agreements) {
    if (a.first == first && a.second == second) return a;
  }
  throw std::logic_error("no agreement of " + first + " and " + second);
}

TEST(TunnelSurvey, EveryPathIs8kmIn2005Seconds) {
  for (const std::string& path : TunnelPathNames()) {
    TunnelSurveyOptions options;
    options.path = path;
    const Scenario scenario = TunnelSurvey(options);
    const auto trajectory = MakeTrajectory(scenario);
    EXPECT_NEAR(trajectory->t_end(), 2005.0, 1e-9) << path;
    double length = 0.0;
    constexpr double kStep = 0.01;
    for (int i = 0; i < 200500; ++i) {
      length += kStep * trajectory->At((i + 0.5) * kStep).v_e.norm();
    }
    EXPECT_NEAR(length, kTunnelLength, 1e-3) << path;
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
  const std::vector<double> times = ReferenceTimes(2000.0);
  ASSERT_EQ(times.size(), 4U);
  // 10 m while accelerating for 5 s, then 4 m/s; the last while standing.
  EXPECT_DOUBLE_EQ(times[0], 502.5);
  EXPECT_DOUBLE_EQ(times[1], 1002.5);
  EXPECT_DOUBLE_EQ(times[2], 1502.5);
  EXPECT_DOUBLE_EQ(times[3], 2005.0);
}

TEST(TunnelSurvey, RefusesWhatCannotBe) {
  TunnelSurveyOptions options;
  options.path = "circular";
  EXPECT_THROW(TunnelSurvey(options), InputError);
  options = {};
  options.odometer_sigma = 0.0;
  EXPECT_THROW(TunnelSurvey(options), InputError);
}

TEST(TunnelSurvey, MethodsAgreeAsTheirLinearisationsSay) {
  const PerfectRecording recording(TunnelSurvey({}));
  const MonteCarloResult result = RunMonteCarlo(
      {CaseOf(recording, {"two_filter", "two_filter_conventional",
                          "two_filter_euler", "rts", "iterated", "batch"})},
      Options(2, 2));
  EXPECT_EQ(result.dim, 16);
  const Agreement& rts = Find(result, "two_filter", "rts");
  EXPECT_LT(rts.position, 1e-6);
  EXPECT_LT(rts.attitude, 1e-9);
  EXPECT_LT(Find(result, "two_filter", "two_filter_conventional").position,
            1e-4);
  EXPECT_LT(Find(result, "iterated", "batch").position, 1e-3);
  // First order only: far apart where the filter is, close where it is not.
  const Agreement& euler = Find(result, "two_filter", "two_filter_euler");
  EXPECT_GT(euler.position, 10.0 * euler.position_after_first_leg);
}

TEST(TunnelSurvey, ResultsDoNotDependOnTheNumberOfThreads) {
  const PerfectRecording recording(TunnelSurvey({}));
  const MonteCarloCase c = CaseOf(recording, {"two_filter"});
  const MonteCarloResult one = RunMonteCarlo({c}, Options(3, 1));
  const MonteCarloResult three = RunMonteCarlo({c}, Options(3, 3));
  EXPECT_EQ(one.methods[0].anees_series, three.methods[0].anees_series);
  EXPECT_EQ(one.methods[0].std_series, three.methods[0].std_series);
  EXPECT_EQ(one.methods[0].nis, three.methods[0].nis);
}

TEST(TunnelSurvey, IterationRepairsTheOverconfidenceOfTheFirstLeg) {
  TunnelSurveyOptions options;
  options.path = "straight";
  const PerfectRecording recording(TunnelSurvey(options));
  constexpr int kRuns = 12;
  const MonteCarloResult result = RunMonteCarlo(
      {CaseOf(recording, {"two_filter", "iterated"})}, Options(kRuns, 2));
  // Epochs of a leg are correlated; four standard deviations of one epoch.
  const double bound = 4.0 * std::sqrt(2.0 * 16.0 / kRuns);
  EXPECT_GT(result.methods[0].legs[0].anees, 16.0 + bound);
  EXPECT_NEAR(result.methods[1].legs[0].anees, 16.0, bound);
}

}  // namespace
}  // namespace hindsight
