#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/chi_square.h"
#include "base/random.h"
#include "base/units.h"
#include "measurements/sensor_kind.h"
#include "problems/forward_stage.h"
#include "problems/noise_estimation.h"
#include "problems/reconstruction.h"
#include "simulation/scenario.h"
#include "support/seed_count.h"

namespace hindsight {
namespace {

constexpr double kDuration = 30.0;
constexpr double kPriorSigma = 0.3;  // of the time offset [s]
constexpr char kOffset[] = "gnss_time_offset";

/// A hand that shakes and turns an IMU about a spot: three sinusoids an axis of
/// 0.15 to 1.2 Hz times `tempo`, speeds of some 0.5 m/s and turns of some 20
/// deg.
std::vector<ProfilePoint> ShakenHand(double tempo = 1.0) {
  constexpr double kStep = 0.02;
  struct Wave {
    double rate, phase, speed, angle;
  };
  Random random(5);
  std::vector<Wave> waves[3];
  for (auto& axis : waves) {
    for (const double frequency : {0.15, 0.45, 1.0}) {
      axis.push_back(
          {2.0 * kPi * tempo * frequency * (1.0 + 0.2 * random.Uniform()),
           2.0 * kPi * random.Uniform(), 0.4, 0.12});
    }
  }
  std::vector<ProfilePoint> points;
  for (int k = 0; k * kStep <= kDuration + 0.5 * kStep; ++k) {
    ProfilePoint p;
    p.t = k * kStep;
    p.position = {37.0 * kDegree, 127.0 * kDegree, 50.0};
    for (int axis = 0; axis < 3; ++axis) {
      for (const Wave& w : waves[axis]) {
        p.v_n(axis) += w.speed * std::sin(w.rate * p.t + w.phase);
        p.euler(axis) += w.angle * std::cos(w.rate * p.t + 2.0 * w.phase);
      }
    }
    points.push_back(p);
  }
  return points;
}

Scenario ShakenScenario() {
  Scenario s;
  s.name = "shaken";
  s.profile = ShakenHand();
  s.imu_rate_hz = 100.0;
  s.imu.noise.gyro_noise_density = 1.5e-3;
  s.imu.noise.accel_noise_density = 0.12;
  AidingModel gnss(PositionKind());
  gnss.sensor.name = "gnss";
  gnss.sensor.time_offset_sigma = kPriorSigma;
  gnss.rate_hz = 20.0;
  gnss.sigma.emplace().setConstant(0.003);
  s.aiding = {gnss};
  StartErrors errors;
  errors.position.setConstant(0.01);
  errors.velocity.setConstant(0.1);
  errors.attitude.setConstant(2.0 * kDegree);
  s.start_errors = errors;
  return s;
}

/// Seed `seed` with positions that are told `delay` too early; the data set
/// believes in `start`.
Dataset Delayed(const PerfectRecording& recording, std::uint64_t seed,
                double delay, double start = 0.0) {
  Dataset dataset = recording.Realize(seed);
  AidingStream& gnss = dataset.streams.front();
  for (Measurement& z : gnss.measurements.Edited()) z.t -= delay;
  gnss.sensor.time_offset = start;
  return dataset;
}

double DelayOf(std::uint64_t seed) {
  return -0.3 + 0.6 * Random(seed, 77).Uniform();
}

const ConstantEstimate& Offset(const Solution& solution) {
  return *std::find_if(
      solution.constants.begin(), solution.constants.end(),
      [](const ConstantEstimate& c) { return c.name == kOffset; });
}

/// Leaves no fix that comes or goes with the offset: one more at an end of the
/// interval is one more piece of information, of some 0.1 sigma here, and with
/// and without it the offset may settle on either side.
void KeepInside(Dataset* dataset) {
  dataset->streams.front().measurements.EraseIf(
      [](const Measurement& z) { return z.t < 1.0 || z.t > kDuration - 1.0; });
}

constexpr const char* kSmoothers[] = {"rts", "two_filter", "iterated", "batch",
                                      "imm_smoother"};

/// Errors over their sigmas, as a normal deviate has them, and the same from
/// another start: a noisy IMU must not push the offset away from where the
/// nodes stood first.
TEST(TimeOffset, ErrorsAreWhatTheSigmaSaysFromAnyStart) {
#ifdef NDEBUG
  const int seeds = testing::SeedCount(8, 200);
#else
  const int seeds = testing::SeedCount(2, 200);
#endif
  const PerfectRecording recording(ShakenScenario());
  std::map<std::string, double> sum;
  std::map<std::string, int> beyond;
  for (int i = 0; i < seeds; ++i) {
    const std::uint64_t seed = 77000 + static_cast<std::uint64_t>(i);
    const double delay = DelayOf(seed);
    Dataset dataset = Delayed(recording, seed, delay);
    KeepInside(&dataset);
    Reconstruction from_zero(dataset, {});
    Dataset other = Delayed(recording, seed, delay, 0.5 * delay);
    KeepInside(&other);
    Reconstruction from_near(other, {});
    for (const std::string method : kSmoothers) {
      const Solution solution = from_zero.Run(method);
      EXPECT_TRUE(solution.usable()) << seed << " " << solution.verdict;
      const ConstantEstimate& offset = Offset(solution);
      const double error = (offset.value - delay) / offset.sigma;
      sum[method] += error * error;
      beyond[method] += std::abs(error) > 3.0 ? 1 : 0;
      if (method != "rts" && method != "batch") continue;
      EXPECT_NEAR(Offset(from_near.Run(method)).value, offset.value,
                  0.1 * offset.sigma)
          << seed << " " << solution.method << " delay " << delay;
    }
  }
  const Interval bounds = AneesBounds(seeds, 1, 0.99);
  for (const std::string method : kSmoothers) {
    EXPECT_TRUE(bounds.Contains(sum[method] / seeds))
        << method << ": " << sum[method] / seeds << " against " << bounds.lower
        << " to " << bounds.upper;
    // Three of two hundred: beyond three sigmas are 0.27 %.
    EXPECT_LE(beyond[method], seeds < 100 ? 1 : 3) << method;
    RecordProperty(std::string(method) + "_mean_square",
                   std::to_string(sum[method] / seeds));
    RecordProperty(std::string(method) + "_beyond_3_sigmas", beyond[method]);
  }
}

/// Nothing is known of the attitude, and half a swing is shorter than the
/// windows of the search: begun where the offset is believed, the estimate
/// would stay half a swing off and turned round.
TEST(TimeOffset, OfFastMotionIsNotHalfASwingOff) {
  Scenario scenario = ShakenScenario();
  scenario.profile = ShakenHand(2.0);
  scenario.start_errors.reset();
  const PerfectRecording recording(scenario);
  const int seeds = testing::SeedCount(6, 60);
  for (int i = 0; i < seeds; ++i) {
    const std::uint64_t seed = 78000 + static_cast<std::uint64_t>(i);
    const double delay = DelayOf(seed);
    const Solution solution = Solve(Delayed(recording, seed, delay), {});
    const ConstantEstimate& offset = Offset(solution);
    EXPECT_LT(std::abs(offset.value - delay), 4.0 * offset.sigma)
        << seed << " delay " << delay << ": " << offset.value << ", "
        << solution.verdict;
  }
}

/// ln of the likelihood of the positions with nodes placed by a given offset.
double FixedOffsetLikelihood(const Dataset& dataset, double offset) {
  Dataset fixed = dataset;
  Sensor& sensor = fixed.streams.front().sensor;
  sensor.time_offset = offset;
  sensor.time_offset_sigma.reset();
  ReconstructionOptions options;
  options.method = "ekf";
  // The same interval whatever the offset.
  ForwardStage stage(fixed, options);
  Problem causal = stage.CausalProblem();
  const LinearTape tape = stage.Filter("", &causal);
  double sum = 0.0;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.measurements(k)) {
      sum += z.log_likelihood;
    }
  }
  return sum;
}

