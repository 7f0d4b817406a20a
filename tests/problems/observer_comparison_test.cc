#include "problems/observer_comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "dataset/timeline_builder.h"
#include "evaluation/chi_square.h"
#include "simulation/in_flight_alignment.h"
#include "support/seed_count.h"

namespace hindsight {
namespace {

constexpr ObserverLimits kLimits = {.settled_tilt = 0.5 * kDegree,
                                    .settled_heading = 2.0 * kDegree,
                                    .diverged_tilt = 2.0 * kDegree,
                                    .diverged_heading = 10.0 * kDegree,
                                    .last = 20.0};

const PerfectRecording& Recording(double rate_hz) {
  static const PerfectRecording fast(InFlightAlignment({}));
  static const PerfectRecording slow(
      InFlightAlignment({.velocity_rate_hz = 1.0}));
  return rate_hz > 5.0 ? fast : slow;
}

ObserverRecording At(double rate_hz) {
  return {"", [rate_hz](std::uint64_t seed) {
            return Recording(rate_hz).Realize(seed);
          }};
}

ObserverStart Start(double tilt_deg, double heading_deg) {
  return {"", [=](std::uint64_t seed, Dataset* dataset) {
            GiveBadStart({tilt_deg * kDegree, heading_deg * kDegree}, seed,
                         dataset);
          }};
}

ObserverModel Kalman(ErrorDefinition error) { return {"ekf", {error, {}}}; }

ObserverModel HInfinity(double gamma) {
  ObserverModel model{"hinf", {ErrorDefinition::kLeftInvariant, {}}};
  model.model.covariance.rule = RiccatiRule::kHInfinity;
  model.model.covariance.gamma = gamma;
  return model;
}

Timeline TimelineOf(const Dataset& dataset) {
  TimelineOptions options;
  options.t_begin = dataset.imu.t_begin();
  options.t_end = dataset.imu.t_end();
  return BuildTimeline(dataset, options);
}

MonteCarloOptions Runs(int runs, int threads = 1) {
  MonteCarloOptions options;
  options.runs = runs;
  options.threads = threads;
  return options;
}

TEST(ObserverComparison, TheErrorDefinitionDecidesFrom120DegreesOfHeading) {
  const std::vector<ObserverCell> cells =
      CompareObservers({At(10.0)}, {Start(10.0, 120.0)},
                       {Kalman(ErrorDefinition::kNavigation),
                        Kalman(ErrorDefinition::kLeftInvariant)},
                       kLimits, Runs(24));
  // 8 % of the runs of the one diverge, none of 300 of the other.
  EXPECT_GT(cells[0].diverged, 0);
  EXPECT_LT(cells[0].diverged, 8);
  EXPECT_EQ(cells[1].diverged, 0);
  EXPECT_EQ(cells[1].converged, 24);
  EXPECT_LT(cells[1].t_settled_95, 13.0);
  EXPECT_LT(cells[1].tilt_50, 0.03 * kDegree);
  EXPECT_LT(cells[1].heading_50, 0.03 * kDegree);
}

TEST(ObserverComparison, EscapesNotBeforeGammaSquaredOverTheCovariance) {
  // In straight flight only the tilt that goes with a heading error tells of
  // it: information delays the escape, but not to the first turn.
  constexpr double kGamma = 1.0;
  const std::vector<ObserverCell> cells = CompareObservers(
      {At(10.0)}, {Start(10.0, 120.0)}, {HInfinity(kGamma)}, kLimits, Runs(10));
  const double expected = std::pow(kGamma / (120.0 * kDegree), 2);
  ASSERT_LT(expected, kFirstManoeuvre);
  EXPECT_EQ(cells[0].escaped, 10);
  EXPECT_EQ(cells[0].diverged, 10);
  EXPECT_EQ(cells[0].converged, 0);
  EXPECT_TRUE(std::isinf(cells[0].t_settled_50));
  EXPECT_GT(cells[0].t_escape, 0.95 * expected);
  EXPECT_LT(cells[0].t_escape, kFirstManoeuvre);
}

TEST(ObserverComparison, ThreadsAndOtherCellsChangeNoBit) {
  const ObserverModel navigation = Kalman(ErrorDefinition::kNavigation);
  const ObserverModel group = Kalman(ErrorDefinition::kLeftInvariant);
  const auto all = CompareObservers(
      {At(1.0)}, {Start(30.0, 175.0), Start(10.0, 60.0)},
      {navigation, HInfinity(20.0), group}, kLimits, Runs(6, 2));
  const auto one = CompareObservers({At(1.0)}, {Start(10.0, 60.0)}, {group},
                                    kLimits, Runs(6, 1));
  EXPECT_EQ(all[5].tilt_95, one[0].tilt_95);
  EXPECT_EQ(all[5].heading_50, one[0].heading_50);
  EXPECT_EQ(all[5].lyapunov.v_last, one[0].lyapunov.v_last);
}

TEST(ObserverComparison, ConsistentFromASmallStart) {
  constexpr int kRuns = testing::SeedCount(40);
  double sum = 0.0;
  for (int i = 0; i < kRuns; ++i) {
    Dataset dataset = Recording(1.0).Realize(static_cast<std::uint64_t>(i) + 1);
    GiveBadStart({0.3 * kDegree, 0.5 * kDegree},
                 static_cast<std::uint64_t>(i) + 1, &dataset);
    Timeline timeline = TimelineOf(dataset);
    sum += RunObserver({}, dataset, kLimits, &timeline).lyapunov.v_last;
  }
  const Interval bounds = AneesBounds(kRuns, 12, 0.99);
  EXPECT_TRUE(bounds.Contains(sum / kRuns)) << sum / kRuns;
}

/// Without noise in the data; the filter's own noise stays.
Dataset Noiseless(double tilt_deg, double heading_deg) {
  Scenario scenario = InFlightAlignment({.velocity_rate_hz = 1.0});
  const ImuNoise noise = scenario.imu.noise;
  scenario.imu.noise.gyro_noise_density = 0.0;
  scenario.imu.noise.accel_noise_density = 0.0;
  Dataset dataset = PerfectRecording(scenario).Realize(1);
  dataset.imu.noise = noise;
  for (Measurement& z : dataset.streams[0].measurements.Edited()) {
    for (const TruthPoint& truth : dataset.truth) {
      if (std::abs(truth.t - z.t) < 1e-6) {
        std::get<VelocityFix>(z.model).v_n = truth.v_n.value();
      }
    }
  }
  GiveBadStart({tilt_deg * kDegree, heading_deg * kDegree}, 1, &dataset);
  return dataset;
}

TEST(Lyapunov, FallsAtEveryStepOfANoiselessRunFromASmallStart) {
  for (const ErrorDefinition error :
       {ErrorDefinition::kNavigation, ErrorDefinition::kQuaternion,
        ErrorDefinition::kLeftInvariant}) {
    const Dataset dataset = Noiseless(0.01, 0.02);
    Timeline timeline = TimelineOf(dataset);
    const LyapunovFigures figures =
        RunObserver({error, {}}, dataset, kLimits, &timeline).lyapunov;
    EXPECT_EQ(figures.share_falling, 1.0) << ErrorName(error);
    EXPECT_LE(figures.v_last, figures.v_first);
    EXPECT_EQ(figures.v_largest, figures.v_first);
  }
}

TEST(Lyapunov, RisesOnTheWayFromABadStart) {
  const Dataset dataset = Noiseless(30.0, 175.0);
  Timeline timeline = TimelineOf(dataset);
  const LyapunovFigures figures =
      RunObserver({}, dataset, kLimits, &timeline).lyapunov;
  EXPECT_LT(figures.share_falling, 1.0);
  EXPECT_GT(figures.v_largest, figures.v_first);
  // Constant biases that nothing tells of yet: no decay is guaranteed.
  EXPECT_EQ(figures.radius_first, 0.0);
}

TEST(Lyapunov, ADegreeOfStabilityWidensTheGuaranteedRadius) {
  const Dataset dataset = Noiseless(1.0, 2.0);
  ForwardModel modified;
  modified.covariance.rule = RiccatiRule::kModifiedHInfinity;
  modified.covariance.alpha = 0.03;
  modified.covariance.alpha_on_all = true;
  Timeline a = TimelineOf(dataset);
  Timeline b = TimelineOf(dataset);
  const LyapunovFigures kalman = RunObserver({}, dataset, kLimits, &a).lyapunov;
  const LyapunovFigures stable =
      RunObserver(modified, dataset, kLimits, &b).lyapunov;
  EXPECT_EQ(kalman.radius_first, 0.0);
  EXPECT_GT(stable.radius_first, 1e-6 * kDegree);
  EXPECT_LT(stable.radius_first, 30.0 * kDegree);
  EXPECT_GE(stable.p_largest, kalman.p_largest);
  EXPECT_LE(kalman.p_least, 1.0);
}

}  // namespace
}  // namespace hindsight
