#include "simulation/imu_simulator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "geometry/so3.h"
#include "imu/imu_link.h"
#include "imu/sample_integral.h"
#include "simulation/wandering_drive.h"

namespace hindsight {
namespace {

ImuStream Perfect(Trajectory* trajectory, ImuStream::Kind kind,
                  double rate_hz) {
  ImuStream stream;
  stream.kind = kind;
  ImuSimulator simulator(trajectory, kind, rate_hz, trajectory->t_end());
  stream.samples.resize(simulator.size());
  for (ImuSample& sample : stream.samples) {
    EXPECT_TRUE(simulator.Next(&sample));
  }
  ImuSample none;
  EXPECT_FALSE(simulator.Next(&none));
  return stream;
}

SegmentTrajectory Drive(double duration, std::uint64_t seed) {
  return SegmentTrajectory(
      {0.8, 0.2, 400.0}, MotionProfile(WanderingDrive(duration, seed), 0, 1.0),
      200.0);
}

struct NavigationError {
  double position = 0.0;  ///< largest [m]
  double velocity = 0.0;  ///< [m/s]
  double rotation = 0.0;  ///< [rad]
};

/// Mechanises increments sample by sample in the inertial axes of the first
/// stamp (so that no rounding of a repeated rotation of 6.4e6 m adds up).
NavigationError Mechanise(const ImuStream& imu, Trajectory* trajectory) {
  const Motion start = trajectory->At(imu.t_begin());
  Eigen::Vector3d P = start.p_e;
  Eigen::Vector3d V = start.v_e + EarthRate_e().cross(start.p_e);
  Eigen::Quaterniond R = start.q_eb;
  Eigen::Vector3d g = Gravitation(P);
  NavigationError worst;
  for (std::size_t k = 1; k < imu.samples.size(); ++k) {
    const ImuSample& now = imu.samples[k];
    const ImuSample& before = imu.samples[k - 1];
    const double dt = now.t - before.t;
    const double dt_previous = k > 1 ? before.t - imu.samples[k - 2].t : dt;
    const SampleIntegral s = Integrate(RatesFromIncrements(
        dt_previous, before.gyro, before.accel, dt, now.gyro, now.accel));
    const Eigen::Quaterniond E = Exp(EarthRate_e() * (now.t - imu.t_begin()));
    const Eigen::Vector3d P_free = P + dt * V + R * s.dp;
    Eigen::Vector3d g_end = g;
    for (int pass = 0; pass < 2; ++pass) {
      P = P_free + (dt * dt) * (g / 3.0 + g_end / 6.0);
      g_end = E * Gravitation(E.conjugate() * P);
    }
    V += R * s.dv + (0.5 * dt) * (g + g_end);
    R = (R * Exp(s.phi)).normalized();
    g = g_end;

    const Motion truth = trajectory->At(now.t);
    const Eigen::Vector3d V_true =
        E * (truth.v_e + EarthRate_e().cross(truth.p_e));
    worst.position = std::max(worst.position, (P - E * truth.p_e).norm());
    worst.velocity = std::max(worst.velocity, (V - V_true).norm());
    worst.rotation =
        std::max(worst.rotation, Log((E * truth.q_eb).conjugate() * R).norm());
  }
  return worst;
}

TEST(InvertSample, GivesBackTheRotationAndVelocityIncrement) {
  Random random(4);
  for (int k = 0; k < 1000; ++k) {
    const double dt_previous = 0.004 + 0.004 * random.Uniform();
    const double dt = 0.004 + 0.004 * random.Uniform();
    ImuSample previous;
    previous.gyro = dt_previous * 3.0 * random.NormalVector3();
    previous.accel = dt_previous * 30.0 * random.NormalVector3();
    const Eigen::Vector3d phi = dt * 3.0 * random.NormalVector3();
    const Eigen::Vector3d dv = dt * 30.0 * random.NormalVector3();
    const ImuSample s = InvertSample(dt_previous, previous, dt, phi, dv);
    const SampleIntegral back = Integrate(RatesFromIncrements(
        dt_previous, previous.gyro, previous.accel, dt, s.gyro, s.accel));
    EXPECT_LT((back.phi - phi).norm(), 1e-15);
    EXPECT_LT((back.dv - dv).norm(), 1e-15);
    EXPECT_GT((s.accel - dv).norm(), 0.0);
  }
}

TEST(ImuSimulator, StandingReadsGravityAndEarthRate) {
  // Normal gravity on the ellipsoid at 45 deg (Somigliana), heading east.
  const double gravity = 9.806197769;
  SegmentTrajectory trajectory(
      {45.0 * kDegree, 0.3, 0.0},
      MotionProfile({Segment::Straight(1.0)}, 0.0, 90.0 * kDegree), 100.0);
  const double w = kEarthRate * std::sqrt(0.5);
  const Eigen::Vector3d w_ib_b(0.0, -w, -w);
  const Eigen::Vector3d f_b(0.0, 0.0, -gravity);
  const ImuStream rates = Perfect(&trajectory, ImuStream::Kind::kRates, 100.0);
  const ImuStream increments =
      Perfect(&trajectory, ImuStream::Kind::kIncrements, 100.0);
  ASSERT_EQ(rates.samples.size(), 101U);
  ASSERT_EQ(increments.samples.size(), 101U);
  for (std::size_t k = 0; k <= 100; ++k) {
    EXPECT_LT((rates.samples[k].gyro - w_ib_b).norm(), 1e-15);
    EXPECT_LT((rates.samples[k].accel - f_b).norm(), 1e-8);
    EXPECT_LT((increments.samples[k].gyro - 0.01 * w_ib_b).norm(), 1e-14);
    EXPECT_LT((increments.samples[k].accel - 0.01 * f_b).norm(), 1e-10);
  }
}

TEST(ImuSimulator, MechanisedIncrementsReproduceThirtyMinutes) {
  SegmentTrajectory trajectory = Drive(1800.0, 5);
  const ImuStream imu =
      Perfect(&trajectory, ImuStream::Kind::kIncrements, 200.0);
  const NavigationError error = Mechanise(imu, &trajectory);
  RecordProperty("position_um", std::to_string(1e6 * error.position));
  RecordProperty("rotation_prad", std::to_string(1e12 * error.rotation));
  EXPECT_LT(error.position, 1e-4);
  EXPECT_LT(error.velocity, 1e-6);
  EXPECT_LT(error.rotation, 1e-10);
}

TEST(ImuSimulator, MechanisedIncrementsReproduceAnAircraftOverThePole) {
  SegmentTrajectory trajectory(
      {89.9 * kDegree, 0.5, 9000.0},
      MotionProfile({Segment::Straight(40.0),
                     Segment::BankedTurn(70.0 * kDegree, 3.0 * kDegree),
                     Segment::Straight(40.0)},
                    230.0, 0.0),
      100.0);
  const ImuStream imu =
      Perfect(&trajectory, ImuStream::Kind::kIncrements, 100.0);
  const NavigationError error = Mechanise(imu, &trajectory);
  EXPECT_LT(error.position, 1e-5);
  EXPECT_LT(error.velocity, 1e-7);
  EXPECT_LT(error.rotation, 1e-11);
}

TEST(ImuSimulator, PredictionReproducesTheMotionAcrossTheDateLine) {
  SegmentTrajectory trajectory(
      {-17.0 * kDegree, 179.999 * kDegree, 50.0},
      MotionProfile({Segment::Straight(5.0),
                     Segment::Turn(30.0 * kDegree, 10.0 * kDegree),
                     Segment::Straight(10.0)},
                    30.0, 80.0 * kDegree),
      100.0);
  const ImuStream imu =
      Perfect(&trajectory, ImuStream::Kind::kIncrements, 100.0);
  ASSERT_GT(GeodeticFromEcef(trajectory.At(0.0).p_e).longitude, 0.0);
  ASSERT_LT(GeodeticFromEcef(trajectory.At(18.0).p_e).longitude, 0.0);
  const ErrorLayout layout = NavigationLayout({});
  ImuIntegrator integrator(imu);
  const Motion start = trajectory.At(0.0);
  State x;
  x.p_e = start.p_e;
  x.v_e = start.v_e;
  x.q_eb = start.q_eb;
  for (double t = 0.0; t < 18.0; t += 0.5) {
    x = Predict(layout, x, integrator.Summarize(t, t + 0.5, {}));
  }
  const Motion end = trajectory.At(18.0);
  // Gravitation taken as linear over 0.5 s errs by g w_ie^2 dt^2/12 = 1e-9
  // m/s^2, and by its gradient times the motion within the interval.
  EXPECT_LT((x.p_e - end.p_e).norm(), 2e-5);
  EXPECT_LT((x.v_e - end.v_e).norm(), 2e-6);
  EXPECT_LT(Log(end.q_eb.conjugate() * x.q_eb).norm(), 1e-11);
}

TEST(ImuSimulator, IncrementsAreTheIntegralsOfTheRates) {
  SegmentTrajectory trajectory = Drive(120.0, 6);
  const ImuStream imu =
      Perfect(&trajectory, ImuStream::Kind::kIncrements, 200.0);
  double gyro = 0.0;
  double accel = 0.0;
  for (std::size_t k = 1; k < imu.samples.size(); ++k) {
    const double a = imu.samples[k - 1].t;
    const double b = imu.samples[k].t;
    const Kinematics at_a = TrueKinematics(trajectory.At(a));
    const Kinematics mid = TrueKinematics(trajectory.At(0.5 * (a + b)));
    const Kinematics at_b = TrueKinematics(trajectory.At(b));
    const double sixth = (b - a) / 6.0;
    gyro =
        std::max(gyro, (sixth * (at_a.w_ib_b + 4.0 * mid.w_ib_b + at_b.w_ib_b) -
                        imu.samples[k].gyro)
                           .norm());
    accel = std::max(accel, (sixth * (at_a.f_b + 4.0 * mid.f_b + at_b.f_b) -
                             imu.samples[k].accel)
                                .norm());
  }
  // The slope of the two-sample algorithm is half a sample old: the coning and
  // sculling terms err by dt^4/24 w x w'' and dt^4/24 f x w'', with
  // w < 0.36 rad/s, w'' < 36 rad/s^3 (20 deg/s reached within 0.25 s), f < 11.
  const double quartic = std::pow(0.005, 4) / 24.0;
  EXPECT_LT(gyro, 2.0 * quartic * 0.36 * 36.0);
  EXPECT_LT(accel, 2.0 * quartic * 11.0 * 36.0);
}

TEST(ImuSimulator, RatesReproduceTheMotion) {
  SegmentTrajectory trajectory = Drive(120.0, 6);
  const ErrorLayout layout = NavigationLayout({});
  const auto drift = [&](double rate_hz) {
    const ImuStream imu =
        Perfect(&trajectory, ImuStream::Kind::kRates, rate_hz);
    ImuIntegrator integrator(imu);
    const Motion start = trajectory.At(0.0);
    State x;
    x.p_e = start.p_e;
    x.v_e = start.v_e;
    x.q_eb = start.q_eb;
    for (double t = 0.0; t < 100.0; t += 0.5) {
      x = Predict(layout, x, integrator.Summarize(t, t + 0.5, {}));
    }
    return (x.p_e - trajectory.At(100.0).p_e).norm();
  };
  const double fine = drift(200.0);
  EXPECT_LT(fine, 0.02);
  EXPECT_LT(fine, 0.5 * drift(50.0));
}

}  // namespace
}  // namespace hindsight
