#include "dataset/timeline_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "measurements/sensor_kind.h"
#include "support/test_motion.h"

namespace hindsight {
namespace {

/// Ten seconds of IMU, heights stamped at the given times.
Dataset Record(const std::vector<double>& stamps, double time_offset = 0.0) {
  Dataset dataset;
  dataset.imu = testing::LivelyImu(10.0, 100.0);
  AidingStream stream;
  stream.sensor.name = "barometer";
  stream.sensor.kind = &HeightKind();
  stream.sensor.time_offset = time_offset;
  for (const double t : stamps) {
    stream.measurements.push_back({t, 0, false, HeightFix{100.0 + t, 1.0}});
  }
  dataset.streams.push_back(stream);
  return dataset;
}

Timeline Build(const Dataset& dataset, double begin, double end,
               std::vector<double> extra_times) {
  TimelineOptions options;
  options.t_begin = begin;
  options.t_end = end;
  options.extra_times = std::move(extra_times);
  return BuildTimeline(dataset, options);
}

std::vector<double> NodeTimes(const Timeline& timeline) {
  std::vector<double> times;
  for (const Node& node : timeline.nodes()) times.push_back(node.t);
  return times;
}

TEST(TimelineBuilder, NodesStandAtTrueTimesAndFillTheRest) {
  const Dataset dataset = Record({1.2345, 4.0}, 0.3);
  const Timeline timeline = Build(dataset, 0.0, 5.0, {2.0});
  const std::vector<double> times = NodeTimes(timeline);
  EXPECT_EQ(times.front(), 0.0);
  EXPECT_EQ(times.back(), 5.0);
  // Measured at 1.5345 and 4.3; 2.0 asked for; never more than 1 s apart.
  for (const double t : {1.5345, 2.0, 4.3}) {
    EXPECT_TRUE(std::any_of(times.begin(), times.end(), [t](double x) {
      return std::abs(x - t) < 1e-12;
    })) << t;
  }
  for (std::size_t k = 1; k < times.size(); ++k) {
    EXPECT_LE(times[k] - times[k - 1], 1.0 + 1e-9);
    EXPECT_GT(times[k] - times[k - 1], 0.1);
  }
}

TEST(TimelineBuilder, MeasurementsBelongToTheirNode) {
  Dataset dataset = Record({1.0, 2.0, 3.0});
  AidingStream second = dataset.streams[0];
  for (Measurement& z : second.measurements.Edited()) z.sensor = 1;
  dataset.streams.push_back(second);
  const Timeline timeline = Build(dataset, 0.5, 3.5, {});
  std::size_t total = 0;
  for (std::size_t k = 0; k < timeline.size(); ++k) {
    for (const Measurement& z : timeline.measurements(k)) {
      EXPECT_NEAR(z.t, timeline.node(k).t, 1e-7);
      ++total;
    }
  }
  EXPECT_EQ(total, 6u);
}

TEST(TimelineBuilder, MeasurementsOutsideTheSpanAreLeftOut) {
  const Dataset dataset = Record({0.2, 1.0, 4.0, 9.0});
  const Timeline timeline = Build(dataset, 1.0, 4.0, {0.5, 7.0});
  EXPECT_EQ(timeline.all_measurements().size(), 2u);
  EXPECT_EQ(timeline.node(0).t, 1.0);
  EXPECT_EQ(timeline.nodes().back().t, 4.0);
  EXPECT_EQ(timeline.measurements(0).size(), 1u);
  EXPECT_EQ(timeline.measurements(timeline.size() - 1).size(), 1u);
}

TEST(TimelineBuilder, KinematicsAreTheReadingOfTheNode) {
  const Dataset dataset = Record({1.2345});
  const Timeline timeline = Build(dataset, 0.0, 2.0, {});
  ImuIntegrator integrator(dataset.imu);
  for (const Node& node : timeline.nodes()) {
    EXPECT_EQ(node.kinematics.f_b, integrator.ReadingAt(node.t).f_b);
  }
}

TEST(Timeline, SummariesAreIntegratedAnewOnlyWhenTheBiasHasMovedFar) {
  const Dataset dataset = Record({});
  Timeline timeline = Build(dataset, 0.0, 3.0, {});
  ImuCalibration calibration;
  timeline.Integrate(1, calibration);
  calibration.b_g.x() = 1e-4;  // 0.1 mrad over the second
  EXPECT_EQ(timeline.Integrate(1, calibration).calibration.b_g.x(), 0.0);
  calibration.b_g.x() = 2e-3;
  EXPECT_EQ(timeline.Integrate(1, calibration).calibration.b_g.x(), 2e-3);
}

TEST(Timeline, WhatIsIntegratedAnewLeavesEarlierSummariesAndCopiesAlone) {
  const Dataset dataset = Record({});
  Timeline timeline = Build(dataset, 0.0, 3.0, {});
  timeline.Integrate(1, {});
  const std::shared_ptr<const ImuSummary> before = timeline.SharedSummary(1);
  const Eigen::Quaterniond dR = before->dR;
  Timeline copy = timeline;
  EXPECT_EQ(&copy.Summary(1), before.get());
  ImuCalibration far;
  far.b_g.x() = 2e-3;
  timeline.Integrate(1, far);
  EXPECT_NE(&timeline.Summary(1), before.get());
  EXPECT_EQ(&copy.Summary(1), before.get());
  EXPECT_EQ(before->calibration.b_g.x(), 0.0);
  EXPECT_EQ(before->dR.coeffs(), dR.coeffs());
}

}  // namespace
}  // namespace hindsight
