#include "imu/mean_reading.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hindsight {
namespace {

using Kind = ImuStream::Kind;

constexpr double kDt = 0.01;

/// 30 s at 100 Hz that turn at `turn` [rad/s] up to 10 s and from 12 s on, and
/// stand between.
ImuStream TurnsAround(Kind kind, double turn) {
  ImuStream imu;
  imu.kind = kind;
  imu.nominal_dt = kDt;
  for (int k = 0; k <= 3000; ++k) {
    ImuSample s;
    s.t = kDt * k;
    const bool rates = kind == Kind::kRates;
    const bool turns = k < (rates ? 1000 : 1001) || k > 1200;
    s.gyro.z() = turns ? turn : 0.0;
    s.accel.z() = -9.81;
    if (!rates) {
      s.gyro *= kDt;
      s.accel *= kDt;
    }
    imu.samples.push_back(s);
  }
  return imu;
}

TEST(MeanReading, TakesNothingFromBesideItsSpan) {
  for (const Kind kind : {Kind::kRates, Kind::kIncrements}) {
    const ImuStream imu = TurnsAround(kind, 1.0);
    for (const double inside : {0.0, 0.004, -1e-9}) {
      const Kinematics mean = MeanReading(imu, 10.0 + inside, 12.0 - inside);
      EXPECT_NEAR(mean.w_ib_b.norm(), 0.0, 1e-15) << inside;
      EXPECT_NEAR(mean.f_b.z(), -9.81, 1e-12) << inside;
    }
    // The interval before is the span's once the span holds all of it.
    const double part = MeanReading(imu, 9.991, 12.0).w_ib_b.z();
    const double whole = MeanReading(imu, 9.99, 12.0).w_ib_b.z();
    EXPECT_NEAR(part, 0.0, 1e-15);
    EXPECT_NEAR(whole, (kind == Kind::kRates ? 0.5 : 1.0) / 201.0, 1e-12);
  }
}

TEST(MeanReading, IsTheIntegralOverItsLengthAtAnyStamps) {
  ImuStream rates;
  ImuStream increments;
  increments.kind = Kind::kIncrements;
  const auto integral = [](double t) {
    return Eigen::Vector3d(0.5 * t * t, t - t * t, 2.0 * t);
  };
  double t = 0.0;
  for (int k = 0; k <= 400; ++k) {
    const double from = t;
    t += kDt * (1.0 + 0.5 * std::sin(k));
    const Eigen::Vector3d rate(t, 1.0 - 2.0 * t, 2.0);
    rates.samples.push_back({t, rate, -rate});
    const Eigen::Vector3d sum = integral(t) - integral(from);
    increments.samples.push_back({t, sum, -sum});
  }
  for (const ImuStream& imu : {rates, increments}) {
    const double begin = imu.samples[20].t;
    const double end = imu.samples[350].t;
    const Eigen::Vector3d expected =
        (integral(end) - integral(begin)) / (end - begin);
    const Kinematics mean = MeanReading(imu, begin, end);
    EXPECT_LT((mean.w_ib_b - expected).norm(), 1e-12);
    EXPECT_LT((mean.f_b + expected).norm(), 1e-12);
  }
}

TEST(MeanReading, OfASpanWithoutAnIntervalIsThatAtItsMiddle) {
  for (const Kind kind : {Kind::kRates, Kind::kIncrements}) {
    const ImuStream imu = TurnsAround(kind, 1.0);
    EXPECT_NEAR(MeanReading(imu, 10.012, 10.018).w_ib_b.z(), 0.0, 1e-15);
    EXPECT_NEAR(MeanReading(imu, 9.973, 9.986).w_ib_b.z(), 1.0, 1e-12);
    EXPECT_NEAR(MeanReading(imu, -2.0, -1.0).w_ib_b.z(), 1.0, 1e-12);
    EXPECT_NEAR(MeanReading(imu, 31.0, 32.0).w_ib_b.z(), 1.0, 1e-12);
  }
}

TEST(MeanReadings, AreWithoutBiasAndScaleFromHalfWayToHalfWay) {
  const ImuStream imu = TurnsAround(Kind::kRates, 1.0);
  ImuCalibration calibration;
  calibration.b_g.z() = 0.2;
  calibration.s_g.z() = 0.25;
  calibration.b_a.z() = 0.19;
  const std::vector<double> times = {2.0, 4.0, 11.0, 11.8, 20.0};
  std::vector<Kinematics> motion = MeanReadings(imu, times);
  for (Kinematics& mean : motion) mean = WithoutErrors(mean, calibration);
  ASSERT_EQ(motion.size(), times.size());
  EXPECT_NEAR(motion[0].w_ib_b.z(), 0.8 / 1.25, 1e-12);
  EXPECT_NEAR(motion[0].f_b.z(), -10.0, 1e-12);
  // 7.5 s to 11.4 s, of which it turns to 10 s.
  EXPECT_NEAR(motion[2].w_ib_b.z(), (2.5 / 3.9 - 0.2) / 1.25, 2e-3);
  EXPECT_NEAR(motion.back().w_ib_b.z(), 0.8 / 1.25, 1e-12);
}

}  // namespace
}  // namespace hindsight
