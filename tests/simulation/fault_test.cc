#include "simulation/fault.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/units.h"
#include "io/config/scenario_config.h"
#include "simulation/scenario.h"

namespace hindsight {
namespace {

Dataset Drive() { return Simulate(FindScenario("short_drive", {}), 1); }

Fault Make(const char* kind, double size, const char* sensor = "") {
  return {FindFaultKind(kind), sensor, size};
}

Dataset WithFault(const Fault& fault, std::uint64_t seed = 1) {
  Dataset dataset = Drive();
  ApplyFault(fault, seed, &dataset);
  return dataset;
}

const AidingStream& StreamOf(const Dataset& dataset, const char* kind) {
  for (const AidingStream& stream : dataset.streams) {
    if (stream.sensor.kind->name == kind) return stream;
  }
  throw std::out_of_range(kind);
}

Eigen::Vector3d PositionOf(const Measurement& z) {
  return std::get<PositionFix>(z.model).p_e;
}

bool SameMeasurements(const AidingStream& a, const AidingStream& b) {
  for (std::size_t i = 0; i < a.measurements.size(); ++i) {
    const Measurement x = a.measurements[i], y = b.measurements[i];
    if (x.t != y.t || Rows(x) != Rows(y)) return false;
    if (x.model.index() != y.model.index()) return false;
    if (const auto* p = std::get_if<PositionFix>(&x.model)) {
      const auto& q = std::get<PositionFix>(y.model);
      if (p->p_e != q.p_e || p->R_n != q.R_n) return false;
    }
    if (const auto* v = std::get_if<VelocityFix>(&x.model)) {
      const auto& w = std::get<VelocityFix>(y.model);
      if (v->v_n != w.v_n || v->R_n != w.R_n) return false;
    }
  }
  return a.sensor.lever_arm_b == b.sensor.lever_arm_b;
}

bool SameImu(const Dataset& a, const Dataset& b) {
  for (std::size_t i = 0; i < a.imu.samples.size(); ++i) {
    const ImuSample &x = a.imu.samples[i], &y = b.imu.samples[i];
    if (x.t != y.t || x.gyro != y.gyro || x.accel != y.accel) return false;
  }
  return a.imu.noise.gyro_noise_density == b.imu.noise.gyro_noise_density;
}

TEST(Fault, EveryKindChangesWhatItIsOfAndNothingElse) {
  const Dataset well = Drive();
  for (const FaultKind& kind : FaultKinds()) {
    SCOPED_TRACE(std::string(kind.name));
    const bool of_sensor = kind.of == FaultKind::Of::kSensor;
    const Fault fault = {&kind, of_sensor ? "position" : "", 2.0};
    const bool has_place = HasPlaceFor(fault, well);
    EXPECT_EQ(has_place,
              kind.of != FaultKind::Of::kStart || well.initial.euler);
    if (!has_place) continue;
    const Dataset faulty = WithFault(fault);
    EXPECT_EQ(SameMeasurements(StreamOf(well, "position"),
                               StreamOf(faulty, "position")),
              !of_sensor);
    EXPECT_TRUE(SameMeasurements(StreamOf(well, "velocity"),
                                 StreamOf(faulty, "velocity")));
    EXPECT_EQ(SameImu(well, faulty), kind.of != FaultKind::Of::kImu);
  }
}

TEST(Fault, IsTheSameForTheSameSeed) {
  const Fault outliers = Make("outliers", 5.0, "position");
  EXPECT_TRUE(SameMeasurements(StreamOf(WithFault(outliers, 3), "position"),
                               StreamOf(WithFault(outliers, 3), "position")));
  EXPECT_FALSE(SameMeasurements(StreamOf(WithFault(outliers, 3), "position"),
                                StreamOf(WithFault(outliers, 4), "position")));
}

TEST(Fault, MayLeaveErrorsOnTheirAxes) {
  const PerfectRecording recording(FindScenario("short_drive", {}));
  const Dataset well = recording.Realize(1);
  const Dataset perfect = recording.WithoutErrors(well);
  EXPECT_FALSE(SameImu(well, perfect));
  const Fault fault = Make("accel_swapped", 2.0);
  const auto faulty = WithErrorsAsTheyWere(fault, 1, well, perfect);
  ASSERT_TRUE(faulty);
  for (const std::size_t k : {0u, 100u, 1000u}) {
    const Eigen::Vector3d& truth = perfect.imu.samples[k].accel;
    const Eigen::Vector3d expected =
        Eigen::Vector3d(truth.y(), truth.x(), truth.z()) +
        (well.imu.samples[k].accel - truth);
    EXPECT_NEAR((faulty->imu.samples[k].accel - expected).norm(), 0.0, 1e-12);
  }
  const auto turned =
      WithErrorsAsTheyWere(Make("turned", 0.5, "position"), 1, well, perfect);
  ASSERT_TRUE(turned);
  const auto& fixes = StreamOf(*turned, "position").measurements;
  const auto& before = StreamOf(well, "position").measurements;
  const auto& exact = StreamOf(perfect, "position").measurements;
  // The place that it turns about keeps its error.
  EXPECT_LT((PositionOf(fixes[0]) - PositionOf(before[0])).norm(), 1e-6);
  const std::size_t last = fixes.size() - 1;
  EXPECT_GT((PositionOf(fixes[last]) - PositionOf(exact[last])).norm(), 10.0);
}

/// What is stamped elsewhere, or has something added, keeps them anyway.
TEST(Fault, IsTheSameWithErrorsAsTheyWereWhereItLeavesThemAlone) {
  const PerfectRecording recording(FindScenario("short_drive", {}));
  const Dataset well = recording.Realize(1);
  const Dataset perfect = recording.WithoutErrors(well);
  for (const char* kind : {"delay", "bias", "step", "lever_arm", "sigma"}) {
    EXPECT_FALSE(
        WithErrorsAsTheyWere(Make(kind, 2.0, "position"), 1, well, perfect))
        << kind;
  }
  for (const char* kind : {"accel_step", "imu_noise", "imu_leap", "imu_gap"}) {
    EXPECT_FALSE(WithErrorsAsTheyWere(Make(kind, 2.0), 1, well, perfect))
        << kind;
  }
}

TEST(Fault, MovesAPositionNorthByItsSize) {
  const Dataset well = Drive();
  const Dataset faulty = WithFault(Make("bias", 3.0, "position"));
  const auto& a = StreamOf(well, "position").measurements;
  const auto& b = StreamOf(faulty, "position").measurements;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector3d moved = NedAxes(PositionOf(a[i])).transpose() *
                                  (PositionOf(b[i]) - PositionOf(a[i]));
    EXPECT_NEAR((moved - Eigen::Vector3d(3.0, 0.0, 0.0)).norm(), 0.0, 1e-3);
  }
}

TEST(Fault, HitsATenthOfTheRowsWithOutliersOfItsSize) {
  const Dataset well = Drive();
  const Dataset faulty = WithFault(Make("outliers", 7.0, "position"));
  const auto& a = StreamOf(well, "position").measurements;
  const auto& b = StreamOf(faulty, "position").measurements;
  int hit = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double off = (PositionOf(b[i]) - PositionOf(a[i])).norm();
    if (off < 1e-6) continue;
    ++hit;
    EXPECT_NEAR(off, 7.0, 1e-6);
  }
  // Binomial of a tenth of 180: 18 +- 4.
  EXPECT_GE(hit, 6);
  EXPECT_LE(hit, 30);
}

