#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "alignment/start.h"
#include "base/random.h"
#include "base/units.h"
#include "dataset/timeline_builder.h"
#include "filters/two_filter.h"
#include "io/config/scenario_config.h"
#include "measurements/sensor_kind.h"
#include "problems/batch.h"
#include "problems/reconstruction.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

/// A drive of three minutes whose position fixes are missing from 60 s to
/// 150 s, and an odometer at 10 Hz.
Scenario Drive(Odometer::Form form) {
  Scenario s = FindScenario("short_drive");
  s.truth_rate_hz = 10.0;
  s.stationary.enabled = false;
  StartErrors errors;
  errors.position.setConstant(0.1);
  errors.velocity.setConstant(0.05);
  errors.attitude.setConstant(0.2 * kDegree);
  s.start_errors = errors;
  s.aiding.resize(1);
  s.aiding[0].outages.push_back({60.0, 150.0});
  AidingModel odometer(OdometerKind());
  odometer.sensor.name = "odometer";
  odometer.sensor.lever_arm_b = {-0.8, 0.3, 0.4};
  PatternOf<Odometer>(odometer).form = form;
  odometer.rate_hz = 10.0;
  odometer.sigma = form == Odometer::Form::kIncrements
                       ? Eigen::Vector3d(0.002, 1.0, 1.0)
                       : Eigen::Vector3d(0.02, 0.1, 0.1);
  s.aiding.push_back(odometer);
  return s;
}

/// From motion: at rest the start value of the gyro bias holds Earth rate.
Scenario WithoutErrors(Scenario s) {
  s.segments.erase(s.segments.begin());
  s.start_speed = 6.0;
  s.duration = 160.0;
  s.imu.gyro_bias_sigma.setZero();
  s.imu.accel_bias_sigma.setZero();
  s.imu.noise.gyro_noise_density = 1e-12;
  s.imu.noise.accel_noise_density = 1e-12;
  StartErrors none;
  none.position.setZero();
  none.velocity.setZero();
  none.attitude.setZero();
  s.start_errors = none;
  return s;
}

/// Largest horizontal error against the truth at nodes.
double LargestDriveError(const Dataset& dataset, const Solution& solution) {
  double largest = 0.0;
  std::size_t k = 0;
  for (const TruthPoint& truth : dataset.truth) {
    while (k + 1 < solution.states.size() &&
           solution.states[k].t < truth.t - 1e-6) {
      ++k;
    }
    const State& x = solution.states[k];
    if (std::abs(x.t - truth.t) > 1e-6) continue;
    largest = std::max(
        largest,
        (x.C_en().transpose() * (*truth.p_e - x.p_e)).head<2>().norm());
  }
  return largest;
}

AidingStream& OdometerOf(Dataset* dataset) { return dataset->streams[1]; }

TEST(DistanceIncrements, NoErrorsWithoutNoise) {
  const PerfectRecording recording(
      WithoutErrors(Drive(Odometer::Form::kIncrements)));
  Dataset dataset = recording.Realize(1);
  // Realize adds the sensors' noise; the perfect ones are wanted.
  const Scenario scenario = WithoutErrors(Drive(Odometer::Form::kIncrements));
  const auto trajectory = MakeTrajectory(scenario);
  for (std::size_t i = 0; i < 2; ++i) {
    dataset.streams[i].measurements = MeasurementSeries(
        PerfectMeasurements(scenario.aiding[i], static_cast<int>(i),
                            trajectory.get(), scenario.duration));
  }
  dataset.initial.position_sigma = Eigen::Vector3d::Constant(0.1);
  dataset.initial.velocity_sigma = Eigen::Vector3d::Constant(0.1);
  dataset.initial.attitude_sigma = Eigen::Vector3d::Constant(0.2 * kDegree);
  dataset.initial.gyro_bias_sigma = Eigen::Vector3d::Constant(1e-5);
  dataset.initial.accel_bias_sigma = Eigen::Vector3d::Constant(1e-3);
  dataset.imu.noise.gyro_noise_density = 1e-5;
  dataset.imu.noise.accel_noise_density = 1e-4;
  Reconstruction reconstruction(dataset, {});
  for (const std::string method :
       {"ekf", "two_filter", "two_filter_conventional", "two_filter_euler",
        "rts", "iterated", "batch"}) {
    const Solution solution = reconstruction.Run(method);
    EXPECT_LT(LargestDriveError(dataset, solution), 1e-4) << method;
    for (const ResidualRecord& record : solution.residuals) {
      if (record.sensor != 1) continue;
      ASSERT_LT(std::abs(record.residual(0)), 1e-5)
          << method << " at " << record.t;
    }
  }
}

