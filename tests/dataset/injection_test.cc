#include "dataset/injection.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "earth/wgs84.h"

namespace hindsight {
namespace {

/// Positions and heights at 1 Hz over 1000 s at one place.
Dataset Fixes() {
  Dataset dataset;
  const Eigen::Vector3d p_e =
      EcefFromGeodetic({48.0 * kDegree, 11.0 * kDegree, 500.0});
  AidingStream gnss;
  gnss.sensor.name = "gnss";
  AidingStream height;
  height.sensor.name = "baro";
  height.sensor.type = SensorType::kHeight;
  AidingStream odometer;
  odometer.sensor.name = "odo";
  odometer.sensor.type = SensorType::kOdometer;
  for (int k = 0; k < 1000; ++k) {
    gnss.measurements.push_back({1.0 * k, 0, false, PositionFix{p_e}});
    height.measurements.push_back({1.0 * k, 1, false, HeightFix{500.0}});
  }
  dataset.streams = {gnss, height, odometer};
  return dataset;
}

Eigen::Vector3d ErrorOf(const Dataset& dataset, std::size_t k) {
  const Eigen::Vector3d p_e =
      EcefFromGeodetic({48.0 * kDegree, 11.0 * kDegree, 500.0});
  const auto& fix =
      std::get<PositionFix>(dataset.streams[0].measurements[k].model);
  return NedAxes(p_e).transpose() * (fix.p_e - p_e);
}

Injection Make(Injection::Kind kind, double size, double from, double to) {
  Injection injection;
  injection.sensor = "position";
  injection.kind = kind;
  injection.size = size;
  injection.from = from;
  injection.to = to;
  return injection;
}

TEST(Injection, StepAndRampHaveTheirShapes) {
  Dataset dataset = Fixes();
  ApplyInjections({Make(Injection::Kind::kStep, 12.0, 140.0, 150.0),
                   Make(Injection::Kind::kRamp, 10.0, 200.0, 300.0)},
                  1, &dataset);
  EXPECT_LT(ErrorOf(dataset, 139).norm(), 1e-8);
  EXPECT_LT((ErrorOf(dataset, 140) - Eigen::Vector3d(12.0, 12.0, 0.0)).norm(),
            1e-8);
  EXPECT_GT(ErrorOf(dataset, 149).norm(), 1.0);
  EXPECT_LT(ErrorOf(dataset, 150).norm(), 1e-8);
  EXPECT_LT((ErrorOf(dataset, 250) - Eigen::Vector3d(5.0, 5.0, 0.0)).norm(),
            1e-8);
  EXPECT_LT(ErrorOf(dataset, 300).norm(), 1e-8);
  ASSERT_EQ(dataset.injections.size(), 2u);
  ASSERT_EQ(dataset.policies.size(), 2u);
  EXPECT_EQ(dataset.policies[0].count, 10);
  EXPECT_EQ(Describe(dataset.injections[0]),
            "position: step of 12 north, east from 140 s to 150 s");
}

TEST(Injection, SpikesHitTheirShareAndMultipathHasItsMoments) {
  Dataset dataset = Fixes();
  Injection spikes = Make(Injection::Kind::kSpikes, 5.0, 0.0, 1000.0);
  spikes.share = 0.2;
  spikes.axes = {true, false, false};
  ApplyInjections({spikes}, 3, &dataset);
  int hit = 0;
  for (std::size_t k = 0; k < 1000; ++k) {
    const Eigen::Vector3d e = ErrorOf(dataset, k);
    EXPECT_NEAR(e.y(), 0.0, 1e-8);
    if (std::abs(e.x()) < 1e-8) continue;
    EXPECT_NEAR(std::abs(e.x()), 5.0, 1e-8);
    ++hit;
  }
  // Five standard deviations of a binomial count of 1000 at 20 %.
  EXPECT_NEAR(hit, 200, 5.0 * std::sqrt(160.0));

  Dataset coloured = Fixes();
  Injection multipath = Make(Injection::Kind::kMultipath, 4.0, 0.0, 1000.0);
  multipath.tau = 2.0;
  ApplyInjections({multipath}, 3, &coloured);
  double square = 0.0;
  double product = 0.0;
  for (std::size_t k = 1; k < 1000; ++k) {
    const double e = ErrorOf(coloured, k).x();
    square += e * e;
    product += e * ErrorOf(coloured, k - 1).x();
  }
  // Correlated over two seconds: some 245 independent values, five sigmas.
  EXPECT_NEAR(square / 999.0, 16.0, 16.0 * 5.0 * std::sqrt(2.0 / 245.0));
  EXPECT_NEAR(product / square, std::exp(-0.5), 0.15);
}

TEST(Injection, IsReproducibleAndLeavesEarlierOnesAlone) {
  const Injection first = Make(Injection::Kind::kMultipath, 4.0, 0.0, 500.0);
  const Injection second = Make(Injection::Kind::kSpikes, 4.0, 600.0, 900.0);
  Dataset a = Fixes();
  Dataset b = Fixes();
  Dataset c = Fixes();
  ApplyInjections({first}, 7, &a);
  ApplyInjections({first, second}, 7, &b);
  ApplyInjections({first}, 8, &c);
  EXPECT_EQ(ErrorOf(a, 300), ErrorOf(b, 300));
  EXPECT_NE(ErrorOf(a, 300), ErrorOf(c, 300));
}

TEST(Injection, RefusesWhatItCannotDo) {
  Dataset dataset = Fixes();
  const auto refuse = [&](Injection injection, const char* sensor) {
    injection.sensor = sensor;
    EXPECT_THROW(ApplyInjections({injection}, 1, &dataset), InputError);
  };
  const Injection step = Make(Injection::Kind::kStep, 1.0, 0.0, 10.0);
  refuse(step, "velocity");
  refuse(step, "odo");
  refuse(Make(Injection::Kind::kStep, 1.0, 10.0, 10.0), "gnss");
  refuse(Make(Injection::Kind::kStep, 1.0, 2000.0, 3000.0), "gnss");
  Injection endless = Make(Injection::Kind::kRamp, 1.0, 0.0, 0.0);
  endless.to = std::numeric_limits<double>::infinity();
  refuse(endless, "gnss");
  EXPECT_TRUE(dataset.injections.empty());
}

}  // namespace
}  // namespace hindsight
