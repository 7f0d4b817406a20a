#include "problems/sample_solution.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "base/chi_square.h"
#include "base/error.h"
#include "base/units.h"
#include "evaluation/true_states.h"
#include "imu/imu_link.h"
#include "io/config/scenario_config.h"
#include "measurements/sensor_kind.h"
#include "problems/reconstruction.h"
#include "support/seed_count.h"

namespace hindsight {
namespace {

constexpr double kAlpha = 0.02;  // [1/s]

constexpr const char* kForward[] = {"ekf", "gated_ekf", "hinf", "modified_hinf",
                                    "imm"};

/// One minute of the car drive with a fix a second, of which those from 31 s to
/// 40 s are withheld.
Dataset DriveWithOutage() {
  Scenario scenario = FindScenario("car_drive");
  scenario.duration = 60.0;
  scenario.withholdings = {
      {.sensor = "position", .every = 1000.0, .length = 10.0, .from = 30.5}};
  return Simulate(scenario, 1);
}

/// Moves the fixes at and after t by 3 m to the north.
void MoveFixesFrom(double t, Dataset* dataset) {
  for (AidingStream& stream : dataset->streams) {
    for (Measurement& z : stream.measurements.Edited()) {
      auto* fix = std::get_if<PositionFix>(&z.model);
      if (fix == nullptr || z.t < t) continue;
      fix->p_e += NedAxes(fix->p_e) * Eigen::Vector3d(3.0, 0.0, 0.0);
    }
  }
}

ReconstructionOptions SamplingOptions(
    const std::vector<double>& node_times = {}) {
  ReconstructionOptions options;
  options.node_times = node_times;
  options.h_infinity.rule = RiccatiRule::kHInfinity;
  options.h_infinity.gamma = 5.0;
  options.modified_h_infinity.rule = RiccatiRule::kModifiedHInfinity;
  options.modified_h_infinity.alpha = kAlpha;
  return options;
}

std::vector<double> TimesFrom(double from, double to, double step) {
  std::vector<double> times;
  for (double t = from; t < to; t += step) times.push_back(t);
  return times;
}

/// Largest |P_a - P_b| in units of the standard deviations of P_b.
double DifferenceInSigmas(const ErrorMatrix& a, const ErrorMatrix& b) {
  const ErrorVector s = b.diagonal().cwiseSqrt().cwiseInverse();
  return (s.asDiagonal() * (a - b) * s.asDiagonal()).cwiseAbs().maxCoeff();
}

TEST(SampleSolution, AForwardMethodKnowsNothingOfTheNextFix) {
  const Dataset dataset = DriveWithOutage();
  // The outage ends with the fix at 41 s.
  constexpr double kFix = 40.5;
  Dataset moved = dataset;
  MoveFixesFrom(kFix, &moved);
  const std::vector<double> times = TimesFrom(38.03, 43.0, 0.1);
  Reconstruction a(dataset, SamplingOptions());
  Reconstruction b(moved, SamplingOptions());
  for (const std::string method : kForward) {
    const Solution before = a.Sample(a.Run(method), times);
    const Solution after = b.Sample(b.Run(method), times);
    double largest_after_fix = 0.0;
    for (std::size_t i = 0; i < times.size(); ++i) {
      const double d = (before.states[i].p_e - after.states[i].p_e).norm();
      if (times[i] < 40.95) {
        EXPECT_EQ(d, 0.0) << method << " " << times[i];
      } else {
        largest_after_fix = std::max(largest_after_fix, d);
      }
    }
    // The others do not believe a fix that is 3 m off.
    if (method != "gated_ekf" && method != "imm") {
      EXPECT_GT(largest_after_fix, 0.1) << method;
    }
  }
}

TEST(SampleSolution, OfAForwardMethodIsWhatANodeThereWouldHold) {
  const Dataset dataset = DriveWithOutage();
  // Within a fix's second, in the outage and half a second before its end.
  const std::vector<double> times = {20.05, 20.37, 33.91, 36.5, 40.5, 50.77};
  Reconstruction coarse(dataset, SamplingOptions());
  Reconstruction fine(dataset, SamplingOptions(times));
  for (const std::string method : kForward) {
    const Solution sampled = coarse.Sample(coarse.Run(method), times);
    const Solution exact = fine.Sample(fine.Run(method), times);
    for (std::size_t i = 0; i < times.size(); ++i) {
      const ErrorVector d =
          Local(exact.layout, exact.states[i], sampled.states[i]);
      const ErrorMatrix P = exact.covariances.Get(i);
      // Another node changes what came before by the order of alpha and Phi,
      // at most by all that alpha does in a second.
      const double order = method == "modified_hinf" ? 2.0 * kAlpha : 0.0;
      EXPECT_LT(d.cwiseQuotient(P.diagonal().cwiseSqrt()).head<9>().norm(),
                0.01 + order)
          << method << " " << times[i];
      // The bound of kPropagationStep, as variance.
      EXPECT_LT(DifferenceInSigmas(sampled.covariances.Get(i), P), 0.01 + order)
          << method << " " << times[i];
    }
  }
}

TEST(SampleSolution, ConsistsOfTheNodesAtTheNodes) {
  const Dataset dataset = DriveWithOutage();
  Reconstruction reconstruction(dataset, SamplingOptions());
  for (const std::string method : {"ekf", "imm", "rts", "two_filter"}) {
    const Solution solution = reconstruction.Run(method);
    std::vector<double> times;
    for (const State& x : solution.states) {
      // Stamps are rounded in files.
      times.push_back(x.t + 1e-10);
    }
    times.back() = solution.states.back().t;
    const Solution sampled = reconstruction.Sample(solution, times);
    ASSERT_EQ(sampled.states.size(), times.size());
    for (std::size_t k = 0; k < times.size(); ++k) {
      EXPECT_EQ(sampled.states[k].p_e, solution.states[k].p_e) << k;
      EXPECT_EQ(sampled.covariances.Get(k), solution.covariances.Get(k)) << k;
    }
  }
}

TEST(SampleSolution, OneWalkEqualsAnIntegrationForEachTime) {
  const Dataset dataset = DriveWithOutage();
  Reconstruction reconstruction(dataset, SamplingOptions());
  const Solution solution = reconstruction.Run("rts");
  const std::vector<double> times = TimesFrom(solution.states.front().t + 0.003,
                                              solution.states.back().t, 0.0101);
  const Solution sampled = reconstruction.Sample(solution, times);
  ImuIntegrator integrator(dataset.imu);
  const auto advance = [&](const State& from, double t) {
    return Predict(
        solution.layout, from,
        integrator.Summarize(from.t, t, CalibrationOf(solution.layout, from)));
  };
  std::size_t k = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    while (solution.states[k + 1].t <= times[i]) ++k;
    const State& begin = solution.states[k];
    const State& end = solution.states[k + 1];
    const ErrorVector jump = Local(solution.layout, advance(begin, end.t), end);
    const double part = (times[i] - begin.t) / (end.t - begin.t);
    const State expected =
        Retract(solution.layout, advance(begin, times[i]), part * jump);
    const ErrorVector d = Local(solution.layout, expected, sampled.states[i]);
    EXPECT_LT(d.head<3>().norm(), 1e-6) << times[i];
    EXPECT_LT(d.segment<6>(3).norm(), 1e-6) << times[i];
  }
}

TEST(SampleSolution, OfASmootherIsCloseToNodesAtEveryTime) {
  const Dataset dataset = DriveWithOutage();
  const std::vector<double> times = TimesFrom(12.05, 55.0, 0.1);
  Reconstruction coarse(dataset, SamplingOptions());
  Reconstruction fine(dataset, SamplingOptions(times));
  const Solution sampled = coarse.Sample(coarse.Run("rts"), times);
  const Solution exact = fine.Sample(fine.Run("rts"), times);
  // White noise q of the accelerometer leaves a jump (dp, dv) over T = 1 s. The
  // mean in between is a cubic; the straight line is off by up to 0.43 q T^1/2
  // in velocity and 0.15 q T^3/2 in position, one sigma; a tenth more comes
  // from the gyros' noise. Their own jump is spread linearly by the mean, too.
  constexpr double kSigmas = 5.0 * 1.1;
  const double q = dataset.imu.noise.accel_noise_density;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const ErrorVector d =
        Local(exact.layout, exact.states[i], sampled.states[i]);
    EXPECT_LT(d.head<3>().cwiseAbs().maxCoeff(), kSigmas * 0.15 * q)
        << times[i];
    EXPECT_LT(d.segment<3>(3).cwiseAbs().maxCoeff(), kSigmas * 0.43 * q)
        << times[i];
    EXPECT_LT(d.segment<3>(6).cwiseAbs().maxCoeff(), 1e-6) << times[i];
  }
}

