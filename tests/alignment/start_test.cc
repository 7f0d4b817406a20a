#include "alignment/start.h"

#include <gtest/gtest.h>

#include <cmath>

#include "alignment/alignment.h"
#include "base/error.h"
#include "base/units.h"
#include "geometry/so3.h"
#include "io/config/scenario_config.h"
#include "measurements/sensor_kind.h"
#include "support/in_flight.h"
#include "support/truth_at.h"
#include "support/turned_imu.h"

namespace hindsight {
namespace {

/// From rest, off after 20 s at heading 65 deg; no initial values.
Scenario FromRest() {
  Scenario scenario = FindScenario("short_drive");
  scenario.duration = 60.0;
  return scenario;
}

Start FindWholeStart(const Dataset& dataset) {
  return FindStart(dataset, dataset.imu.t_begin(), dataset.imu.t_end());
}

TEST(Start, LevelsAtRestAndTakesTheHeadingFromTheCourse) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Dataset dataset = Simulate(FromRest(), seed);
    dataset.initial.alignment = AlignmentKind::kCourse;
    const Start start = FindWholeStart(dataset);
    EXPECT_NEAR(start.report.t, 0.0, 1e-9);
    EXPECT_NE(start.report.attitude.find("levelled at rest"), std::string::npos)
        << start.report.attitude;
    EXPECT_NE(start.report.heading.find("course"), std::string::npos);
    const TruthPoint truth = testing::TruthAt(dataset, start.report.t);
    const Eigen::Vector3d euler = EulerFromQuaternion(*truth.q_nb);
    const Eigen::Vector3d error = start.report.state.euler() - euler;
    // Three sigma as reported: accelerometer bias of 1 mg over g.
    const Eigen::Vector3d& sigma = start.report.attitude_sigma;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LT(std::abs(WrapAngle(error(axis))), 3.0 * sigma(axis)) << axis;
    }
    EXPECT_EQ(start.report.alignment, "course");
    // Accelerometer bias of 1 mg, and 0.05 deg of sway.
    EXPECT_NEAR(sigma.x(), std::hypot(1e-3, 0.05 * kDegree), 1e-5);
    EXPECT_LT(sigma.z(), 6.0 * kDegree);
    const Eigen::Vector3d d = start.report.state.C_en().transpose() *
                              (*truth.p_e - start.report.state.p_e);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LT(std::abs(d(axis)), 3.0 * start.report.position_sigma(axis));
    }
  }
}

TEST(Start, PriorCovarianceIsThatOfTheReport) {
  Dataset dataset = Simulate(FromRest(), 1);
  dataset.initial.alignment = AlignmentKind::kCourse;
  const Start start = FindWholeStart(dataset);
  const ErrorMatrix& P = start.prior.P;
  EXPECT_EQ(P.rows(), start.layout.dim());
  const Eigen::Vector3d p = start.report.position_sigma;
  EXPECT_LT((P.diagonal().head<3>().cwiseSqrt() - p).norm(), 1e-12);
  // Level: psi_down is heading, the horizontal part is tilt whatever heading.
  const Eigen::Vector3d s = start.report.attitude_sigma;
  EXPECT_NEAR(std::sqrt(P(8, 8)), s.z(), 0.01 * s.z());
  EXPECT_NEAR(P(6, 6) + P(7, 7), s.x() * s.x() + s.y() * s.y(),
              1e-3 * s.z() * s.z());
}

TEST(Start, PositionOfAFixIsWideForWhoDoesNotTrustItsSensor) {
  Dataset dataset = Simulate(FromRest(), 1);
  const Start start = FindWholeStart(dataset);
  const int gnss = start.position_sensor;
  ASSERT_GE(gnss, 0);
  EXPECT_TRUE(
      dataset.streams[static_cast<std::size_t>(gnss)].sensor.kind->is_position);
  const Start wide = WithoutTrustIn(gnss, start);
  const int p = start.layout.Find(BlockKind::kPosition)->offset;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(wide.prior.P(p + i, p + i), start.prior.P(p + i, p + i) + 1e6,
                1e-6);
  }
  EXPECT_EQ(WithoutTrustIn(gnss + 1, start).prior.P, start.prior.P);
  dataset.initial.position = GeodeticFromEcef(start.report.state.p_e);
  const Start given = FindWholeStart(dataset);
  EXPECT_EQ(given.position_sensor, -1);
  EXPECT_EQ(WithoutTrustIn(gnss, given).prior.P, given.prior.P);
}

