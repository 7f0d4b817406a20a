#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/random.h"
#include "base/units.h"
#include "dataset/timeline_builder.h"
#include "evaluation/true_states.h"
#include "io/config/scenario_config.h"
#include "measurements/noise_kind.h"
#include "problems/accuracy.h"
#include "problems/reconstruction.h"
#include "simulation/scenario.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;

using testing::Accuracy;
using testing::Judge;
using testing::SolveBy;

/// Every twentieth fix, on average, is put 20 m off in a random direction.
int AddOutliers(Dataset* dataset) {
  Random random(77);
  int count = 0;
  for (AidingStream& stream : dataset->streams) {
    for (Measurement& z : stream.measurements.Edited()) {
      auto* fix = std::get_if<PositionFix>(&z.model);
      if (fix == nullptr || random.Uniform() >= 0.05) continue;
      const double azimuth = 2.0 * kPi * random.Uniform();
      fix->p_e +=
          NedAxes(fix->p_e) * Eigen::Vector3d(20.0 * std::cos(azimuth),
                                              20.0 * std::sin(azimuth), 0.0);
      ++count;
    }
  }
  return count;
}

class RobustLossTest : public ::testing::TestWithParam<RobustLoss> {};

TEST_P(RobustLossTest, OutliersOfTwentyMetresCostLittleAndSigmasStayHonest) {
  const Dataset clean = Simulate(FindScenario("car_drive"), 3);
  ReconstructionOptions options;
  options.method = "batch";
  const Accuracy without = Judge(clean, Solve(clean, options));

  Dataset dirty = clean;
  ASSERT_GT(AddOutliers(&dirty), 60);
  const Accuracy spoilt = Judge(dirty, Solve(dirty, options));
  EXPECT_GT(spoilt.horizontal_rms, 3.0 * without.horizontal_rms);

  for (AidingStream& stream : dirty.streams) {
    stream.sensor.loss = GetParam();
  }
  const Solution solution = Solve(dirty, options);
  const Accuracy robust = Judge(dirty, solution);
  EXPECT_TRUE(solution.usable()) << solution.verdict;
  EXPECT_LT(robust.horizontal_rms, 1.2 * without.horizontal_rms);
  // Three degrees of freedom; one seed, whose epochs are correlated, scatters
  // more than a mean over many would.
  EXPECT_GT(robust.position_nees, 2.3);
  EXPECT_LT(robust.position_nees, 3.7);
  int listed = 0;
  for (const ResidualRecord& record : solution.residuals) {
    if (record.weight < 0.1) ++listed;
  }
  EXPECT_GT(listed, 60);
}

// Losses that redescend quickly need a wide scale: with three rows an honest
// residual is beyond two sigmas as often as not.
INSTANTIATE_TEST_SUITE_P(
    Losses, RobustLossTest,
    ::testing::Values(RobustLoss{RobustLoss::Kind::kHuber, 3.0},
                      RobustLoss{RobustLoss::Kind::kCauchy, 3.0},
                      RobustLoss{RobustLoss::Kind::kTukey, 7.0},
                      RobustLoss{RobustLoss::Kind::kGemanMcClure, 6.0}),
    [](const auto& info) {
      return "Kind" + std::to_string(static_cast<int>(info.param.kind));
    });

/// A drone whose receiver jumps by 60 m, comes back in a straight line within 20 s,
/// and says so in its velocities.
Dataset DroneWithAGlitch(Dataset dataset) {
  constexpr double kBegin = 40.0;
  constexpr double kEnd = 60.0;
  constexpr double kJump = 60.0;
  const auto north = [](double t) {
    return kJump * (kEnd - t) / (kEnd - kBegin);
  };
  for (AidingStream& stream : dataset.streams) {
    for (Measurement& z : stream.measurements.Edited()) {
      if (z.t < kBegin || z.t >= kEnd) continue;
      if (auto* fix = std::get_if<PositionFix>(&z.model)) {
        fix->p_e += NedAxes(fix->p_e).col(0) * north(z.t);
      } else if (auto* velocity = std::get_if<VelocityFix>(&z.model)) {
        velocity->v_n.x() -= kJump / (kEnd - kBegin);
      }
    }
  }
  return dataset;
}