/// One RTS pass about the batch's result is a Gauss-Newton step of the same
/// problem: it stays where it is, with the same covariances. (The mounting is
/// left out: a forward distance knows it by its cosine alone.)
TEST(DistanceIncrements, SmootherIsTheBatch) {
  Scenario scenario = Drive(Odometer::Form::kIncrements);
  scenario.aiding[1].sensor.scale_sigma = 0.01;
  scenario.aiding[1].sensor.lever_arm_sigma = Eigen::Vector3d::Constant(0.1);
  scenario.aiding[1].sensor.time_offset_sigma = 0.01;
  scenario.aiding[1].sensor.count_sigma = 0.003;
  const Dataset dataset = Simulate(scenario, 4);
  const Start start = FindStart(dataset, dataset.imu.t_begin(), 180.0);
  TimelineOptions options;
  options.t_begin = start.report.t;
  options.t_end = dataset.imu.t_end();
  Problem problem = {start.layout, start.prior,
                     BuildTimeline(dataset, options)};
  problem.decisions.assign(problem.timeline.all_measurements().size(), 1);
  const SmoothedTrajectory first = SmoothRts(RunExtendedKalmanFilter(&problem));
  problem.timeline.LinearizeTimeOffsets(start.layout, first.states);
  const BatchResult batch = SolveBatch(first.states, {}, &problem);
  ASSERT_TRUE(batch.converged);
  const LinearTape tape = RunLinearizedFilter(batch.states, &problem);
  const SmoothedTrajectory rts = SmoothRts(tape);
  const SmoothedTrajectory two_filter = SmoothTwoFilter(tape).trajectory;
  for (std::size_t k = 0; k < batch.states.size(); k += 20) {
    EXPECT_LT((rts.states[k].p_e - batch.states[k].p_e).norm(), 1e-5);
    EXPECT_LT((rts.states[k].p_e - two_filter.states[k].p_e).norm(), 1e-5);
    const ErrorMatrix P = batch.P.Get(k);
    for (const SmoothedTrajectory* smoothed : {&rts, &two_filter}) {
      EXPECT_LT(testing::ScaledDifference(smoothed->P.Get(k), P), 1e-4)
          << "at " << batch.states[k].t;
    }
  }
  const Block& scale = *start.layout.Find(BlockKind::kScale, 1);
  const double error = batch.states.back().parameters(scale.parameter_offset) -
                       dataset.true_constants.at("odometer_scale");
  const double sigma = std::sqrt(batch.P.Get(0)(scale.offset, scale.offset));
  EXPECT_LT(sigma, 0.3 * 0.01);
  EXPECT_LT(std::abs(error), 4.0 * sigma);
}