TEST(Start, GivenValuesAreTakenAsTheyAre) {
  Dataset dataset = Simulate(FromRest(), 1);
  dataset.initial.t = 3.0;
  dataset.initial.position = Geodetic{0.8, 0.2, 500.0};
  dataset.initial.v_n = Eigen::Vector3d(0.1, 0.2, 0.3);
  dataset.initial.euler = Eigen::Vector3d(0.01, 0.02, 1.5);
  dataset.initial.attitude_sigma = Eigen::Vector3d(0.001, 0.002, 0.003);
  dataset.initial.position_sigma = Eigen::Vector3d(1.0, 2.0, 3.0);
  const Start start = FindWholeStart(dataset);
  EXPECT_EQ(start.report.t, 3.0);
  EXPECT_EQ(start.report.attitude, "given");
  EXPECT_EQ(start.report.heading, "given");
  EXPECT_EQ(start.report.position, "given");
  EXPECT_LT((start.report.state.euler() - *dataset.initial.euler).norm(),
            1e-12);
  EXPECT_LT((start.report.state.v_n() - *dataset.initial.v_n).norm(), 1e-12);
  EXPECT_EQ(start.report.position_sigma, Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST(Start, ValuesOfATimeBeforeTheIntervalAreRefused) {
  Dataset dataset = Simulate(FromRest(), 1);
  dataset.initial.t = 0.0;
  const double t_end = dataset.imu.t_end();
  // A time alone gives nothing that could be wrong.
  EXPECT_NO_THROW(FindStart(dataset, 20.0, t_end));
  dataset.initial.position = Geodetic{0.8, 0.2, 500.0};
  EXPECT_NO_THROW(FindStart(dataset, 0.0, t_end));
  EXPECT_THROW(FindStart(dataset, 20.0, t_end), InputError);
}

TEST(Start, HeadingWithoutMotionIsReportedUnknown) {
  Scenario scenario = FromRest();
  scenario.duration = 15.0;
  scenario.imu.gyro_bias_sigma.setConstant(30.0 * kDegree / kHour);
  const Dataset dataset = Simulate(scenario, 1);
  const Start start = FindWholeStart(dataset);
  EXPECT_NE(start.report.heading.find("unknown"), std::string::npos);
  // Uniform on the circle: 360 deg/sqrt(12).
  EXPECT_NEAR(start.report.attitude_sigma.z(), 2.0 * kPi / std::sqrt(12.0),
              0.01);
}

TEST(Start, WithoutPositionThereIsNoAnswer) {
  Dataset dataset = Simulate(FromRest(), 1);
  dataset.streams.erase(dataset.streams.begin());
  for (AidingStream& stream : dataset.streams) {
    for (Measurement& z : stream.measurements.Edited()) --z.sensor;
  }
  EXPECT_THROW(FindWholeStart(dataset), EstimationError);
  dataset.initial.t = 1.0;
  EXPECT_THROW(FindWholeStart(dataset), EstimationError);
}

TEST(Start, ValuesOfAnotherTimeAreRefused) {
  Dataset dataset = Simulate(FromRest(), 1);
  dataset.initial.t = 1.0;
  dataset.initial.v_n = Eigen::Vector3d::Zero();
  EXPECT_NO_THROW(FindStart(dataset, 0.0, 50.0));
  EXPECT_THROW(FindStart(dataset, 20.0, 50.0), InputError);
  EXPECT_THROW(FindStart(dataset, 0.0, 0.5), InputError);
  // Where nothing but the time is given, the data say the rest.
  dataset.initial.v_n.reset();
  EXPECT_NO_THROW(FindStart(dataset, 20.0, 50.0));
}

TEST(Start, VelocityComesFromTheDopplerLog) {
  // 2 m/s ahead and 1 m/s to the right, heading east; the log looks to the
  // right and reads 2 % too much. The IMU feels nothing of it.
  Dataset dataset;
  for (int k = 0; k <= 2000; ++k) {
    dataset.imu.samples.push_back(
        {0.01 * k, {0.0, 0.0, 0.0}, {0.0, 0.0, -kStandardGravity}});
  }
  AidingStream stream;
  stream.sensor.name = "log";
  stream.sensor.kind = &DvlKind();
  stream.sensor.scale = 0.02;
  stream.sensor.q_sb = Exp(Eigen::Vector3d(0.0, 0.0, -90.0 * kDegree));
  for (int k = 0; k < 20; ++k) {
    Dvl dvl;
    dvl.speed.head<3>() = 1.02 * Eigen::Vector3d(1.0, -2.0, 0.0);
    dvl.sigma.setConstant(0.01);
    stream.measurements.push_back({0.5 + k, 0, false, dvl});
  }
  dataset.streams.push_back(stream);
  dataset.initial.position = Geodetic{0.8, 0.2, -20.0};
  dataset.initial.heading = 90.0 * kDegree;
  const Start start = FindWholeStart(dataset);
  const Eigen::Vector3d v_n =
      start.report.state.C_en().transpose() * start.report.state.v_e;
  EXPECT_LT((v_n - Eigen::Vector3d(-1.0, 2.0, 0.0)).norm(), 0.05) << v_n;
  EXPECT_LT(start.report.velocity_sigma.maxCoeff(), 3.0);
}

TEST(Start, IntervalWithoutImuIsAnInputError) {
  const Dataset dataset = Simulate(FromRest(), 1);
  EXPECT_THROW(FindStart(dataset, 1000.0, 2000.0), InputError);
}

TEST(Start, TakesTheVelocityChangeWhereItTellsTheHeadingBest) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Dataset dataset = Simulate(FromRest(), seed);
    dataset.streams.push_back(testing::Constraint(dataset));
    const Start start = FindWholeStart(dataset);
    EXPECT_EQ(start.report.alignment, "velocity");
    EXPECT_NE(start.report.why.find("course: heading to"), std::string::npos)
        << start.report.why;
    const Eigen::Vector3d error =
        start.report.state.euler() -
        EulerFromQuaternion(*dataset.truth.front().q_nb);
    const Eigen::Vector3d& sigma = start.report.attitude_sigma;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LT(std::abs(WrapAngle(error(axis))), 4.0 * sigma(axis)) << axis;
    }
    EXPECT_LT(sigma.z(), 1.0 * kDegree);
    // Its measurements come again: the prior is ten times as wide.
    EXPECT_NEAR(std::sqrt(start.prior.P(8, 8)), 10.0 * sigma.z(),
                0.5 * sigma.z());
  }
}