/// A drone whose compass is next to a current for 40 s.
Dataset DroneBesideACurrent(Dataset dataset) {
  const Eigen::Vector3d current_b(20.0, -15.0, 5.0);  // [uT]
  for (AidingStream& stream : dataset.streams) {
    for (Measurement& z : stream.measurements.Edited()) {
      if (z.t < 30.0 || z.t >= 70.0) continue;
      auto* field = std::get_if<MagneticField>(&z.model);
      if (field != nullptr) field->field_b += current_b;
    }
  }
  return dataset;
}

/// Largest error of the heading at the nodes [rad].
double LargestHeadingError(const Dataset& dataset, const Solution& solution) {
  double largest = 0.0;
  for (const State& x : solution.states) {
    const auto at =
        std::ranges::find_if(dataset.truth, [&x](const TruthPoint& point) {
          return std::abs(point.t - x.t) < 1e-6;
        });
    if (at == dataset.truth.end()) continue;
    const Eigen::Quaterniond q_nb(x.C_en().transpose() *
                                  x.q_eb.toRotationMatrix());
    largest = std::max(largest, q_nb.angularDistance(*at->q_nb));
  }
  return largest;
}

TEST(RobustBatch, FindsPositionsAndVelocitiesThatErrTogether) {
  const Dataset clean = Simulate(FindScenario("test_drone"), 3);
  const Accuracy without = Judge(clean, SolveBy("batch", clean));
  const Dataset dirty = DroneWithAGlitch(clean);
  EXPECT_GT(Judge(dirty, SolveBy("batch", dirty)).horizontal_rms,
            20.0 * without.horizontal_rms);
  const Accuracy robust = Judge(dirty, SolveBy("robust_batch", dirty));
  EXPECT_LT(robust.horizontal_rms, 1.5 * without.horizontal_rms);
  EXPECT_LT(robust.position_nees, 1.5 * without.position_nees);
}

/// The second in which the IMU's velocity steps by 5 m/s leaves it open when.
void ExpectTheStepBetweenNodes(const Dataset& dataset,
                               const Reconstruction& reconstruction,
                               const Solution& solution) {
  std::vector<double> times;
  for (int i = 1; i < 10; ++i) times.push_back(50.0 + 0.1 * i);
  const Solution sampled = reconstruction.Sample(solution, times);
  const std::vector<State> truth =
      TrueStates(dataset, sampled.layout, sampled.states);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const ErrorVector e = Local(sampled.layout, sampled.states[i], truth[i]);
    const ErrorMatrix P = sampled.covariances.Get(i);
    for (int row = 0; row < 6; ++row) {
      EXPECT_LT(std::abs(e(row)), 4.0 * std::sqrt(P(row, row)))
          << times[i] << " " << row;
    }
    EXPECT_LT(std::sqrt(P(0, 0)), 1.0) << times[i];
    EXPECT_LT(std::sqrt(P(3, 3)), 3.0) << times[i];
  }
}

/// Velocity that the IMU measures too much at a time, in its axes [m/s].
void StepVelocity(double t, const Eigen::Vector3d& dv, Dataset* dataset) {
  PagedVector<ImuSample>& samples = dataset->imu.samples;
  const std::size_t at = static_cast<std::size_t>(
      std::ranges::upper_bound(samples, t, {}, &ImuSample::t) -
      samples.begin());
  const double dt = dataset->imu.kind == ImuStream::Kind::kIncrements
                        ? 1.0
                        : samples[at].t - samples[at - 1].t;
  samples[at].accel += dv / dt;
}

/// As where samples are lost, or beyond the range: what all others contradict is the
/// IMU's, and within that interval the batch does not believe it.
TEST(RobustBatch, FindsAnImuWhoseVelocitySteps) {
  constexpr double kStep = 50.38;
  for (const char* scenario : {"test_drone", "short_drive"}) {
    const Dataset clean = Simulate(
        FindScenario(scenario, {"truth_rate=10 Hz", "duration=80 s"}), 11);
    const Accuracy without = Judge(clean, SolveBy("batch", clean));
    Dataset dirty = clean;
    StepVelocity(kStep, {-3.0, 4.0, 0.0}, &dirty);
    EXPECT_GT(Judge(dirty, SolveBy("batch", dirty)).horizontal_rms,
              2.0 * without.horizontal_rms);
    ReconstructionOptions options;
    options.method = "robust_batch";
    Reconstruction reconstruction(dirty, options);
    const Solution solution = reconstruction.Run(options.method);
    const Accuracy robust = Judge(dirty, solution);
    EXPECT_LT(robust.horizontal_rms, 1.2 * without.horizontal_rms) << scenario;
    EXPECT_LT(robust.position_nees, 5.0) << scenario;
    // Receivers that drift alike from there on look the same.
    EXPECT_FALSE(solution.usable()) << scenario;
    ExpectTheStepBetweenNodes(dirty, reconstruction, solution);
  }
}

