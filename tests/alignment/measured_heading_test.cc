#include "alignment/measured_heading.h"

#include <gtest/gtest.h>

#include <cmath>

#include "alignment/start.h"
#include "geometry/so3.h"
#include "io/config/scenario_config.h"
#include "measurements/heading.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr double kReadingSigma = 0.5 * kDegree;

/// Adds two antennas on `baseline_b`, whose readings are turned by `error`.
void AddAntennas(const Eigen::Vector3d& baseline_b, double error,
                 std::uint64_t seed, Dataset* dataset) {
  AidingStream& stream = dataset->streams.emplace_back();
  stream.sensor.name = "antennas";
  stream.sensor.kind = &HeadingKind();
  stream.sensor.own_vector = baseline_b;
  const int index = static_cast<int>(dataset->streams.size()) - 1;
  Random random(seed, 400);
  for (const TruthPoint& point : dataset->truth) {
    GenericReading z;
    z.model = &BaselineDirection();
    z.sigma.head<2>() << kReadingSigma, 0.0;
    const double heading = DirectionOf(*point.q_nb * baseline_b)(0) + error +
                           kReadingSigma * random.Normal();
    // As receivers do: from 0 to 360 deg.
    z.value(0) = heading < 0.0 ? heading + 2.0 * kPi : heading;
    stream.measurements.push_back({point.t, index, false, z});
  }
}

/// A vehicle that stands with its heading `heading`.
Dataset Standing(double heading, std::uint64_t seed) {
  Scenario scenario = FindScenario("short_drive");
  scenario.start_heading = heading;
  scenario.segments = {Segment::Stop(15.0)};
  scenario.duration = 15.0;
  return Simulate(scenario, seed);
}

double HeadingError(const Dataset& dataset, const Start& start) {
  return WrapAngle(EulerFromQuaternion(*dataset.truth.front().q_nb).z() -
                   start.report.state.euler().z());
}

TEST(MeasuredHeading, IsThatOfTheVehicleWhereverTheBaselineLies) {
  for (const double heading : {0.0, 180.0 * kDegree, 290.0 * kDegree}) {
    for (const Eigen::Vector3d& baseline_b :
         {Eigen::Vector3d(2.0, 0.0, 0.0), Eigen::Vector3d(0.1, -1.5, -0.3),
          Eigen::Vector3d(-1.0, 0.5, 0.5)}) {
      Dataset dataset = Standing(heading, 3);
      AddAntennas(baseline_b, 0.0, 3, &dataset);
      const Start start = FindStart(dataset, 0.0, 15.0);
      EXPECT_EQ(start.report.alignment, "heading") << start.report.why;
      // 0.04 deg of 150 readings, and a tilt of 0.1 deg.
      EXPECT_LT(std::abs(HeadingError(dataset, start)), 0.25 * kDegree);
      EXPECT_GT(start.report.attitude_sigma.z(), 1.1 * kDegree);
      EXPECT_LT(start.report.attitude_sigma.z(), 1.3 * kDegree);
    }
  }
}

TEST(MeasuredHeading, IsCarriedBackByTheGyrosFromALaterReading) {
  Dataset dataset = Simulate(FindScenario("short_drive"), 4);
  AddAntennas({1.0, 0.0, 0.0}, 0.0, 4, &dataset);
  dataset.initial.alignment = AlignmentKind::kHeading;
  MeasurementSeries& all = dataset.streams.back().measurements;
  MeasurementSeries late;
  for (const Measurement& z : all) {
    if (z.t > 20.0) late.push_back(z);
  }
  all = late;
  const Start start = FindStart(dataset, 0.0, 40.0);
  EXPECT_EQ(start.report.alignment, "heading");
  EXPECT_LT(std::abs(HeadingError(dataset, start)),
            3.0 * start.report.attitude_sigma.z());
  EXPECT_LT(start.report.attitude_sigma.z(), 5.0 * kDegree);
}

TEST(MeasuredHeading, OfABaselineThatIsTheOtherWayRoundIsRefutedByTheMotion) {
  Dataset dataset = Simulate(FindScenario("short_drive"), 5);
  AddAntennas({1.0, 0.0, 0.0}, kPi, 5, &dataset);
  const Start start = FindStart(dataset, 0.0, dataset.imu.t_end());
  EXPECT_NE(start.report.alignment, "heading") << start.report.why;
  EXPECT_LT(std::abs(HeadingError(dataset, start)),
            5.0 * start.report.attitude_sigma.z())
      << start.report.why;
}

TEST(MeasuredHeading, OfAnUprightBaselineOrWithoutReadingsThereIsNone) {
  Dataset dataset = Standing(1.0, 6);
  AddAntennas({0.01, 0.0, -1.0}, 0.0, 6, &dataset);
  const AlignmentInput input{.dataset = dataset, .t = 0.0, .to = 15.0};
  const AlignmentOutcome upright = AlignByHeading(input);
  EXPECT_FALSE(upright.found);
  EXPECT_EQ(upright.reason, "antennas: its baseline stands upright");
  dataset.streams.back().measurements.clear();
  EXPECT_EQ(AlignByHeading(input).reason,
            "no readings of a heading at the start");
}

}  // namespace
}  // namespace hindsight
