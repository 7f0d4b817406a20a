#include "evaluation/outages.h"

#include <gtest/gtest.h>

#include <cmath>

#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

AidingStream Stream(const std::string& name, const SensorKind& kind,
                    double time_offset = 0.0) {
  AidingStream stream;
  stream.sensor.name = name;
  stream.sensor.kind = &kind;
  stream.sensor.time_offset = time_offset;
  return stream;
}

ResidualRecord Withheld(double t, int sensor, const Eigen::Vector3d& residual) {
  ResidualRecord record;
  record.t = t;
  record.sensor = sensor;
  record.withheld = true;
  record.residual = residual;
  return record;
}

/// Speeding up from rest at 1 m/s^2, rows 4 s apart.
Solution Accelerating(double until) {
  Solution solution;
  for (double t = 0.0; t <= until; t += 4.0) {
    State x;
    x.t = t;
    x.v_e = {t, 0.0, 0.0};
    solution.states.push_back(x);
  }
  return solution;
}

TEST(Outages, MatchHandComputedCase) {
  Dataset dataset;
  dataset.streams = {Stream("gnss", PositionKind())};
  dataset.outages = {{0, 10.0, 20.0}, {0, 30.0, 40.0}};
  Solution solution = Accelerating(48.0);
  solution.residuals = {Withheld(10.0, 0, {3.0, 4.0, 0.0}),
                        Withheld(20.0, 0, {0.0, 1.0, 2.0}),
                        Withheld(35.0, 0, {6.0, 8.0, 24.0})};
  ResidualRecord used = Withheld(25.0, 0, {100.0, 0.0, 0.0});
  used.withheld = false;
  solution.residuals.push_back(used);

  const std::vector<OutageError> outages =
      ComputeOutageErrors(solution, dataset);
  ASSERT_EQ(outages.size(), 2u);
  EXPECT_EQ(outages[0].count, 2u);
  EXPECT_DOUBLE_EQ(outages[0].error->horizontal_rms, std::sqrt(13.0));
  EXPECT_DOUBLE_EQ(outages[0].error->horizontal_max, 5.0);
  EXPECT_DOUBLE_EQ(outages[0].error->total_rms, std::sqrt(15.0));
  EXPECT_DOUBLE_EQ(outages[0].error->total_max, 5.0);
  EXPECT_NEAR(outages[0].distance, 0.5 * (400.0 - 100.0), 1e-9);
  EXPECT_NEAR(*outages[0].drift_percent, 100.0 * 5.0 / 150.0, 1e-9);
  EXPECT_DOUBLE_EQ(outages[1].error->total_max, 26.0);
  EXPECT_NEAR(outages[1].distance, 350.0, 1e-9);

  const auto pooled = PoolOutageErrors(outages, PositionKind());
  ASSERT_TRUE(pooled);
  EXPECT_NEAR(pooled->horizontal_rms, std::sqrt((25.0 + 1.0 + 100.0) / 3.0),
              1e-12);
  EXPECT_DOUBLE_EQ(pooled->horizontal_max, 10.0);
  EXPECT_NEAR(pooled->total_rms, std::sqrt((25.0 + 5.0 + 676.0) / 3.0), 1e-12);
  EXPECT_FALSE(PoolOutageErrors(outages, VelocityKind()));
}

TEST(Outages, AreKeptApartBySensor) {
  Dataset dataset;
  dataset.streams = {Stream("gnss", PositionKind()),
                     Stream("doppler", VelocityKind()),
                     Stream("barometer", HeightKind())};
  dataset.outages = {{0, 0.0, 10.0}, {1, 0.0, 10.0}, {2, 0.0, 10.0}};
  Solution solution = Accelerating(12.0);
  solution.residuals = {Withheld(5.0, 1, {0.3, 0.4, 0.0})};
  ResidualRecord height;
  height.t = 5.0;
  height.sensor = 2;
  height.withheld = true;
  height.residual = RowVector::Constant(1, 7.0);
  solution.residuals.push_back(height);
  const std::vector<OutageError> outages =
      ComputeOutageErrors(solution, dataset);
  ASSERT_EQ(outages.size(), 2u);
  EXPECT_FALSE(outages[0].error);
  EXPECT_FALSE(outages[0].drift_percent);
  EXPECT_DOUBLE_EQ(outages[1].error->horizontal_max, 0.5);
  EXPECT_FALSE(outages[1].drift_percent);
  EXPECT_FALSE(PoolOutageErrors(outages, PositionKind()));
}

TEST(Outages, AllowForTheTimeOffsetAtTheEdges) {
  Dataset dataset;
  dataset.streams = {Stream("gnss", PositionKind(), -0.2)};
  dataset.outages = {{0, 10.0, 20.0}};
  Solution solution = Accelerating(24.0);
  solution.residuals = {Withheld(9.8, 0, {1.0, 0.0, 0.0})};
  EXPECT_EQ(ComputeOutageErrors(solution, dataset)[0].count, 1u);
}

TEST(Outages, BackToBackShareNoMeasurement) {
  Dataset dataset;
  dataset.streams = {Stream("gnss", PositionKind())};
  dataset.outages = {{0, 0.0, 10.0}, {0, 10.0, 20.0}};
  Solution solution = Accelerating(24.0);
  solution.residuals = {Withheld(10.0, 0, {1.0, 0.0, 0.0})};
  const auto outages = ComputeOutageErrors(solution, dataset);
  EXPECT_EQ(outages[0].count, 0u);
  EXPECT_EQ(outages[1].count, 1u);
}

TEST(Outages, HaveNoDriftAtStandstill) {
  Dataset dataset;
  dataset.streams = {Stream("gnss", PositionKind())};
  dataset.outages = {{0, 1.0, 2.0}};
  Solution solution;
  solution.states.resize(2);
  solution.states[1].t = 4.0;
  solution.residuals = {Withheld(1.5, 0, {1.0, 0.0, 0.0})};
  const auto outages = ComputeOutageErrors(solution, dataset);
  EXPECT_TRUE(outages[0].error);
  EXPECT_FALSE(outages[0].drift_percent);
}

}  // namespace
}  // namespace hindsight