/// To heights a lone receiver that drifts to the end is an IMU whose velocity steps: that
/// it is the receiver only its own search tells.
TEST(RobustBatch, TakesADriftForNoStepOfTheImu) {
  const Dataset clean = Simulate(
      FindScenario("gps_jumps", {"errors=none", "duration=90 s"}), 2101);
  Dataset dirty = clean;
  for (AidingStream& stream : dirty.streams) {
    stream.measurements.EraseIf([](const Measurement& z) {
      return std::holds_alternative<PositionFix>(z.model) && z.t > 30.0 &&
             z.t < 36.4;
    });
    for (Measurement& z : stream.measurements.Edited()) {
      auto* fix = std::get_if<PositionFix>(&z.model);
      if (fix == nullptr || z.t < 36.4) continue;
      fix->p_e +=
          NedAxes(fix->p_e) * ((z.t - 35.4) * Eigen::Vector3d(3.6, 3.6, 0.0));
    }
  }
  EXPECT_GT(Judge(dirty, SolveBy("batch", dirty)).horizontal_rms, 100.0);
  const Solution solution = SolveBy("robust_batch", dirty);
  const Accuracy robust = Judge(dirty, solution);
  EXPECT_LT(robust.horizontal_rms, 10.0);
  EXPECT_LT(robust.position_nees, 10.0);
  EXPECT_FALSE(solution.usable());
}

/// With the same error at a time, NED [m], in what all receivers measure.
Dataset ErringAlike(Dataset dataset,
                    const std::function<Eigen::Vector3d(double t)>& error) {
  for (AidingStream& stream : dataset.streams) {
    for (Measurement& z : stream.measurements.Edited()) {
      auto* fix = std::get_if<PositionFix>(&z.model);
      if (fix != nullptr) fix->p_e += NedAxes(fix->p_e) * error(z.t);
    }
  }
  return dataset;
}

Dataset TwoReceivers(unsigned seed) {
  return Simulate(FindScenario("two_receivers", {"duration=90 s"}), seed);
}

Eigen::Vector3d NorthEast(double size) { return {size, size, 0.0}; }

/// Two receivers that jump alike: to each, the other taken at its word, it is the IMU that
/// steps forth, and back a second later.
TEST(RobustBatch, FindsAJumpThatTwoReceiversHaveInCommon) {
  const Dataset clean = TwoReceivers(2101);
  const Dataset dirty = ErringAlike(clean, [](double t) {
    return NorthEast(t < 62.4 || t > 77.4 ? 0.0 : 10.0);
  });
  const Accuracy without = Judge(clean, SolveBy("batch", clean));
  EXPECT_GT(Judge(dirty, SolveBy("batch", dirty)).horizontal_rms,
            10.0 * without.horizontal_rms);
  const Accuracy robust = Judge(dirty, SolveBy("robust_batch", dirty));
  EXPECT_LT(robust.horizontal_rms, 1.5 * without.horizontal_rms);
  EXPECT_LT(robust.position_nees, 6.0);
}

/// A step of the IMU that is told as two, one second after the other, in one direction: a
/// jump is taken back by the second.
TEST(RobustBatch, FindsAStepOfTheImuThatIsToldAsTwo) {
  Dataset dirty = TwoReceivers(2105);
  StepVelocity(44.51, {7.8, 3.1, 0.0}, &dirty);
  EXPECT_GT(Judge(dirty, SolveBy("batch", dirty)).horizontal_rms, 3.0);
  const Solution solution = SolveBy("robust_batch", dirty);
  EXPECT_THAT(solution.verdict, HasSubstr("44.0 to 45.0 s, 45.0 to 46.0 s"));
  EXPECT_LT(Judge(dirty, solution).horizontal_rms, 0.5);
  EXPECT_LT(Judge(dirty, solution).position_nees, 8.0);
  EXPECT_EQ(solution.grade, Grade::kDoubtful);
}