TEST(Start, MotionRefutesTheCourseOfABodyThatPointsElsewhere) {
  const PerfectRecording recording(InFlightAlignment());
  // So early in the first turn the motion tells the heading to 10 deg alone,
  // the course would say 3.
  constexpr double kEnd = kFirstManoeuvre + 0.9;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Dataset dataset = recording.Realize(seed);
    dataset.streams.push_back(testing::Constraint(dataset));
    EXPECT_EQ(FindStart(dataset, 0.0, kEnd).report.alignment, "course");
    MountAnywhere(seed, &dataset);
    const Start start = FindStart(dataset, 0.0, kEnd);
    EXPECT_EQ(start.report.alignment, "velocity");
    EXPECT_NE(start.report.why.find("course: heading to 3 deg, but refuted"),
              std::string::npos)
        << start.report.why;
    const Eigen::Vector3d e =
        Log(*dataset.truth.front().q_nb *
            QuaternionFromEuler(start.report.state.euler().x(),
                                start.report.state.euler().y(),
                                start.report.state.euler().z())
                .conjugate());
    EXPECT_LT(std::abs(e.z()), 30.0 * kDegree) << seed;
  }
}

/// The largest component of the attitude's error in reported sigmas.
double ErrorInSigmas(const Dataset& dataset, const Start& start) {
  const Eigen::Vector3d euler = start.report.state.euler();
  const Eigen::Vector3d e =
      Log(*dataset.truth.front().q_nb *
          QuaternionFromEuler(euler.x(), euler.y(), euler.z()).conjugate());
  const int a = start.layout.Find(BlockKind::kAttitude)->offset;
  return (e.array() /
          start.prior.P.diagonal().segment<3>(a).cwiseSqrt().array())
      .abs()
      .maxCoeff();
}