TEST(TimeOffset, AgreesWithTheLikelihoodOverFixedOffsets) {
  const PerfectRecording recording(ShakenScenario());
  for (const std::uint64_t seed : {2001u, 2002u}) {
    Dataset dataset = Delayed(recording, seed, DelayOf(seed));
    KeepInside(&dataset);
    const Solution batch = Solve(dataset, {});
    const ConstantEstimate& offset = Offset(batch);
    // A parabola through five points, two sigmas either way.
    double with_square = 0.0;
    double with_slope = 0.0;
    for (const int i : {-2, -1, 0, 1, 2}) {
      const double L =
          FixedOffsetLikelihood(dataset, offset.value + i * offset.sigma);
      with_slope += i * L / 10.0;
      with_square += (i * i - 2.0) * L / 14.0;
    }
    const double peak = -0.5 * with_slope / with_square;  // in sigmas
    const double sigma = 1.0 / std::sqrt(-2.0 * with_square);
    EXPECT_NEAR(peak, 0.0, 0.1) << seed;
    EXPECT_NEAR(sigma, 1.0, 0.1) << seed;
  }
}

/// Velocities, whose rate is an acceleration: what a noisy accelerometer reads
/// at the instant tells nothing of the clock.
TEST(TimeOffset, OfVelocitiesIsAsGoodAsItsSigma) {
  const int seeds = testing::SeedCount(6, 100);
  Scenario scenario = ShakenScenario();
  AidingModel& gnss = scenario.aiding.front();
  gnss.sensor.kind = &VelocityKind();
  gnss.sensor.lever_arm_b = {0.3, -0.2, 0.1};
  gnss.rate_hz = 5.0;
  gnss.sigma.emplace().setConstant(0.05);
  const PerfectRecording recording(scenario);
  double sum = 0.0;
  for (int i = 0; i < seeds; ++i) {
    const std::uint64_t seed = 78000 + static_cast<std::uint64_t>(i);
    const double delay = 0.5 * DelayOf(seed);
    const Solution batch = Solve(Delayed(recording, seed, delay), {});
    const ConstantEstimate& offset = Offset(batch);
    EXPECT_EQ(batch.verdict.find("does not settle"), std::string::npos);
    sum += std::pow((offset.value - delay) / offset.sigma, 2);
  }
  const Interval bounds = AneesBounds(seeds, 1, 0.99);
  EXPECT_TRUE(bounds.Contains(sum / seeds))
      << sum / seeds << " against " << bounds.lower << " to " << bounds.upper;
}

