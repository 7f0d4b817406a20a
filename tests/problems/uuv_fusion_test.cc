#include "problems/papers/uuv_fusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/chi_square.h"
#include "base/error.h"
#include "io/config/scenario_config.h"
#include "simulation/way_points.h"
#include "support/study.h"

namespace hindsight {
namespace {

UuvTruth SearchPath() {
  const WayPointPath path(FindScenario("uuv_survey").way_points);
  UuvTruth truth;
  for (int k = 0; k <= 1000; ++k) {
    const PathPoint at = path.At(k);
    ErrorVector x(6);
    x << at.p_n.x(), at.v_n.x(), at.p_n.y(), at.v_n.y(), at.p_n.z(), at.v_n.z();
    truth.push_back(x);
  }
  return truth;
}

constexpr const char* kPrinted = "sum,diagonal,white,by_noise";

TEST(UuvFusion, MatricesAreThePrintedOnes) {
  const std::array<LinearSensor, 2> sensors = UuvSensors({});
  ErrorMatrix A(6, 6);
  A << 1, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0, 1, 0, 0,
      0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0, 1;
  RowJacobian H(3, 6);
  H << 1, 1, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 1, 1;
  EXPECT_EQ(sensors[0].A, A);
  EXPECT_EQ(sensors[0].H, H);
  EXPECT_EQ(sensors[0].Q, ErrorMatrix(100.0 * ErrorMatrix::Identity(6, 6)));
  EXPECT_EQ(sensors[1].Q, ErrorMatrix(ErrorMatrix::Identity(6, 6)));
  EXPECT_NEAR(sensors[0].R(0, 0), 96.04, 1e-9);
  EXPECT_NEAR(sensors[1].R(2, 2), 0.0004, 1e-15);
}

TEST(UuvFusion, ThereAreSixteenReadings) {
  std::set<std::string> names;
  for (const UuvReading& reading : UuvReadings()) names.insert(reading.Name());
  EXPECT_EQ(names.size(), 16u);
  EXPECT_EQ(UuvReadings()[0].Name(), "sum,diagonal,white,by_noise");
}

TEST(UuvFusion, NoReadingGivesThePapersTable) {
  Study study = {.tables = {FusionTable()}};
  for (const UuvReading& reading : UuvReadings()) {
    study.cases.push_back(UuvSearch(reading, SearchPath()));
  }
  const StudyResult result = testing::RunStudy(study, {.runs = 2});
  for (const UuvReading& reading : UuvReadings()) {
    const auto mean = [&](FusionArchitecture architecture) {
      return testing::ValueOf(
          result, {reading.Name(), FusionName(architecture)}, "spatial_mean");
    };
    const double central = mean(FusionArchitecture::kCentral);
    const double tracks = mean(FusionArchitecture::kTrackToTrack);
    const double equalised = mean(FusionArchitecture::kEqualised);
    EXPECT_FALSE(std::abs(central - 3.67) < 0.3 &&
                 std::abs(tracks - 1.83) < 0.3 &&
                 std::abs(equalised - 1.38) < 0.3)
        << reading.Name();
    // The paper's order needs a central filter that weighs both alike.
    const bool papers_order =
        central > 1.3 * tracks && tracks > 0.99 * equalised;
    EXPECT_EQ(papers_order, !reading.weighs_by_noise) << reading.Name();
  }
}

TEST(UuvFusion, OnlyDoubleUseOfInformationIsInconsistent) {
  constexpr int kRuns = 10;
  constexpr int kEpochs = 500;
  const StudyResult result = testing::RunStudy(
      {.tables = {FusionTable()},
       .cases = {MatchedSearch("alike", {9.8, 9.8}, kEpochs)}},
      {.runs = kRuns});
  for (const FusionArchitecture architecture : kFusionArchitectures) {
    const std::vector<std::string> labels = {"alike", FusionName(architecture)};
    const double nees = testing::ValueOf(result, labels, "nees");
    switch (architecture) {
      case FusionArchitecture::kCentral:
      case FusionArchitecture::kFederated: {
        // Neighbouring epochs are correlated over some ten seconds.
        const Interval bounds = AneesBounds(kRuns * kEpochs / 10, 6, 0.999);
        EXPECT_GT(6.0 * nees, bounds.lower) << labels[1];
        EXPECT_LT(6.0 * nees, bounds.upper) << labels[1];
        break;
      }
      case FusionArchitecture::kCovarianceIntersection:
        EXPECT_LT(nees, 1.1);
        break;
      case FusionArchitecture::kTrackToTrack:
        EXPECT_GT(nees, 1.3);  // the process noise is common to both
        break;
      case FusionArchitecture::kEqualised:
        EXPECT_GT(nees, 2.0);
        EXPECT_GT(testing::ValueOf(result, labels, "spatial_mean"),
                  1.1 * testing::ValueOf(result, {"alike", "central"},
                                         "spatial_mean"));
        break;
    }
  }
}

/// Over all runs and epochs, as over those of each run.
TEST(UuvFusion, ScatterIsThatOfAllDistances) {
  const StudyResult result =
      testing::RunStudy({.tables = {FusionTable()},
                         .cases = {UuvSearch(UuvReading{}, SearchPath())}},
                        {.runs = 2});
  const std::vector<std::string> labels = {kPrinted, "central"};
  double sum = 0.0, squares = 0.0;
  for (const RunRecord& record : result.records) {
    if (record.labels != labels) continue;
    sum += record.Find("spatial_mean").value() / 2.0;
    squares += std::pow(record.Find("spatial_rms").value(), 2) / 2.0;
  }
  EXPECT_NEAR(testing::ValueOf(result, labels, "spatial_mean"), sum, 1e-12);
  EXPECT_NEAR(testing::ValueOf(result, labels, "spatial_std"),
              std::sqrt(squares - sum * sum), 1e-12);
  EXPECT_LT(testing::ValueOf(result, labels, "spatial_std"), sum);
}

}  // namespace
}  // namespace hindsight
