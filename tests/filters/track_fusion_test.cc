#include "filters/track_fusion.h"

#include <gtest/gtest.h>

#include "base/random.h"

namespace hindsight {
namespace {

/// A point on a line with white acceleration, seen by two position sensors.
std::array<LinearSensor, 2> TwoSensors(double first, double second) {
  LinearSensor sensor;
  sensor.A = Eigen::Matrix2d{{1.0, 1.0}, {0.0, 1.0}};
  sensor.Q = Eigen::Matrix2d{{0.4, 0.5}, {0.5, 1.0}};
  sensor.H = Eigen::RowVector2d(1.0, 0.0);
  std::array<LinearSensor, 2> sensors = {sensor, sensor};
  sensors[0].R = RowMatrix::Constant(1, 1, first * first);
  sensors[1].R = RowMatrix::Constant(1, 1, second * second);
  return sensors;
}

Track Unit() { return {Eigen::Vector2d::Zero(), ErrorMatrix::Identity(2, 2)}; }

TEST(TrackFusion, InformationByHand) {
  // Variances 4 and 1: weights 0.2 and 0.8, variance 0.8.
  const Track a = {ErrorVector::Constant(1, 10.0),
                   ErrorMatrix::Constant(1, 1, 4.0)};
  const Track b = {ErrorVector::Constant(1, 0.0),
                   ErrorMatrix::Constant(1, 1, 1.0)};
  const Track fused = FuseByInformation(a, b);
  EXPECT_NEAR(fused.x(0), 2.0, 1e-12);
  EXPECT_NEAR(fused.P(0, 0), 0.8, 1e-12);
}

TEST(TrackFusion, IntersectionOfOneTrackWithItselfIsThatTrack) {
  Track a = Unit();
  a.P(0, 1) = a.P(1, 0) = 0.3;
  a.x << 1.0, -2.0;
  const Track fused = FuseByCovarianceIntersection(a, a);
  EXPECT_LT((fused.P - a.P).norm(), 1e-9);
  EXPECT_LT((fused.x - a.x).norm(), 1e-9);
  // Information fusion takes it for news.
  EXPECT_LT((FuseByInformation(a, a).P - 0.5 * a.P).norm(), 1e-12);
}

TEST(TrackFusion, IntersectionTakesFromEachWhatItKnows) {
  const Track a = {Eigen::Vector2d(1.0, 0.0),
                   Eigen::Vector2d(0.01, 100.0).asDiagonal()};
  const Track b = {Eigen::Vector2d(0.0, 1.0),
                   Eigen::Vector2d(100.0, 0.01).asDiagonal()};
  const Track fused = FuseByCovarianceIntersection(a, b);
  EXPECT_LT((fused.x - Eigen::Vector2d(1.0, 1.0)).norm(), 1e-3);
  EXPECT_NEAR(fused.P.trace(), 0.04, 1e-4);
}

TEST(TrackFusion, CentralIsTheKalmanFilterOfTheStackedMeasurement) {
  const auto sensors = TwoSensors(2.0, 0.5);
  const auto fusion = MakeFusion(FusionArchitecture::kCentral, sensors, Unit());
  LinearSensor stacked = sensors[0];
  stacked.H = Eigen::Matrix2d{{1.0, 0.0}, {1.0, 0.0}};
  stacked.R = Eigen::Vector2d(4.0, 0.25).asDiagonal();
  Track expected = Unit();
  for (int k = 0; k < 5; ++k) {
    const Track fused = fusion->Step(RowVector::Constant(1, k + 0.1),
                                     RowVector::Constant(1, k - 0.2));
    Predict(stacked, &expected);
    Correct(stacked, Eigen::Vector2d(k + 0.1, k - 0.2), &expected);
    EXPECT_LT((fused.x - expected.x).norm(), 1e-12);
    EXPECT_LT((fused.P - expected.P).norm(), 1e-12);
  }
}

TEST(TrackFusion, FederatedWithResetIsCentral) {
  // Carlson 1990: shared process and prior information add up to the whole.
  const auto sensors = TwoSensors(2.0, 0.5);
  const auto central =
      MakeFusion(FusionArchitecture::kCentral, sensors, Unit());
  const auto federated =
      MakeFusion(FusionArchitecture::kFederated, sensors, Unit());
  for (int k = 0; k < 20; ++k) {
    const RowVector a = RowVector::Constant(1, 0.3 * k);
    const RowVector b = RowVector::Constant(1, 0.3 * k + 0.1);
    const Track x = central->Step(a, b);
    const Track y = federated->Step(a, b);
    EXPECT_LT((x.x - y.x).norm(), 1e-9);
    EXPECT_LT((x.P - y.P).norm(), 1e-9);
  }
}

TEST(TrackFusion, EqualisedStepByHand) {
  // One step from a common prior: both filters predict from the same state, and
  // the fusion counts that prediction twice.
  const auto sensors = TwoSensors(2.0, 0.5);
  const auto fusion =
      MakeFusion(FusionArchitecture::kEqualised, sensors, Unit());
  const RowVector z_a = RowVector::Constant(1, 1.0);
  const RowVector z_b = RowVector::Constant(1, 3.0);
  const Track first = fusion->Step(z_a, z_b);
  Track a = Unit();
  Track b = Unit();
  Predict(sensors[0], &a);
  Predict(sensors[1], &b);
  Correct(sensors[0], z_a, &a);
  Correct(sensors[1], z_b, &b);
  const Track expected = FuseByInformation(a, b);
  EXPECT_LT((first.x - expected.x).norm(), 1e-12);
  // In the second the first filter holds the fused state; R weighs it by 1/4
  // and the second filter's by 4.
  const Track second = fusion->Step(z_a, z_b);
  a = expected;
  a.x = b.x = ((0.25 * a.x + 4.0 * b.x) / 4.25).eval();
  Predict(sensors[0], &a);
  Predict(sensors[1], &b);
  Correct(sensors[0], z_a, &a);
  Correct(sensors[1], z_b, &b);
  EXPECT_LT((second.x - FuseByInformation(a, b).x).norm(), 1e-12);
}

}  // namespace
}  // namespace hindsight