/// Rail joints and jolts: every second reading of the speed is taken while the
/// wheel is shaken forward, by up to 0.5 m/s. The count of the distance hardly
/// knows.
TEST(DistanceIncrements, ForgiveJoltsThatASpeedDoesNot) {
  const auto shaken = [](Odometer::Form form) {
    Dataset dataset = Simulate(Drive(form), 7);
    Random random(5);
    double fall = 0.0;
    int i = 0;
    for (Measurement& z : OdometerOf(&dataset).measurements.Edited()) {
      auto& odometer = std::get<Odometer>(z.model);
      odometer.distance -= std::exchange(fall, 0.0);
      if (i++ % 2 == 0 || std::abs(odometer.speed) + odometer.distance < 0.1) {
        continue;
      }
      const double jolt = 0.5 * random.Uniform();
      // 4 ms of it, which a speed is read from and a count integrates; the
      // wheel falls back as far in the next interval.
      odometer.speed += jolt;
      fall = 0.002 * jolt;
      odometer.distance += fall;
    }
    ReconstructionOptions options;
    options.method = "batch";
    return LargestDriveError(dataset, Solve(dataset, options));
  };
  const double speed = shaken(Odometer::Form::kForward);
  const double increments = shaken(Odometer::Form::kIncrements);
  RecordProperty("speed_m", std::to_string(speed));
  RecordProperty("increments_m", std::to_string(increments));
  EXPECT_LT(increments, 0.5);
  EXPECT_GT(speed, 3.0 * increments);
}

/// A slipped increment is rejected, and what follows is as good as before.
TEST(DistanceIncrements, SlipIsGatedAndForgotten) {
  Scenario scenario = Drive(Odometer::Form::kIncrements);
  scenario.aiding[1].sensor.gate_probability = 0.9999;
  const Dataset clean = Simulate(scenario, 9);
  Dataset slipped = clean;
  int slips = 0;
  for (Measurement& z : OdometerOf(&slipped).measurements.Edited()) {
    const bool slips_now =
        (z.t > 75.05 && z.t < 76.05) || (z.t > 110.05 && z.t < 110.25);
    if (!slips_now) continue;
    std::get<Odometer>(z.model).distance += 0.15;  // 1.5 m/s of spinning
    ++slips;
  }
  ASSERT_EQ(slips, 12);
  ReconstructionOptions options;
  for (const std::string method : {"ekf", "rts", "batch"}) {
    options.method = method;
    const Solution without = Solve(clean, options);
    const Solution with = Solve(slipped, options);
    int rejected = 0;
    int false_alarms = 0;
    for (const ResidualRecord& record : with.residuals) {
      if (record.sensor != 1 || record.accepted) continue;
      const bool slip = (record.t > 75.05 && record.t < 76.05) ||
                        (record.t > 110.05 && record.t < 110.25);
      ++(slip ? rejected : false_alarms);
    }
    EXPECT_EQ(rejected, slips) << method;
    EXPECT_LE(false_alarms, 3) << method;
    EXPECT_LT(LargestDriveError(slipped, with),
              1.2 * LargestDriveError(clean, without) + 0.05)
        << method;
  }
}

/// The same gate for the speed of a wheel.
TEST(DistanceIncrements, SlipOfASpeedIsGatedToo) {
  Scenario scenario = Drive(Odometer::Form::kThreeAxis);
  scenario.aiding[1].sensor.gate_probability = 0.9999;
  const Dataset clean = Simulate(scenario, 9);
  Dataset slipped = clean;
  for (Measurement& z : OdometerOf(&slipped).measurements.Edited()) {
    if (z.t > 75.05 && z.t < 76.05) std::get<Odometer>(z.model).speed += 1.5;
  }
  ReconstructionOptions options;
  options.method = "batch";
  const Solution solution = Solve(slipped, options);
  int rejected = 0;
  for (const ResidualRecord& record : solution.residuals) {
    if (record.sensor == 1 && !record.accepted && record.t > 75.05 &&
        record.t < 76.05) {
      ++rejected;
    }
  }
  EXPECT_EQ(rejected, 10);
  EXPECT_LT(LargestDriveError(slipped, solution),
            1.2 * LargestDriveError(clean, Solve(clean, options)) + 0.05);
}

}  // namespace
}  // namespace hindsight