TEST(Fault, DelaysStampsFromTheMiddleOn) {
  const Dataset well = Drive();
  const Dataset faulty = WithFault(Make("clock_leap", 0.5, "position"));
  const auto& a = StreamOf(well, "position").measurements;
  const auto& b = StreamOf(faulty, "position").measurements;
  const double middle = 0.5 * (well.imu.t_begin() + well.imu.t_end());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(b[i].t - a[i].t, a[i].t < middle ? 0.0 : 0.5, 1e-12);
  }
}

TEST(Fault, LeapsTheImusClockAndLosesItsSamples) {
  const Dataset well = Drive();
  const double middle = 0.5 * (well.imu.t_begin() + well.imu.t_end());
  const Dataset leapt = WithFault(Make("imu_leap", 0.25));
  ASSERT_EQ(leapt.imu.samples.size(), well.imu.samples.size());
  for (std::size_t i = 0; i < well.imu.samples.size(); ++i) {
    const double t = well.imu.samples[i].t;
    EXPECT_NEAR(leapt.imu.samples[i].t - t, t < middle ? 0.0 : 0.25, 1e-12);
  }
  EXPECT_EQ(DropOuts(leapt.imu).size(), 1u);
  const Dataset lost = WithFault(Make("imu_gap", 0.25));
  ASSERT_EQ(DropOuts(lost.imu).size(), 1u);
  const std::size_t end = DropOuts(lost.imu).front();
  EXPECT_NEAR(lost.imu.samples[end].t - lost.imu.samples[end - 1].t,
              0.25 + MedianInterval(well.imu), 1.01 * MedianInterval(well.imu));
  EXPECT_EQ(lost.imu.t_end(), well.imu.t_end());
}

TEST(Fault, SaysEachReadingAsOftenAsItsSize) {
  const Dataset faulty = WithFault(Make("stale", 5.0, "position"));
  const auto& z = StreamOf(faulty, "position").measurements;
  for (std::size_t i = 0; i + 1 < z.size(); ++i) {
    const bool same = PositionOf(z[i]) == PositionOf(z[i + 1]);
    EXPECT_EQ(same, (i + 1) % 5 != 0) << i;
  }
}

TEST(Fault, TurnsTheWholeImu) {
  const Dataset well = Drive();
  const Dataset faulty = WithFault(Make("imu_turned", 90.0 * kDegree));
  for (std::size_t i = 0; i < well.imu.samples.size(); ++i) {
    const Eigen::Vector3d& a = well.imu.samples[i].accel;
    const Eigen::Vector3d& b = faulty.imu.samples[i].accel;
    EXPECT_NEAR((b - Eigen::Vector3d(a.z(), a.y(), -a.x())).norm(), 0.0, 1e-12);
  }
}

}  // namespace
}  // namespace hindsight