/// No sensor tells steps of the IMU's velocity here: the innovations of both do. Which side
/// of the step is right nothing says.
TEST(RobustBatch, FindsAStepToTheEndThatTwoReceiversHaveInCommon) {
  const Dataset clean = TwoReceivers(2103);
  const Dataset dirty = ErringAlike(
      clean, [](double t) { return NorthEast(t < 50.0 ? 0.0 : 3.0); });
  EXPECT_GT(Judge(dirty, SolveBy("batch", dirty)).horizontal_rms, 2.0);
  const Solution solution = SolveBy("robust_batch", dirty);
  EXPECT_LT(Judge(dirty, solution).horizontal_rms, 0.5);
  EXPECT_LT(Judge(dirty, solution).position_nees, 6.0);
  EXPECT_EQ(solution.grade, Grade::kDoubtful);
}

/// From there on either the receivers err or the IMU has stepped.
TEST(RobustBatch, DoubtsTwoReceiversThatDriftAlikeToTheEnd) {
  const Dataset dirty = ErringAlike(TwoReceivers(2102), [](double t) {
    return NorthEast(2.0 * std::max(0.0, t - 60.0));
  });
  EXPECT_FALSE(SolveBy("robust_batch", dirty).usable());
}

/// The last fix of either is right, and is taken for an outlier.
TEST(RobustBatch, DoubtsTwoReceiversWhoseDriftEndsWithTheirLastFixes) {
  const Dataset dirty = ErringAlike(TwoReceivers(2104), [](double t) {
    return NorthEast(t > 89.5 ? 0.0 : 0.13 * std::max(0.0, t - 40.0));
  });
  const Solution solution = SolveBy("robust_batch", dirty);
  EXPECT_GT(Judge(dirty, solution).position_nees, 30.0);
  EXPECT_EQ(solution.grade, Grade::kDoubtful);
  EXPECT_THAT(solution.verdict, HasSubstr("the last fix of left, at 90.0 s"));
}

/// A drone with positions alone, of a receiver that errs slowly, by 0.2 m, and scatters by
/// a hundredth of that, as those that smooth do.
Dataset DroneWithASlowReceiver(std::uint64_t seed) {
  constexpr double kSigma = 0.2;  // [m]
  constexpr double kTau = 20.0;   // [s]
  Dataset dataset = Simulate(
      FindScenario("test_drone", {"duration=60 s", "aiding.gnss.rate=10 Hz",
                                  "aiding.gnss.sigma=0.002 m"}),
      seed);
  std::erase_if(dataset.streams, [](const AidingStream& stream) {
    return !stream.sensor.kind->is_position;
  });
  Random random(seed);
  Eigen::Vector3d e = kSigma * random.NormalVector3();
  double before = 0.0;
  for (AidingStream& stream : dataset.streams) {
    for (Measurement& z : stream.measurements.Edited()) {
      auto* fix = std::get_if<PositionFix>(&z.model);
      if (fix == nullptr) continue;
      const double kept = std::exp(-(z.t - before) / kTau);
      e = kept * e +
          kSigma * std::sqrt(1.0 - kept * kept) * random.NormalVector3();
      before = z.t;
      fix->p_e += NedAxes(fix->p_e) * e;
      fix->R_n = kSigma * kSigma * Eigen::Matrix3d::Identity();
    }
  }
  return dataset;
}

/// On averages they scatter by what is stated.
TEST(RobustBatch, TakesFixesThatScatterByLessThanATenthOfTheirSigma) {
  const Dataset clean = DroneWithASlowReceiver(2107);
  Dataset dirty = clean;
  for (AidingStream& stream : dirty.streams) {
    for (Measurement& z : stream.measurements.Edited()) {
      auto* fix = std::get_if<PositionFix>(&z.model);
      if (fix == nullptr || z.t < 20.0 || z.t >= 28.0) continue;
      fix->p_e += NedAxes(fix->p_e) * Eigen::Vector3d(4.0, 4.0, 0.0);
    }
  }
  const double without = Judge(clean, SolveBy("batch", clean)).horizontal_rms;
  EXPECT_GT(Judge(dirty, SolveBy("batch", dirty)).horizontal_rms,
            3.0 * without);
  const Solution solution = SolveBy("robust_batch", dirty);
  EXPECT_LT(Judge(dirty, solution).horizontal_rms, 1.1 * without);
  EXPECT_TRUE(std::ranges::any_of(solution.notes, [](const std::string& one) {
    return one.starts_with("gnss: biased from 20 to 28 s by 5.");
  }));
  // Whose scatter is at the bound of the search.
  EXPECT_EQ(solution.grade, Grade::kDoubtful);
}

