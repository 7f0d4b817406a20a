#include "problems/papers/observer_comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "base/chi_square.h"
#include "base/units.h"
#include "support/in_flight.h"
#include "support/seed_count.h"
#include "support/study.h"

namespace hindsight {
namespace {

using Values = std::map<std::string, double>;

Values Named(const std::vector<std::pair<std::string, double>>& values) {
  return {values.begin(), values.end()};
}

const PerfectRecording& Recording(double rate_hz) {
  static const PerfectRecording fast(InFlightAlignment());
  static const PerfectRecording slow(InFlightAlignment(1.0));
  return rate_hz > 5.0 ? fast : slow;
}

Case StartAt(double rate_hz, double tilt_deg, double heading_deg,
             const std::vector<ObserverModel>& models) {
  const hindsight::Recording recording = [=](std::uint64_t seed) {
    Dataset dataset = Recording(rate_hz).Realize(seed);
    GiveBadStart({tilt_deg * kDegree, heading_deg * kDegree}, seed, &dataset);
    return dataset;
  };
  return {{std::to_string(heading_deg)},
          [recording] { return recording; },
          ObserverTrial(models)};
}

ObserverModel Kalman(ErrorDefinition error) { return {"ekf", {error, {}}}; }

ObserverModel HInfinity(double gamma) {
  ObserverModel model{"hinf", {ErrorDefinition::kLeftInvariant, {}}};
  model.model.covariance.rule = RiccatiRule::kHInfinity;
  model.model.covariance.gamma = gamma;
  return model;
}

/// The rows are by case, then by model.
StudyResult Observe(const std::vector<Case>& cases, int runs, int threads = 1) {
  return testing::RunStudy({"", {}, {Under({"start"}, ObserverTable())}, cases},
                           {.runs = runs, .threads = threads});
}

double Of(const StudyResult& result, std::size_t row, const char* figure) {
  return testing::ValueOf(result, result.rows[0][row].labels, figure);
}

TEST(ObserverComparison, TheErrorDefinitionDecidesFrom120DegreesOfHeading) {
  const StudyResult cells =
      Observe({StartAt(10.0, 10.0, 120.0,
                       {Kalman(ErrorDefinition::kNavigation),
                        Kalman(ErrorDefinition::kLeftInvariant)})},
              24);
  // 8 % of the runs of the one diverge, none of 300 of the other.
  EXPECT_GT(Of(cells, 0, "diverged"), 0.0);
  EXPECT_LT(Of(cells, 0, "diverged"), 8.0 / 24.0);
  EXPECT_EQ(Of(cells, 1, "diverged"), 0.0);
  EXPECT_EQ(Of(cells, 1, "converged"), 1.0);
  EXPECT_LT(Of(cells, 1, "t_settled_95"), 13.0);
  EXPECT_LT(Of(cells, 1, "tilt_50"), 0.03 * kDegree);
  EXPECT_LT(Of(cells, 1, "heading_50"), 0.03 * kDegree);
}

TEST(ObserverComparison, EscapesNotBeforeGammaSquaredOverTheCovariance) {
  // In straight flight only the tilt that goes with a heading error tells of
  // it: information delays the escape, but not to the first turn.
  constexpr double kGamma = 1.0;
  const StudyResult cells =
      Observe({StartAt(10.0, 10.0, 120.0, {HInfinity(kGamma)})}, 10);
  const double expected = std::pow(kGamma / (120.0 * kDegree), 2);
  ASSERT_LT(expected, kFirstManoeuvre);
  EXPECT_EQ(Of(cells, 0, "escaped"), 1.0);
  EXPECT_EQ(Of(cells, 0, "diverged"), 1.0);
  EXPECT_EQ(Of(cells, 0, "converged"), 0.0);
  EXPECT_TRUE(std::isinf(Of(cells, 0, "t_settled_50")));
  EXPECT_GT(Of(cells, 0, "t_escape"), 0.95 * expected);
  EXPECT_LT(Of(cells, 0, "t_escape"), kFirstManoeuvre);
}

TEST(ObserverComparison, ThreadsAndOtherCellsChangeNoBit) {
  const ObserverModel navigation = Kalman(ErrorDefinition::kNavigation);
  const ObserverModel group = Kalman(ErrorDefinition::kLeftInvariant);
  const std::vector<ObserverModel> models = {navigation, HInfinity(20.0),
                                             group};
  const StudyResult all = Observe(
      {StartAt(1.0, 30.0, 175.0, models), StartAt(1.0, 10.0, 60.0, models)}, 6,
      2);
  const StudyResult one = Observe({StartAt(1.0, 10.0, 60.0, {group})}, 6, 1);
  for (const char* figure : {"tilt_95", "heading_50", "v_last"}) {
    EXPECT_EQ(Of(all, 5, figure), Of(one, 0, figure)) << figure;
  }
}

TEST(ObserverComparison, ConsistentFromASmallStart) {
  constexpr int kRuns = testing::SeedCount(40);
  double sum = 0.0;
  for (int i = 0; i < kRuns; ++i) {
    Dataset dataset = Recording(1.0).Realize(static_cast<std::uint64_t>(i) + 1);
    GiveBadStart({0.3 * kDegree, 0.5 * kDegree},
                 static_cast<std::uint64_t>(i) + 1, &dataset);
    const Problem problem = AlignmentProblem(dataset);
    sum += Named(RunObserver({}, dataset, problem)).at("v_last");
  }
  const Interval bounds = AneesBounds(kRuns, 12, 0.99);
  EXPECT_TRUE(bounds.Contains(sum / kRuns)) << sum / kRuns;
}

/// Without noise in the data; the filter's own noise stays.
Dataset Noiseless(double tilt_deg, double heading_deg) {
  Scenario scenario = InFlightAlignment(1.0);
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
    const Problem problem = AlignmentProblem(dataset);
    const Values figures = Named(RunObserver({error, {}}, dataset, problem));
    EXPECT_EQ(figures.at("share_falling"), 1.0) << ErrorName(error);
    EXPECT_LE(figures.at("v_last"), figures.at("v_first"));
    EXPECT_EQ(figures.at("v_largest"), figures.at("v_first"));
  }
}

TEST(Lyapunov, RisesOnTheWayFromABadStart) {
  const Dataset dataset = Noiseless(30.0, 175.0);
  const Problem problem = AlignmentProblem(dataset);
  const Values figures = Named(RunObserver({}, dataset, problem));
  EXPECT_LT(figures.at("share_falling"), 1.0);
  EXPECT_GT(figures.at("v_largest"), figures.at("v_first"));
  // Constant biases that nothing tells of yet: no decay is guaranteed.
  EXPECT_EQ(figures.at("radius_first"), 0.0);
}

TEST(Lyapunov, ADegreeOfStabilityWidensTheGuaranteedRadius) {
  const Dataset dataset = Noiseless(1.0, 2.0);
  ForwardModel modified;
  modified.covariance.rule = RiccatiRule::kModifiedHInfinity;
  modified.covariance.alpha = 0.03;
  modified.covariance.alpha_on_all = true;
  const Problem problem = AlignmentProblem(dataset);
  const Values kalman = Named(RunObserver({}, dataset, problem));
  const Values stable = Named(RunObserver(modified, dataset, problem));
  EXPECT_EQ(kalman.at("radius_first"), 0.0);
  EXPECT_GT(stable.at("radius_first"), 1e-6 * kDegree);
  EXPECT_LT(stable.at("radius_first"), 30.0 * kDegree);
}

}  // namespace
}  // namespace hindsight