/// To and fro once between two fixes, north, then east: with an open heading
/// the velocity is known at the fixes, and not in between.
Scenario HandOfUnknownHeading() {
  Scenario s;
  s.name = "hand";
  for (int i = 0; i <= 1000; ++i) {
    ProfilePoint point;
    point.t = 0.02 * i;
    point.position = {0.8, 0.2, 100.0};
    const double v = std::sin(2.0 * kPi * point.t);
    (point.t < 10.0 ? point.v_n.x() : point.v_n.y()) = v;
    s.profile.push_back(point);
  }
  s.imu_rate_hz = 100.0;
  s.truth_rate_hz = 100.0;
  s.imu.noise.gyro_noise_density = 1e-5;
  s.imu.noise.accel_noise_density = 1e-3;
  AidingModel gnss(PositionKind());
  gnss.sensor.name = "gnss";
  gnss.rate_hz = 1.0;
  gnss.sigma.emplace().setConstant(0.02);
  s.aiding = {gnss};
  StartErrors errors;
  errors.attitude = Eigen::Vector3d(0.1, 0.1, 12.0) * kDegree;
  s.start_errors = errors;
  return s;
}

/// Mean of the squared errors of the horizontal velocity over their variances,
/// a tenth of a second after each node and so on.
TEST(SampleSolution, OfASmootherClaimsNoMoreBetweenNodesThanItKnows) {
  constexpr int kSeeds = testing::SeedCount(20);
  const std::vector<double> times = TimesFrom(3.1, 18.0, 0.2);
  double sum = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Dataset dataset = Simulate(HandOfUnknownHeading(),
                                     static_cast<std::uint64_t>(500 + seed));
    Reconstruction reconstruction(dataset, SamplingOptions());
    const Solution sampled =
        reconstruction.Sample(reconstruction.Run("iterated"), times);
    const std::vector<State> truth =
        TrueStates(dataset, sampled.layout, sampled.states);
    for (std::size_t i = 0; i < times.size(); ++i) {
      const ErrorVector e = Local(sampled.layout, sampled.states[i], truth[i]);
      const ErrorVector P = sampled.covariances.Get(i).diagonal();
      for (int axis = 3; axis < 5; ++axis) sum += e(axis) * e(axis) / P(axis);
    }
  }
  const double mean = sum / (2.0 * kSeeds * static_cast<double>(times.size()));
  // One heading a seed makes most of them.
  const Interval bounds = AneesBounds(kSeeds, 1, 0.999);
  EXPECT_LT(mean, bounds.upper);
  EXPECT_GT(mean, 0.2);
}

