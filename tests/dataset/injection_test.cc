#include "dataset/injection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "earth/wgs84.h"
#include "measurements/sensor_kind.h"

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
  height.sensor.kind = &HeightKind();
  AidingStream odometer;
  odometer.sensor.name = "odo";
  odometer.sensor.kind = &OdometerKind();
  for (int k = 0; k < 1000; ++k) {
    gnss.measurements.push_back({1.0 * k, 0, false, PositionFix{p_e}});
    height.measurements.push_back({1.0 * k, 1, false, HeightFix{500.0}});
  }
  dataset.streams = {gnss, height, odometer};
  return dataset;
}

Eigen::Vector3d ErrorOf(const Dataset& dataset, std::size_t k,
                        std::size_t stream = 0) {
  const Eigen::Vector3d p_e =
      EcefFromGeodetic({48.0 * kDegree, 11.0 * kDegree, 500.0});
  const auto fix =
      std::get<PositionFix>(dataset.streams[stream].measurements[k].model);
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
            "position: step of 12 m north, east from 140 s to 150 s");
}

TEST(Injection, SpikesHitTheirShareAndMultipathHasItsMoments) {
  Dataset dataset = Fixes();
  Injection spikes = Make(Injection::Kind::kSpikes, 5.0, 0.0, 1000.0);
  spikes.share = 0.2;
  spikes.axes = std::array<bool, 3>{true, false, false};
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

TEST(Injection, TwoStreamsHaveErrorsOfTheirOwn) {
  for (const auto kind :
       {Injection::Kind::kMultipath, Injection::Kind::kSpikes}) {
    Injection injection = Make(kind, 4.0, 0.0, 1000.0);
    injection.share = 0.5;
    Dataset one = Fixes();
    Dataset two = Fixes();
    AidingStream second = two.streams[0];
    second.sensor.name = "gnss2";
    two.streams.push_back(second);
    Dataset again = two;
    ApplyInjections({injection}, 7, &one);
    ApplyInjections({injection}, 7, &two);
    ApplyInjections({injection}, 7, &again);
    double product = 0.0;
    double square = 0.0;
    for (std::size_t k = 0; k < 1000; ++k) {
      EXPECT_EQ(ErrorOf(one, k), ErrorOf(two, k)) << k;
      EXPECT_EQ(ErrorOf(again, k, 3), ErrorOf(two, k, 3)) << k;
      product += ErrorOf(two, k).x() * ErrorOf(two, k, 3).x();
      square += ErrorOf(two, k).x() * ErrorOf(two, k).x();
    }
    // Some 50 independent values of the multipath.
    EXPECT_LT(std::abs(product / square), 0.5);
    EXPECT_EQ(two.policies[0].count, 2000);
  }
}

TEST(Injection, LeavesWithheldMeasurementsAsTheyAre) {
  const Injection injection =
      Make(Injection::Kind::kMultipath, 4.0, 100.0, 200.0);
  Dataset all = Fixes();
  Dataset some = Fixes();
  for (std::size_t k = 120; k < 150; ++k) {
    some.streams[0].measurements.Edit(
        k, [](Measurement& z) { z.withheld = true; });
  }
  ApplyInjections({injection}, 7, &all);
  ApplyInjections({injection}, 7, &some);
  for (std::size_t k = 100; k < 200; ++k) {
    const bool withheld = k >= 120 && k < 150;
    EXPECT_EQ(ErrorOf(some, k),
              withheld ? Eigen::Vector3d::Zero() : ErrorOf(all, k))
        << k;
  }
  EXPECT_EQ(some.policies[0].count, 70);
  EXPECT_THAT(some.policies[0].action, ::testing::HasSubstr("30 withheld"));
}

std::string Refusal(const Injection& injection, const TimeInterval& used,
                    Dataset dataset) {
  try {
    ApplyInjections({injection}, 1, used, &dataset);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Injection, CountsAndNeedsWhatIsUsed) {
  Dataset dataset = Fixes();
  dataset.streams[0].sensor.time_offset = 0.5;
  const Injection step = Make(Injection::Kind::kStep, 4.0, 95.0, 300.0);
  // Stamps of 100 s to 199 s are within 100 s to 200 s of the IMU's clock.
  const TimeInterval used{100.0, 200.0};
  Dataset changed = dataset;
  ApplyInjections({step}, 1, used, &changed);
  EXPECT_EQ(changed.policies[0].count, 100);
  EXPECT_THAT(
      Refusal(Make(Injection::Kind::kStep, 4.0, 300.0, 400.0), used, dataset),
      ::testing::HasSubstr("from 100 s to 199 s"));
  for (Measurement& z : dataset.streams[0].measurements.Edited())
    z.withheld = true;
  EXPECT_THAT(Refusal(step, used, dataset),
              ::testing::HasSubstr("withheld, 100"));
}

TEST(Injection, TakesTheUnitAndTheAxesOfTheSensor) {
  Dataset dataset = Fixes();
  AidingStream doppler;
  doppler.sensor.name = "doppler";
  doppler.sensor.kind = &VelocityKind();
  VelocityFix still;
  still.v_n.setZero();
  doppler.measurements.push_back({1.0, 3, false, still});
  dataset.streams.push_back(doppler);
  const TimeInterval used{0.0, 1000.0};
  Injection step = Make(Injection::Kind::kStep, 3.0, 0.0, 10.0);
  step.sensor = "doppler";
  EXPECT_THAT(Refusal(step, used, dataset),
              ::testing::HasSubstr("expected a size in m/s"));
  step.speed = true;
  Dataset changed = dataset;
  ApplyInjections({step}, 1, &changed);
  EXPECT_EQ(Describe(changed.injections[0]),
            "doppler: step of 3 m/s north, east from 0 s to 10 s");
  for (const char* sensor : {"gnss", "height"}) {
    step.sensor = sensor;
    EXPECT_THAT(Refusal(step, used, dataset),
                ::testing::EndsWith("expected a size in m"));
  }
  step.speed = false;
  step.kind = Injection::Kind::kPulse;
  changed = dataset;
  ApplyInjections({step}, 1, &changed);
  EXPECT_EQ(Describe(changed.injections[0]),
            "height: pulse of 3 m up from 0 s to 10 s");
  EXPECT_EQ(
      std::get<HeightFix>(changed.streams[1].measurements[9].model).height,
      503.0);
  step.axes = std::array<bool, 3>{false, false, true};
  EXPECT_THAT(Refusal(step, used, dataset),
              ::testing::HasSubstr("expected no axes"));
  step.sensor = "vel";
  EXPECT_THAT(
      Refusal(step, used, dataset),
      ::testing::HasSubstr("name of such a stream: gnss, baro, doppler"));
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
  endless.kind = Injection::Kind::kPulse;
  refuse(endless, "gnss");
  EXPECT_TRUE(dataset.injections.empty());
}

}  // namespace
}  // namespace hindsight
