#include "dataset/checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "measurements/sensor_kind.h"
#include "support/walking_foot.h"

namespace hindsight {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// 60 s at 100 Hz: at rest for the first 20 s, then shaken.
Dataset Recording(const Eigen::Vector3d& rest_force) {
  Dataset data;
  for (int i = 0; i <= 6000; ++i) {
    const double t = 0.01 * i;
    const double shake = t < 20.0 ? 0.0 : std::sin(30.0 * t);
    data.imu.samples.push_back({t, Eigen::Vector3d(0.001, 0.1 * shake, 0.0),
                                rest_force + Eigen::Vector3d::Constant(shake)});
  }
  AidingStream stream;
  stream.sensor.name = "gnss";
  stream.sensor.time_offset = 0.2;
  for (int i = 0; i <= 90; ++i) {
    if (i >= 30 && i < 40) continue;
    stream.measurements.push_back({1.0 * i, 0, false, PositionFix{}});
  }
  data.streams.push_back(stream);
  return data;
}

TEST(CheckDataset, ReportsRateGapAndOverlap) {
  const CheckReport report = CheckDataset(Recording({0, 0, -9.81}));
  ASSERT_EQ(report.streams.size(), 2u);
  EXPECT_NEAR(report.streams[0].rate, 100.0, 1e-6);
  EXPECT_TRUE(report.streams[0].gaps.empty());
  const StreamReport& gnss = report.streams[1];
  EXPECT_EQ(gnss.count, 81);
  EXPECT_NEAR(gnss.rate, 1.0, 1e-9);
  ASSERT_EQ(gnss.gaps.size(), 1u);
  EXPECT_NEAR(gnss.gaps[0].length, 11.0, 1e-9);
  EXPECT_NEAR(gnss.t_begin, 0.2, 1e-12);
  EXPECT_NEAR(gnss.overlap, 59.8, 1e-9);
}

TEST(CheckDataset, StampsInAnotherUnitAreNamed) {
  Dataset data = Recording({0, 0, -9.81});
  const auto warnings = [&] { return CheckDataset(data).warnings; };
  EXPECT_THAT(warnings(), Not(Contains(HasSubstr("its stamps may be"))));
  AidingStream& gnss = data.streams[0];
  gnss.measurements.clear();
  for (int i = 0; i <= 60; ++i) {
    gnss.measurements.push_back({1000.0 * i, 0, false, PositionFix{}});
  }
  EXPECT_THAT(warnings(),
              Contains("gnss: only 59.8 s of 60000.0 s lie within the IMU's "
                       "record; its stamps may be ms"));
  gnss.measurements.clear();
  for (int i = 0; i <= 60; ++i) {
    gnss.measurements.push_back({200.0 + i, 0, false, PositionFix{}});
  }
  EXPECT_THAT(warnings(), Contains(HasSubstr("lie within the IMU's record")));
  EXPECT_THAT(warnings(), Not(Contains(HasSubstr("its stamps may be"))));
}

TEST(CheckDataset, FlagsOfStandingComeWhenTheyCome) {
  for (const bool flag : {false, true}) {
    Dataset data = Recording({0, 0, -9.81});
    AidingStream stream;
    stream.sensor.name = "stance";
    if (flag) stream.sensor.kind = &ZeroVelocityKind();
    for (int i = 0; i < 100; ++i) {
      const double t = 0.5 * i + (i % 3 == 0 ? 0.3 : 0.0);
      Measurement z{t, 1, false, PositionFix{}};
      if (flag) z.model = ZeroVelocity{0.05};
      stream.measurements.push_back(z);
    }
    data.streams.push_back(stream);
    const CheckReport report = CheckDataset(data);
    EXPECT_EQ(std::any_of(report.warnings.begin(), report.warnings.end(),
                          [](const std::string& warning) {
                            return warning.starts_with("stance: intervals");
                          }),
              !flag);
  }
}

TEST(CheckDataset, GravityTellsGyrosInAnotherUnit) {
  const testing::Walk walk = {
      .rate = 100.0, .force_noise = 0.005, .rate_noise = 0.02};
  const testing::WalkRows rows = testing::Steps(walk, 1);
  const auto warnings = [&](double factor) {
    Dataset data = Recording({0, 0, -9.81});
    data.imu.samples.clear();
    for (std::size_t k = 0; k < rows.accel.size(); ++k) {
      data.imu.samples.push_back({0.01 * static_cast<double>(k),
                                  factor * rows.gyro[k],
                                  kStandardGravity * rows.accel[k]});
    }
    std::string text;
    for (const std::string& warning : CheckDataset(data).warnings) {
      text += warning + "\n";
    }
    return text;
  };
  EXPECT_THAT(warnings(1.0), Not(HasSubstr("declared as")));
  EXPECT_THAT(warnings(1.0 / kDegree),
              HasSubstr("like deg/s, declared as rad/s; correct the unit"));
  EXPECT_THAT(warnings(kDegree), HasSubstr("like rad/s, declared as deg/s"));
}

TEST(CheckDataset, MeasuresForceAtRest) {
  const CheckReport report = CheckDataset(Recording({0, 0, -9.81}));
  EXPECT_NEAR(TotalLength(report.imu.rest.at_rest), 20.0, 1.5);
  ASSERT_TRUE(report.imu.rest_force);
  EXPECT_NEAR(report.imu.rest_force->z(), -9.81, 1e-3);
  EXPECT_NEAR(report.imu.rest_rate->x(), 0.001, 1e-5);
  EXPECT_TRUE(report.warnings.empty());
  EXPECT_THAT(report.axes, HasSubstr("as it should"));
}

TEST(CheckDataset, AnImuAloneIsNotSaidToStand) {
  Dataset data = Recording({0, 0, 9.81});
  data.streams.clear();
  const CheckReport report = CheckDataset(data);
  EXPECT_TRUE(report.imu.rest.at_rest.empty());
  ASSERT_EQ(report.imu.rest.undecided.size(), 1u);
  EXPECT_NEAR(TotalLength(report.imu.rest.undecided), 20.0, 1.5);
  EXPECT_FALSE(report.imu.rest_force);
  // Gravity is felt all the same.
  EXPECT_THAT(report.axes, HasSubstr("forward-left-up"));
}

TEST(CheckDataset, WarnsOfASteadyRateThatNoBiasExplains) {
  Dataset data = Recording({0, 0, -9.81});
  for (ImuSample& sample : data.imu.samples) sample.gyro.z() += 0.1;
  EXPECT_THAT(CheckDataset(data).warnings,
              ::testing::Contains(HasSubstr("5.73 deg/s, more than")));
  data.initial.gyro_bias.z() = 0.1;
  EXPECT_TRUE(CheckDataset(data).warnings.empty());
}

TEST(CheckDataset, SuggestsAxesThatMakeZPointDown) {
  const CheckReport up = CheckDataset(Recording({0, 0, 9.81}));
  EXPECT_THAT(up.axes, HasSubstr("forward-left-up"));
  EXPECT_THAT(up.axes, HasSubstr("[x, -y, -z]"));
  ASSERT_EQ(up.warnings.size(), 1u);
  EXPECT_THAT(CheckDataset(Recording({9.81, 0, 0})).axes,
              HasSubstr("[z, y, -x]"));
  EXPECT_THAT(CheckDataset(Recording({0, -9.81, 0})).axes,
              HasSubstr("[z, x, y]"));
}

TEST(CheckDataset, WarnsOfForceInTheWrongUnit) {
  Dataset data = Recording({0, 0, -9.81});
  for (ImuSample& sample : data.imu.samples) sample.accel /= kStandardGravity;
  const CheckReport report = CheckDataset(data);
  ASSERT_FALSE(report.warnings.empty());
  EXPECT_THAT(report.warnings[0], HasSubstr("check the unit"));
}

/// In the hand, shaken all the time but for two seconds, as the mean of |f|
/// shows, which is no sign of a wrong unit.
TEST(CheckDataset, GravityIsSoughtWhereTheForceVariesLeast) {
  Dataset data = Recording({0, 0, -9.81});
  for (ImuSample& sample : data.imu.samples) {
    const bool quiet = sample.t > 40.0 && sample.t < 42.5;
    const double shake = (quiet ? 0.3 : 15.0) * std::sin(40.0 * sample.t);
    sample.accel = Eigen::Vector3d(shake, 0.7 * shake, -9.81);
    sample.gyro.setConstant(0.1 * shake);
  }
  const CheckReport report = CheckDataset(data);
  EXPECT_FALSE(report.imu.rest_force);
  EXPECT_GT(report.imu.record.mean_force, 12.0);
  EXPECT_NEAR(report.imu.record.quietest_force.norm(), 9.81, 0.1);
  EXPECT_TRUE(report.warnings.empty());
  for (ImuSample& sample : data.imu.samples) sample.accel /= 9.81;
  EXPECT_THAT(CheckDataset(data).warnings,
              ::testing::Contains(HasSubstr("where it varies least")));
}

/// Rows each 20 ms and further ones between them, each with its right stamp.
TEST(CheckDataset, RowsBetweenRegularOnesAreNoSignOfReception) {
  Dataset data = Recording({0, 0, -9.81});
  const auto add = [&data](double t) {
    TruthPoint point;
    point.t = t;
    data.truth.push_back(point);
  };
  for (int i = 0; i < 2900; ++i) {
    add(0.02 * i);
    if (i % 6 == 0) add(0.02 * i + 0.001 * (i % 18));
  }
  const CheckReport extra = CheckDataset(data);
  EXPECT_GT(extra.streams.back().jitter, 0.2 * 0.02);
  EXPECT_TRUE(extra.truth_warnings.empty());
  data.truth.clear();
  for (int i = 0; i < 2900; ++i) {
    add(0.02 * i + 0.005 * (i % 3));
  }
  EXPECT_EQ(CheckDataset(data).truth_warnings.size(), 1u);
}

}  // namespace
}  // namespace hindsight
