#include "alignment/magnetic_heading.h"

#include <gtest/gtest.h>

#include <cmath>

#include "alignment/start.h"
#include "geometry/so3.h"
#include "io/config/scenario_config.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

/// A vehicle that stands, with a compass beside its IMU.
Dataset Standing(std::uint64_t seed) {
  Scenario scenario = FindScenario("short_drive");
  scenario.start_heading = 290.0 * kDegree;
  scenario.segments = {Segment::Stop(15.0)};
  scenario.duration = 15.0;
  Dataset dataset = Simulate(scenario, seed);
  AidingStream& stream = dataset.streams.emplace_back();
  stream.sensor.name = "compass";
  stream.sensor.kind = &MagnetometerKind();
  MagneticSurroundings& magnetic = stream.sensor.magnetic;
  magnetic.horizontal = 21.0;
  magnetic.down = 43.0;
  magnetic.declination = 4.0 * kDegree;
  magnetic.hard_iron_b = Eigen::Vector3d(5.0, -8.0, 2.0);
  const Eigen::Vector3d m_b =
      dataset.truth.front().q_nb->conjugate() *
          UndisturbedField(magnetic, magnetic.declination) +
      magnetic.hard_iron_b;
  Random random(seed, 400);
  for (int k = 0; k < 150; ++k) {
    MagneticField field;
    field.field_b = m_b + 0.5 * random.NormalVector3();
    field.sigma = 0.5;
    stream.measurements.push_back(
        {0.1 * k, static_cast<int>(dataset.streams.size()) - 1, false, field});
  }
  return dataset;
}

TEST(MagneticHeading, IsThatOfTheVehicleWithinItsSigma) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Dataset dataset = Standing(seed);
    dataset.initial.alignment = AlignmentKind::kMagnetometer;
    const Start start = FindStart(dataset, 0.0, 15.0);
    EXPECT_EQ(start.report.alignment, "magnetometer");
    const double error =
        WrapAngle(EulerFromQuaternion(*dataset.truth.front().q_nb).z() -
                  start.report.state.euler().z());
    // Half a degree: tilt of 1 mg at this dip, 0.1 deg, and the readings'
    // noise.
    EXPECT_LT(std::abs(error), 0.5 * kDegree) << seed;
    EXPECT_GT(start.report.attitude_sigma.z(), 2.0 * kDegree);
    EXPECT_LT(start.report.attitude_sigma.z(), 3.0 * kDegree);
  }
}

TEST(MagneticHeading, IsTakenWhereNothingElseTellsTheHeading) {
  const Start start = FindStart(Standing(1), 0.0, 15.0);
  EXPECT_EQ(start.report.alignment, "magnetometer") << start.report.why;
}

TEST(MagneticHeading, WithoutReadingsThereIsNone) {
  Dataset dataset = Standing(1);
  dataset.streams.back().measurements.clear();
  const AlignmentInput input{.dataset = dataset, .t = 0.0, .to = 15.0};
  const AlignmentOutcome outcome = AlignByMagnetometer(input);
  EXPECT_FALSE(outcome.found);
  EXPECT_EQ(outcome.reason, "no magnetometer readings at the start");
}

}  // namespace
}  // namespace hindsight
