#include "dataset/known_constants.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "dataset/dataset.h"
#include "dataset/recorded_constants.h"
#include "geometry/so3.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

const Eigen::Vector3d kMounting(0.02, -0.03, 0.05);
const Eigen::Quaterniond kNominal = Exp(Eigen::Vector3d(0.3, -0.2, 1.0));

/// Scale, mounting and lever arm of a log, scale and arm correlated.
RecordedConstants OfALog() {
  RecordedConstants recorded;
  recorded.source = "earlier";
  recorded.names = {"log_scale",       "log_mounting[x]",  "log_mounting[y]",
                    "log_mounting[z]", "log_lever_arm[x]", "log_lever_arm[y]",
                    "log_lever_arm[z]"};
  recorded.units = {"1", "rad", "rad", "rad", "m", "m", "m"};
  recorded.value.resize(7);
  recorded.value << 0.004, kMounting, 0.5, -0.1, 0.2;
  Eigen::VectorXd sigma(7);
  sigma << 1e-3, 2e-3, 3e-3, 4e-3, 0.05, 0.06, 0.07;
  Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(7, 7);
  correlation(0, 4) = correlation(4, 0) = 0.5;
  recorded.P = sigma.asDiagonal() * correlation * sigma.asDiagonal();
  recorded.prior_value = Eigen::VectorXd::Zero(7);
  recorded.prior_sigma = Eigen::VectorXd::Ones(7);
  recorded.q_sb_nominal["log"] = kNominal;
  return recorded;
}

Dataset WithALog() {
  Dataset dataset;
  AidingStream stream;
  stream.sensor.name = "log";
  stream.sensor.kind = &DvlKind();
  stream.sensor.q_sb = Exp(Eigen::Vector3d(0.0, 0.0, 1.1));
  stream.sensor.scale_sigma = 0.01;
  stream.sensor.mounting_sigma = Eigen::Vector3d::Constant(0.1);
  stream.sensor.lever_arm_sigma = Eigen::Vector3d::Ones();
  dataset.streams.push_back(stream);
  return dataset;
}

TEST(KnownConstants, BecomeValuesAndSigmasOfTheSensor) {
  Dataset dataset = WithALog();
  UseConstants(KnownFrom(OfALog()), {}, &dataset);
  const Sensor& sensor = dataset.streams[0].sensor;
  EXPECT_EQ(sensor.scale, 0.004);
  EXPECT_DOUBLE_EQ(*sensor.scale_sigma, 1e-3);
  EXPECT_EQ(sensor.lever_arm_b, Eigen::Vector3d(0.5, -0.1, 0.2));
  EXPECT_LT(
      (*sensor.lever_arm_sigma - Eigen::Vector3d(0.05, 0.06, 0.07)).norm(),
      1e-15);
  // The whole mounting, whatever the nominal one is here.
  EXPECT_LT(Log(sensor.q_sb * (Exp(kMounting) * kNominal).conjugate()).norm(),
            1e-12);
}

/// d Log(Exp(m + dm) Exp(m)^-1) over dm is what the covariance of the whole
/// mounting is made with.
TEST(KnownConstants, MountingErrorsActAfterTheWhole) {
  const KnownConstants known = KnownFrom(OfALog());
  Eigen::Matrix3d J;
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 3; ++i) {
    J.col(i) = Log(Exp(kMounting + kStep * Eigen::Vector3d::Unit(i)) *
                   Exp(kMounting).conjugate()) /
               kStep;
  }
  const Eigen::Matrix3d P = OfALog().P.block<3, 3>(1, 1);
  EXPECT_LT((known.P.block<3, 3>(1, 1) - J * P * J.transpose()).norm(),
            1e-6 * P.norm());
}

TEST(KnownConstants, AnotherNominalMountingLeavesTheWhole) {
  const Eigen::Quaterniond other = Exp(Eigen::Vector3d(0.31, -0.18, 1.02));
  const RecordedConstants moved = AboutNominal({{"log", other}}, OfALog());
  const KnownConstants known = KnownFrom(moved);
  EXPECT_LT(Log(known.q_sb.at("log") * (Exp(kMounting) * kNominal).conjugate())
                .norm(),
            1e-12);
}

TEST(KnownConstants, WhatIsNotEstimatedOrNotThereIsNamed) {
  Dataset dataset = WithALog();
  dataset.streams[0].sensor.scale_sigma.reset();
  try {
    UseConstants(KnownFrom(OfALog()), {}, &dataset);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("aiding.log.estimate.scale"),
              std::string::npos)
        << error.what();
  }
  dataset = WithALog();
  dataset.streams[0].sensor.name = "dvl";
  EXPECT_THROW(UseConstants(KnownFrom(OfALog()), {}, &dataset), InputError);
  EXPECT_NO_THROW(UseConstants(KnownFrom(OfALog()), {"log"}, &dataset));
}

TEST(KnownConstants, TheClockOfThisRecordingIsItsOwn) {
  RecordedConstants recorded = OfALog();
  recorded.names[0] = "log_time_offset";
  Dataset dataset = WithALog();
  dataset.streams[0].clock_unknown = true;
  dataset.streams[0].sensor.time_offset = 0.3;
  dataset.streams[0].sensor.time_offset_sigma = 0.1;
  UseConstants(KnownFrom(recorded), {}, &dataset);
  EXPECT_EQ(dataset.streams[0].sensor.time_offset, 0.3);
  ASSERT_EQ(dataset.notes.size(), 1u);
  const std::vector<std::string> own = {"log_time_offset"};
  EXPECT_EQ(ConstantsOfOneRecording(dataset), own);
  dataset.streams[0].clock_unknown = false;
  dataset.streams[0].clock_placed = true;
  UseConstants(KnownFrom(recorded), {}, &dataset);
  EXPECT_EQ(dataset.streams[0].sensor.time_offset, 0.3);
  ASSERT_EQ(dataset.notes.size(), 2u);
  EXPECT_THAT(dataset.notes[1], ::testing::HasSubstr("configuration places"));
  EXPECT_EQ(ConstantsOfOneRecording(dataset), own);
  dataset.streams[0].clock_placed = false;
  EXPECT_TRUE(ConstantsOfOneRecording(dataset).empty());
  UseConstants(KnownFrom(recorded), {}, &dataset);
  EXPECT_EQ(dataset.streams[0].sensor.time_offset, 0.004);
}

TEST(RecordedConstants, RemoveTakesOneComponentOrAll) {
  RecordedConstants recorded = OfALog();
  EXPECT_FALSE(recorded.Remove("log_offset"));
  EXPECT_TRUE(recorded.Remove("log_mounting"));
  EXPECT_EQ(recorded.MountingOf("log"), -1);
  EXPECT_TRUE(recorded.Remove("log_lever_arm[y]"));
  EXPECT_EQ(recorded.names,
            (std::vector<std::string>{"log_scale", "log_lever_arm[x]",
                                      "log_lever_arm[z]"}));
  EXPECT_EQ(recorded.value, Eigen::VectorXd(Eigen::Vector3d(0.004, 0.5, 0.2)));
  EXPECT_NEAR(recorded.P(0, 1), 0.5 * 1e-3 * 0.05, 1e-15);
}

}  // namespace
}  // namespace hindsight