/// Positions whose errors, stated as Gauss-Markov, are 20 m more for 15 s.
TEST(RobustBatch, FindsAJumpBeyondAGaussMarkovError) {
  Dataset clean = Simulate(FindScenario("test_drone"), 4);
  for (AidingStream& stream : clean.streams) {
    if (!stream.sensor.kind->is_position) continue;
    NoiseModel& noise = stream.sensor.noise;
    noise.kind = &GaussMarkovNoise();
    noise.sigma = 1.0;
    noise.tau = 60.0;
    noise.white_sigma = 0.5;
  }
  Dataset dirty = clean;
  for (AidingStream& stream : dirty.streams) {
    for (Measurement& z : stream.measurements.Edited()) {
      auto* fix = std::get_if<PositionFix>(&z.model);
      if (fix == nullptr || z.t < 45.0 || z.t >= 60.0) continue;
      fix->p_e += NedAxes(fix->p_e).col(1) * 20.0;
    }
  }
  const Accuracy without = Judge(clean, SolveBy("batch", clean));
  EXPECT_GT(Judge(dirty, SolveBy("batch", dirty)).horizontal_rms,
            3.0 * without.horizontal_rms);
  const Solution solution = SolveBy("robust_batch", dirty);
  EXPECT_LT(Judge(dirty, solution).horizontal_rms,
            1.2 * without.horizontal_rms);
  EXPECT_TRUE(std::ranges::any_of(solution.notes, [](const std::string& one) {
    return one.find("biased from 45 to 60 s") != std::string::npos;
  }));
}

/// Wheels that spin for four seconds: not the receiver errs, nor does the IMU's velocity
/// step.
TEST(RobustBatch, FindsWheelsThatSlip) {
  const Dataset clean = Simulate(FindScenario("test_car"), 21);
  Dataset dirty = clean;
  for (AidingStream& stream : dirty.streams) {
    for (Measurement& z : stream.measurements.Edited()) {
      auto* odometer = std::get_if<Odometer>(&z.model);
      if (odometer == nullptr || z.t < 60.0 || z.t >= 64.0) continue;
      odometer->speed *= 1.5;
    }
  }
  const Accuracy without = Judge(clean, SolveBy("batch", clean));
  EXPECT_GT(Judge(dirty, SolveBy("batch", dirty)).horizontal_rms,
            1.15 * without.horizontal_rms);
  const Solution solution = SolveBy("robust_batch", dirty);
  EXPECT_LT(Judge(dirty, solution).horizontal_rms,
            1.05 * without.horizontal_rms);
  EXPECT_TRUE(std::ranges::any_of(solution.notes, [](const std::string& one) {
    return one.starts_with("odometer: against the noise as stated");
  }));
}

/// Gyros that measure a hundredth too much, which nobody estimates, beside wheels: the
/// receiver is right, whatever drift would explain.
TEST(RobustBatch, TakesNoScaleOfTheGyrosForErrorsOfAReceiver) {
  const Dataset dataset =
      Simulate(FindScenario("test_car", {"wander.duration=100 s",
                                         "aiding.gnss.sigma=0.01 m",
                                         "imu.noise.gyro=0.02 deg/sqrt(h)",
                                         "imu.gyro_scale=[1 %, 1 %, 1 %]"}),
               26209);
  const Accuracy batch = Judge(dataset, SolveBy("batch", dataset));
  const Solution solution = SolveBy("robust_batch", dataset);
  EXPECT_NE(solution.grade, Grade::kUsable);
  EXPECT_NEAR(Judge(dataset, solution).horizontal_rms, batch.horizontal_rms,
              1e-6);
  EXPECT_TRUE(std::ranges::any_of(solution.notes, [](const std::string& one) {
    return one.find("not believed, as it explains more that gyro z") !=
           std::string::npos;
  }));
}