TEST(Start, StraightMotionTellsNoHeadingOfAnImuThatSitsAnyhow) {
  const PerfectRecording recording(InFlightAlignment());
  constexpr double kEnd = kFirstManoeuvre - 1.0;
  std::uint64_t seed = 1;
  for (const Eigen::Quaterniond& q_ob : testing::kMountings) {
    const Dataset flight = recording.Realize(seed++);
    const Dataset turned = testing::Turned(flight, q_ob);
    const Start start = FindStart(turned, 0.0, kEnd);
    EXPECT_NE(start.report.alignment, "course");
    EXPECT_NE(start.report.heading.find("unknown"), std::string::npos)
        << start.report.heading;
    EXPECT_NE(start.report.why.find("course: no odometer or constraint says"),
              std::string::npos)
        << start.report.why;
    EXPECT_GE(start.prior.P(8, 8), kUnknownHeadingSigma * kUnknownHeadingSigma);
    EXPECT_LT(ErrorInSigmas(turned, start), 4.0);
    // What tells the tilt is measured again, whatever it says of the heading.
    if (start.report.alignment == "velocity") {
      const double wider =
          std::sqrt(start.prior.P(6, 6)) / start.report.attitude_sigma.x();
      EXPECT_GT(wider, 5.0);
    }
    // A constraint that says where forward is makes the course a heading.
    Dataset constrained = turned;
    constrained.streams.push_back(testing::Constraint(turned));
    constrained.streams.back().sensor.q_sb = q_ob;
    // The course levels to 5 deg the axes as they are.
    if (q_ob.angularDistance(Eigen::Quaterniond::Identity()) > 0.1) continue;
    const Start known = FindStart(constrained, 0.0, kEnd);
    EXPECT_EQ(known.report.alignment, "course");
    EXPECT_LT(known.report.attitude_sigma.z(), 4.0 * kDegree);
    EXPECT_LT(ErrorInSigmas(constrained, known), 4.0);
  }
}

TEST(Start, ReachesBackToTheFirstSampleWhereTheFirstFixComesLater) {
  constexpr double kFirstFix = 40.0;
  Dataset dataset = Simulate(FromRest(), 1);
  for (AidingStream& stream : dataset.streams) {
    stream.measurements.EraseIf(
        [](const Measurement& z) { return z.t < kFirstFix; });
  }
  const Start start = FindWholeStart(dataset);
  EXPECT_NEAR(start.report.t, 0.0, 1e-9);
  EXPECT_EQ(start.prior.x.t, start.report.t);
  EXPECT_NE(start.report.position.find("back to the start"), std::string::npos)
      << start.report.position;
  const TruthPoint truth = dataset.truth.front();
  const Eigen::Vector3d d = start.report.state.C_en().transpose() *
                            (*truth.p_e - start.report.state.p_e);
  const Eigen::Vector3d v = *truth.v_n - start.report.state.v_n();
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LT(std::abs(d(axis)), 3.0 * start.report.position_sigma(axis));
    EXPECT_LT(std::abs(v(axis)), 3.0 * start.report.velocity_sigma(axis));
  }
}

TEST(Start, AGivenAttitudeIsThatOfTheFirstSampleHoweverLateTheFirstFix) {
  Dataset dataset = Simulate(FromRest(), 2);
  for (AidingStream& stream : dataset.streams) {
    stream.measurements.EraseIf(
        [](const Measurement& z) { return z.t < 30.0; });
  }
  const TruthPoint truth = testing::TruthAt(dataset, 0.0);
  dataset.initial.euler = EulerFromQuaternion(*truth.q_nb);
  const Start start = FindWholeStart(dataset);
  EXPECT_NEAR(start.report.t, 0.0, 0.02);
  EXPECT_NEAR(WrapAngle(start.prior.x.euler().z() - dataset.initial.euler->z()),
              0.0, 1e-3);
}

TEST(Start, CalibrationWithASigmaEntersTheLayout) {
  Dataset dataset = Simulate(FromRest(), 1);
  Sensor& sensor = dataset.streams[0].sensor;
  sensor.lever_arm_sigma = Eigen::Vector3d(0.1, 0.2, 0.3);
  sensor.time_offset_sigma = 0.01;
  const Start start = FindWholeStart(dataset);
  const Block* lever = start.layout.Find(BlockKind::kLeverArm, 0);
  ASSERT_NE(lever, nullptr);
  EXPECT_EQ(lever->sigma0, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(lever->name, "gnss_lever_arm");
  const Eigen::Vector3d value =
      start.prior.x.parameters.segment<3>(lever->parameter_offset);
  EXPECT_EQ(value, sensor.lever_arm_b);
  EXPECT_TRUE(start.layout.Has(BlockKind::kTimeOffset, 0));
  EXPECT_FALSE(start.layout.Has(BlockKind::kLeverArm, 1));
}

}  // namespace
}  // namespace hindsight
