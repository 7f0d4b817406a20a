#include "problems/uuv_fusion.h"

#include <gtest/gtest.h>

#include <set>

#include "base/error.h"
#include "evaluation/chi_square.h"
#include "simulation/uuv_path.h"

namespace hindsight {
namespace {

UuvTruth SearchPath() {
  const UuvPath path = MakeUuvPath("lawnmower");
  UuvTruth truth;
  for (int k = 0; k <= 1000; ++k) {
    const PathPoint at = path.At(k);
    ErrorVector x(6);
    x << at.p_n.x(), at.v_n.x(), at.p_n.y(), at.v_n.y(), at.p_n.z(), at.v_n.z();
    truth.push_back(x);
  }
  return truth;
}

double Spatial(const std::vector<UuvFusionResult>& results,
               FusionArchitecture architecture) {
  for (const UuvFusionResult& r : results) {
    if (r.architecture == architecture) return r.spatial.mean;
  }
  return -1.0;
}

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

TEST(UuvFusion, SixteenReadingsAreSelectedByWords) {
  std::set<std::string> names;
  for (const UuvReading& reading : UuvReadings(""))
    names.insert(reading.Name());
  EXPECT_EQ(names.size(), 16u);
  EXPECT_EQ(UuvReadings("")[0].Name(), "sum,diagonal,white,by_noise");
  EXPECT_EQ(UuvReadings("position,alike").size(), 4u);
  EXPECT_THROW(UuvReadings("tidal"), InputError);
  EXPECT_THROW(UuvReadings("white,accumulating"), InputError);
}

TEST(UuvFusion, NoReadingGivesThePapersTable) {
  UuvFusionOptions options;
  options.runs = 2;
  const UuvTruth truth = SearchPath();
  for (const UuvReading& reading : UuvReadings("")) {
    const auto results = SolveUuvFusion(truth, reading, options);
    const double central = Spatial(results, FusionArchitecture::kCentral);
    const double tracks = Spatial(results, FusionArchitecture::kTrackToTrack);
    const double equalised = Spatial(results, FusionArchitecture::kEqualised);
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
  UuvFusionOptions options;
  options.runs = 10;
  constexpr int kEpochs = 500;
  const auto results = SolveMatchedFusion(kEpochs, {9.8, 9.8}, options);
  for (const UuvFusionResult& r : results) {
    switch (r.architecture) {
      case FusionArchitecture::kCentral:
      case FusionArchitecture::kFederated: {
        // Neighbouring epochs are correlated over some ten seconds.
        const Interval bounds =
            AneesBounds(options.runs * kEpochs / 10, 6, 0.999);
        EXPECT_GT(6.0 * r.nees, bounds.lower) << FusionName(r.architecture);
        EXPECT_LT(6.0 * r.nees, bounds.upper) << FusionName(r.architecture);
        break;
      }
      case FusionArchitecture::kCovarianceIntersection:
        EXPECT_LT(r.nees, 1.1);
        break;
      case FusionArchitecture::kTrackToTrack:
        EXPECT_GT(r.nees, 1.3);  // the process noise is common to both
        break;
      case FusionArchitecture::kEqualised:
        EXPECT_GT(r.nees, 2.0);
        EXPECT_GT(r.spatial.mean, 1.1 * results[0].spatial.mean);
        break;
    }
  }
}

TEST(UuvFusion, HistogramCountsEveryEpochAndShowsTheShape) {
  UuvFusionOptions options;
  options.runs = 2;
  for (const UuvFusionResult& r : SolveUuvFusion(SearchPath(), {}, options)) {
    long count = 0;
    double sum = 0.0;
    for (std::size_t i = 0; i < r.spatial.histogram.size(); ++i) {
      count += r.spatial.histogram[i];
      sum += static_cast<double>(r.spatial.histogram[i]) *
             (static_cast<double>(i) + 0.5) * r.spatial.bin;
    }
    EXPECT_EQ(count, 2000);
    EXPECT_NEAR(sum / 2000.0, r.spatial.mean, 0.5 * r.spatial.bin);
    EXPECT_LE(r.spatial.bin, 0.25 * r.spatial.deviation);
    EXPECT_GT(r.spatial.bin, 0.09 * r.spatial.deviation);
  }
}

}  // namespace
}  // namespace hindsight