/// An odometer that is turned by 0.4 deg beside a receiver that is 0.28 m off for twenty
/// seconds: what is turned is named, but is no reason not to believe the errors.
TEST(RobustBatch, TakesErrorsBesideASmallConstant) {
  Dataset dirty = Simulate(
      FindScenario("test_car",
                   {"wander.duration=100 s", "aiding.gnss.sigma=0.05 m"}),
      31050);
  for (AidingStream& stream : dirty.streams) {
    if (!stream.sensor.kind->is_position) {
      stream.sensor.q_sb =
          Eigen::AngleAxisd(-0.4 * kDegree, Eigen::Vector3d::UnitZ());
      continue;
    }
    for (Measurement& z : stream.measurements.Edited()) {
      if (z.t < 40.0 || z.t >= 60.0) continue;
      auto& fix = std::get<PositionFix>(z.model);
      fix.p_e += NedAxes(fix.p_e) * Eigen::Vector3d(0.2, 0.2, 0.0);
    }
  }
  const Accuracy batch = Judge(dirty, SolveBy("batch", dirty));
  const Solution solution = SolveBy("robust_batch", dirty);
  EXPECT_LT(Judge(dirty, solution).horizontal_rms, 0.5 * batch.horizontal_rms);
  EXPECT_TRUE(std::ranges::any_of(solution.notes, [](const std::string& one) {
    return one.find("biased from 40 to 60 s") != std::string::npos;
  }));
  EXPECT_TRUE(std::ranges::any_of(solution.evidence, [](const Evidence& one) {
    return one.what.find("turned by") != std::string::npos;
  })) << solution.verdict;
}

/// A DVL that measures 0.1 m/s too much along each axis for forty seconds: not what tells
/// places errs.
TEST(RobustBatch, FindsADvlThatErrs) {
  Dataset dirty = Simulate(FindScenario("test_dive"), 22);
  for (AidingStream& stream : dirty.streams) {
    for (Measurement& z : stream.measurements.Edited()) {
      auto* dvl = std::get_if<Dvl>(&z.model);
      if (dvl == nullptr || z.t < 60.0 || z.t >= 100.0) continue;
      dvl->speed.head<3>().array() += 0.1;
    }
  }
  const Accuracy batch = Judge(dirty, SolveBy("batch", dirty));
  EXPECT_GT(batch.position_nees, 30.0);
  const Solution solution = SolveBy("robust_batch", dirty);
  const Accuracy robust = Judge(dirty, solution);
  EXPECT_LT(robust.horizontal_rms, 0.5 * batch.horizontal_rms);
  EXPECT_LT(robust.position_nees, 6.0);
  EXPECT_TRUE(std::ranges::any_of(solution.notes, [](const std::string& one) {
    return one.starts_with("dvl: biased from 60 to 100 s by 0.1");
  }));
}

/// A receiver of 0.5 m alone, which is 1.2 m off for a minute.
Dataset LoneReceiverThatIsOffForAMinute(std::uint64_t seed) {
  Dataset dataset = Simulate(FindScenario("two_receivers"), seed);
  dataset.streams.pop_back();
  for (Measurement& z : dataset.streams.front().measurements.Edited()) {
    auto* fix = std::get_if<PositionFix>(&z.model);
    if (fix == nullptr || z.t < 50.0 || z.t >= 110.0) continue;
    fix->p_e += NedAxes(fix->p_e) * Eigen::Vector3d(1.2, 1.2, 0.0);
  }
  return dataset;
}

/// The likelihoods with and without the error differ by less than a factor of a
/// thousand; with it is likelier.
TEST(RobustBatch, TakesErrorsThatAreLikelierThanNoise) {
  const Dataset dirty = LoneReceiverThatIsOffForAMinute(21);
  const Accuracy batch = Judge(dirty, SolveBy("batch", dirty));
  EXPECT_GT(batch.position_nees, 30.0);
  const Accuracy robust = Judge(dirty, SolveBy("robust_batch", dirty));
  EXPECT_LT(robust.horizontal_rms, 0.5 * batch.horizontal_rms);
  EXPECT_LT(robust.position_nees, 6.0);
}

/// Here about as likely as without it.
TEST(RobustBatch, DoubtsNoiseBesideWhichAnErrorIsAboutAsLikely) {
  Dataset clean = Simulate(FindScenario("two_receivers"), 33);
  clean.streams.pop_back();
  EXPECT_EQ(SolveBy("robust_batch", clean).grade, Grade::kUsable);
  const Dataset dirty = LoneReceiverThatIsOffForAMinute(33);
  const Solution solution = SolveBy("robust_batch", dirty);
  EXPECT_GT(Judge(dirty, SolveBy("batch", dirty)).position_nees, 30.0);
  EXPECT_LT(Judge(dirty, solution).position_nees, 15.0);
  EXPECT_EQ(solution.grade, Grade::kDoubtful);
  EXPECT_TRUE(std::ranges::any_of(solution.evidence, [](const Evidence& one) {
    return one.what.find("m off: left: as stated; or else") !=
               std::string::npos &&
           one.what.ends_with("biased from 50 to 110 s by 1.4 m");
  })) << solution.verdict;
}