TEST(SampleSolution, HasPositiveDefiniteCovariancesEverywhere) {
  const Dataset dataset = DriveWithOutage();
  Reconstruction reconstruction(dataset, SamplingOptions());
  const Solution sampled = reconstruction.Sample(reconstruction.Run("ekf"),
                                                 TimesFrom(5.0, 59.0, 0.017));
  for (std::size_t i = 0; i < sampled.states.size(); ++i) {
    const Eigen::LLT<ErrorMatrix> llt(sampled.covariances.Get(i));
    EXPECT_EQ(llt.info(), Eigen::Success) << sampled.states[i].t;
  }
}

/// The distance that an odometer has counted, from count to count. Its rate is
/// low, so that nodes stand between them.
TEST(SampleSolution, TravelledDistancesGrowBetweenTheNodes) {
  Scenario scenario = FindScenario("short_drive");
  scenario.duration = 40.0;
  scenario.aiding.resize(1);
  AidingModel odometer(OdometerKind());
  odometer.sensor.name = "odometer";
  PatternOf<Odometer>(odometer).form = Odometer::Form::kIncrements;
  odometer.rate_hz = 1.0;
  odometer.sigma = Eigen::Vector3d(0.002, 1.0, 1.0);
  scenario.aiding.push_back(odometer);
  const Dataset dataset = Simulate(scenario, 1);
  const std::vector<double> times = TimesFrom(25.013, 35.0, 0.21);
  Reconstruction coarse(dataset, SamplingOptions());
  Reconstruction fine(dataset, SamplingOptions(times));
  const Solution sampled = coarse.Sample(coarse.Run("ekf"), times);
  const Solution exact = fine.Sample(fine.Run("ekf"), times);
  const Block& block = *exact.layout.Find(BlockKind::kDistance, 1);
  double largest = 0.0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double distance = exact.states[i].parameters(block.parameter_offset);
    largest = std::max(largest, std::abs(distance));
    EXPECT_NEAR(sampled.states[i].parameters(block.parameter_offset), distance,
                1e-3)
        << times[i];
    // Within a step of a count, one a second, what it forgets goes linearly.
    if (times[i] - std::floor(times[i]) < kPropagationStep) continue;
    const double sigma =
        std::sqrt(exact.covariances.Get(i)(block.offset, block.offset));
    EXPECT_NEAR(
        std::sqrt(sampled.covariances.Get(i)(block.offset, block.offset)),
        sigma, 0.05 * sigma + 1e-4)
        << times[i];
  }
  EXPECT_GT(largest, 1.0);
}

}  // namespace
}  // namespace hindsight
