#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <variant>

#include "base/units.h"
#include "io/config/scenario_config.h"
#include "problems/reconstruction.h"

namespace hindsight {
namespace {

constexpr const char* kSymmetricMethods[] = {"ekf", "rts", "two_filter",
                                             "iterated", "batch"};

/// A minute and a half of driving from standstill, everything to be aligned.
Dataset ShortDrive() {
  Scenario scenario = FindScenario("short_drive");
  scenario.duration = 90.0;
  scenario.truth_rate_hz = 1.0;
  return Simulate(scenario, 17);
}

/// The largest differences of two solutions over all nodes, those of `b` put
/// back by `undo`.
struct Difference {
  double position = 0.0;  ///< [m]
  double attitude = 0.0;  ///< [rad]
  double sigma = 0.0;     ///< of position, relative
};

template <typename Undo>
Difference Compare(const Solution& a, const Solution& b, const Undo& undo) {
  Difference out;
  EXPECT_EQ(a.states.size(), b.states.size());
  for (std::size_t k = 0; k < std::min(a.states.size(), b.states.size()); ++k) {
    const State& x = a.states[k];
    const State y = undo(b.states[k]);
    EXPECT_NEAR(x.t, y.t, 1e-9);
    out.position = std::max(out.position, (x.p_e - y.p_e).norm());
    out.attitude = std::max(out.attitude, x.q_eb.angularDistance(y.q_eb));
    const Eigen::Vector3d s = a.covariances.Get(k).diagonal().head<3>();
    const Eigen::Vector3d r = b.covariances.Get(k).diagonal().head<3>();
    out.sigma = std::max(
        out.sigma,
        (r.cwiseQuotient(s).cwiseSqrt().array() - 1.0).abs().maxCoeff());
  }
  return out;
}

/// Every method on both recordings; the tolerances are what rounding of times
/// and of positions of 6.4e6 m leaves.
template <typename Undo>
void ExpectSameTrajectory(const Dataset& dataset, const Dataset& moved,
                          const Undo& undo) {
  Reconstruction here(dataset, {});
  Reconstruction there(moved, {});
  for (const std::string method : kSymmetricMethods) {
    const Solution a = here.Run(method);
    const Solution b = there.Run(method);
    const Difference d = Compare(a, b, undo);
    EXPECT_LT(d.position, 1e-4) << a.method;
    EXPECT_LT(d.attitude, 1e-6) << a.method;
    EXPECT_LT(d.sigma, 1e-4) << a.method;
    EXPECT_EQ(a.grade, b.grade) << a.method;
  }
}

TEST(Symmetry, AnHourLaterIsTheSameTrajectory) {
  const Dataset dataset = ShortDrive();
  constexpr double kHourLater = 3600.0;
  Dataset later = dataset;
  for (ImuSample& s : later.imu.samples) s.t += kHourLater;
  for (AidingStream& stream : later.streams) {
    for (Measurement& z : stream.measurements.Edited()) z.t += kHourLater;
  }
  for (TruthPoint& point : later.truth.Edited()) point.t += kHourLater;
  ExpectSameTrajectory(dataset, later, [](State x) {
    x.t -= kHourLater;
    return x;
  });
}

TEST(Symmetry, AnotherLongitudeIsTheSameTrajectory) {
  const Dataset dataset = ShortDrive();
  const Eigen::AngleAxisd turn(2.9, Eigen::Vector3d::UnitZ());
  Dataset east = dataset;
  for (AidingStream& stream : east.streams) {
    for (Measurement& z : stream.measurements.Edited()) {
      if (auto* fix = std::get_if<PositionFix>(&z.model)) {
        fix->p_e = turn * fix->p_e;
      }
    }
  }
  for (TruthPoint& point : east.truth.Edited()) point.p_e = turn * *point.p_e;
  ExpectSameTrajectory(dataset, east, [&](State x) {
    x.p_e = turn.inverse() * x.p_e;
    x.v_e = turn.inverse() * x.v_e;
    x.q_eb = turn.inverse() * x.q_eb;
    return x;
  });
}

TEST(Symmetry, OtherBodyAxesAreTheSameTrajectory) {
  const Dataset dataset = ShortDrive();
  // The vehicle's axes from those of an IMU that is mounted somehow.
  const Eigen::Quaterniond q(
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(0.4, -0.7, 0.5).normalized()));
  Dataset turned = dataset;
  for (ImuSample& s : turned.imu.samples) {
    s.gyro = q.inverse() * s.gyro;
    s.accel = q.inverse() * s.accel;
  }
  for (AidingStream& stream : turned.streams) {
    stream.sensor.lever_arm_b = q.inverse() * stream.sensor.lever_arm_b;
  }
  turned.truth_lever_arm_b = q.inverse() * turned.truth_lever_arm_b;
  for (TruthPoint& point : turned.truth.Edited()) point.q_nb = *point.q_nb * q;
  ExpectSameTrajectory(dataset, turned, [&](State x) {
    x.q_eb = x.q_eb * q.inverse();
    return x;
  });
}

}  // namespace
}  // namespace hindsight