/// Of an hour the search of sequences has to have its effort, whatever else is fitted.
TEST(RobustBatch, FindsAPulseAndAStepOfAnHour) {
  Dataset dirty =
      Simulate(FindScenario("test_car", {"wander.duration=3600 s"}), 71);
  for (AidingStream& stream : dirty.streams) {
    if (!stream.sensor.kind->is_position) continue;
    for (Measurement& z : stream.measurements.Edited()) {
      auto& fix = std::get<PositionFix>(z.model);
      const bool pulse = z.t >= 600.0 && z.t < 640.0;
      const bool step = z.t >= 2500.0 && z.t < 2900.0;
      const double size = pulse ? 6.0 : step ? 5.0 : 0.0;
      fix.p_e += NedAxes(fix.p_e) * Eigen::Vector3d(size, size, 0.0);
    }
  }
  const Accuracy robust = Judge(dirty, SolveBy("robust_batch", dirty));
  EXPECT_LT(robust.horizontal_rms, 0.25);
  EXPECT_LT(robust.position_nees, 5.0);
}

/// What is said where each sensor is left off in every round, as there is no time.
std::vector<std::string> SaidWithoutTime(const Dataset& dataset) {
  ReconstructionOptions options;
  options.method = "robust_batch";
  options.max_time = 0.0;
  const Solution solution = Solve(dataset, options);
  std::vector<std::string> words = solution.notes;
  for (const Evidence& one : solution.evidence) words.push_back(one.what);
  return words;
}

bool SaysThatItWasEnded(const std::vector<std::string>& words) {
  return std::ranges::any_of(words, [](const std::string& one) {
    return one.find("was ended before it was done") != std::string::npos;
  });
}

TEST(RobustBatch, SaysThatItWasEndedBesideACompassThatErrs) {
  EXPECT_TRUE(SaysThatItWasEnded(SaidWithoutTime(
      DroneBesideACurrent(Simulate(FindScenario("test_drone"), 3)))));
}

TEST(RobustBatch, SaysOnceWhatItSaysInSeveralRounds) {
  std::vector<std::string> words = SaidWithoutTime(
      DroneWithAGlitch(Simulate(FindScenario("test_drone"), 3)));
  EXPECT_TRUE(SaysThatItWasEnded(words));
  std::ranges::sort(words);
  const auto twice = std::ranges::adjacent_find(words);
  EXPECT_TRUE(twice == words.end()) << *twice;
}

TEST(RobustBatch, FindsACompassThatTurnsTheStart) {
  const Dataset clean = Simulate(FindScenario("test_drone"), 3);
  const Accuracy without = Judge(clean, SolveBy("batch", clean));
  const Dataset dirty = DroneBesideACurrent(clean);
  EXPECT_GT(LargestHeadingError(dirty, SolveBy("batch", dirty)),
            45.0 * kDegree);
  const Solution solution = SolveBy("robust_batch", dirty);
  EXPECT_LT(LargestHeadingError(dirty, solution), 5.0 * kDegree);
  EXPECT_LT(Judge(dirty, solution).horizontal_rms,
            1.1 * without.horizontal_rms);
}

/// The glitch is in the middle of the time beside the current.
TEST(RobustBatch, FindsAGlitchBesideACompassThatErrs) {
  const Dataset clean = Simulate(FindScenario("test_drone"), 5);
  const Accuracy without = Judge(clean, SolveBy("batch", clean));
  const Dataset dirty = DroneBesideACurrent(DroneWithAGlitch(clean));
  EXPECT_GT(Judge(dirty, SolveBy("batch", dirty)).horizontal_rms,
            20.0 * without.horizontal_rms);
  const Solution solution = SolveBy("robust_batch", dirty);
  EXPECT_LT(LargestHeadingError(dirty, solution), 5.0 * kDegree);
  const Accuracy robust = Judge(dirty, solution);
  EXPECT_LT(robust.horizontal_rms, 1.5 * without.horizontal_rms);
  EXPECT_LT(robust.position_nees, 1.5 * without.position_nees);
}

}  // namespace
}  // namespace hindsight