/// The densities that the data have, from a stated one a tenth of that: a delay
/// is no reason to take the IMU for noisier than it is.
TEST(TimeOffset, NoiseIsEstimatedWithIt) {
  constexpr double kStatedTooSmall = 10.0;
  const PerfectRecording recording(ShakenScenario());
  Dataset dataset = Delayed(recording, 4001, 0.15);
  dataset.imu.noise.accel_noise_density /= kStatedTooSmall;
  const NoiseEstimate estimate = EstimateNoise(dataset);
  EXPECT_TRUE(estimate.converged);
  constexpr double kFourSigma = 4.0;
  for (const NoiseFactor& noise : estimate.factors) {
    const double truth = noise.name == "imu.accel" ? kStatedTooSmall : 1.0;
    EXPECT_LT(std::abs(std::log(noise.factor / truth)) / noise.log_sigma,
              kFourSigma)
        << noise.name << " " << noise.factor << " +- " << noise.log_sigma;
  }
}

/// What a filter that fails on other nodes leaves behind is not of these nodes.
TEST(TimeOffset, AMethodAfterAFilterThatFailedBeginsAnew) {
  const PerfectRecording recording(ShakenScenario());
  const Dataset dataset = Delayed(recording, 77000, 0.25);
  int passes = 0;
  int fails_at = 4;
  ReconstructionOptions options;
  options.progress = [&](const std::string& stage, double fraction) {
    if (stage == "ekf" && fraction == 1.0) ++passes;
    if (stage == "ekf" && passes == fails_at) {
      throw EstimationError("diverged");
    }
  };
  Reconstruction reconstruction(dataset, options);
  EXPECT_THROW(reconstruction.Run("rts"), EstimationError);
  ASSERT_EQ(passes, 4);
  fails_at = 0;
  const Solution solution = reconstruction.Run("rts");
  const Solution fresh = Reconstruction(dataset, {}).Run("rts");
  ASSERT_EQ(solution.states.size(), fresh.states.size());
  EXPECT_EQ(solution.states.back().p_e, fresh.states.back().p_e);
  EXPECT_EQ(solution.grade, fresh.grade) << solution.verdict;
}

}  // namespace
}  // namespace hindsight
