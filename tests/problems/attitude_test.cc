#include "problems/attitude.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/chi_square.h"
#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "dataset/bias_sigma.h"
#include "geometry/so3.h"
#include "io/config/scenario_config.h"
#include "measurements/sensor_kind.h"
#include "problems/attitude_trial.h"
#include "problems/navigation_trial.h"
#include "simulation/free_rotation.h"
#include "simulation/vibration_attitude.h"
#include "support/seed_count.h"
#include "support/study.h"

namespace hindsight {
namespace {

/// Of the notes those that say what a method makes no use of.
std::vector<std::string> NoUseOf(const Solution& solution) {
  std::vector<std::string> notes;
  for (const std::string& note : solution.notes) {
    if (note.starts_with("no use for")) notes.push_back(note);
  }
  return notes;
}

VibrationAttitudeOptions Calm() {
  VibrationAttitudeOptions options;
  options.acceleration = 0.0;
  options.vibration_sigma = 0.0;
  return options;
}

/// Samples of SimulateFreeRotation.
constexpr std::size_t kAtRest = 1400;
constexpr std::size_t kTurned = 4000;

/// e' P^-1 e of attitude and gyro bias at sample k.
double Nees(const Dataset& dataset, const Solution& solution, std::size_t k) {
  const State& x = solution.states[k];
  const Eigen::Quaterniond q_nb =
      Eigen::Quaterniond(x.C_en()).conjugate() * x.q_eb;
  Eigen::Matrix<double, 6, 1> e;
  e << Log(*dataset.truth[k].q_nb * q_nb.conjugate()),
      *dataset.truth[k].b_g - x.b_g;
  const Eigen::Matrix<double, 6, 6> P = solution.covariances.Get(k);
  return e.dot(P.llt().solve(e));
}

/// Accelerometers without a stated bias have that of a consumer IMU, as in
/// navigation, and are named; others are not. Before the body turns a filter
/// knows no more of it; the whole of its turns tells it.
TEST(AttitudeEstimation, UnstatedAccelerometersMayBeOffAsAConsumersAre) {
  Dataset dataset = SimulateFreeRotation({}, 9);
  dataset.streams.clear();
  dataset.initial.accel_bias_sigma.reset();
  const Eigen::Vector3d usual = AccelBiasSigma(dataset.initial);
  for (const char* method : {"ahrs", "ahrs_smoother"}) {
    double tilt[2], turned[2];
    for (const bool stated : {false, true}) {
      dataset.initial.accel_bias_sigma.reset();
      if (stated) dataset.initial.accel_bias_sigma = usual;
      Reconstruction estimation(dataset, AttitudeAlone());
      const Solution solution = estimation.Run(method);
      EXPECT_EQ(std::any_of(solution.notes.begin(), solution.notes.end(),
                            [](const std::string& note) {
                              return note.find("accel_bias_sigma") !=
                                     std::string::npos;
                            }),
                !stated);
      tilt[stated ? 1 : 0] = std::sqrt(solution.covariances.Get(kAtRest)(0, 0));
      turned[stated ? 1 : 0] =
          std::sqrt(solution.covariances.Get(kTurned)(0, 0));
    }
    EXPECT_EQ(tilt[0], tilt[1]);
    EXPECT_EQ(turned[0], turned[1]);
    const double usual_tilt = usual.x() / kStandardGravity;
    if (method == std::string("ahrs")) {
      EXPECT_GT(tilt[0], 0.9 * usual_tilt);
    } else {
      EXPECT_LT(tilt[0], 0.1 * usual_tilt);
    }
    EXPECT_LT(turned[0], 0.1 * usual_tilt);
  }
}

/// 0.3 m/s^2 that nothing states, in a hand that is too quick to show it, is
/// within what is said of the tilt.
TEST(AttitudeEstimation, AnUnstatedBiasOfTheAccelerometerIsWithinItsSigma) {
  Dataset dataset = SimulateVibrationAttitude(Calm(), 4);
  dataset.initial.accel_bias_sigma.reset();
  for (ImuSample& sample : dataset.imu.samples) sample.accel.x() += 0.3;
  Reconstruction estimation(dataset, AttitudeAlone());
  for (const char* method : {"ahrs", "ahrs_smoother"}) {
    const Solution solution = estimation.Run(method);
    const Interval credible = AneesBounds(1, 6, 0.9999);
    EXPECT_LT(Nees(dataset, solution, 300), credible.upper) << method;
  }
}

TEST(AttitudeEstimation, FilterAndSmootherAreConsistent) {
  constexpr int kRuns = testing::SeedCount(60);
  double filter = 0.0;
  double smoother = 0.0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const Dataset dataset = SimulateVibrationAttitude(Calm(), seed);
    Reconstruction estimation(dataset, AttitudeAlone());
    filter += Nees(dataset, estimation.Run("ahrs"), 300) / kRuns;
    smoother += Nees(dataset, estimation.Run("ahrs_smoother"), 300) / kRuns;
  }
  const Interval bounds = AneesBounds(kRuns, 6, 0.999);
  EXPECT_TRUE(bounds.Contains(filter)) << filter;
  EXPECT_TRUE(bounds.Contains(smoother)) << smoother;
}

TEST(AttitudeEstimation, SmncWithstandsVibration) {
  const Recording recording = [](std::uint64_t seed) {
    return SimulateVibrationAttitude({}, seed);
  };
  Study study = {.tables = {Under({"rule"}, VibrationTable())}};
  for (const TriedRule& rule : TriedRules()) {
    study.cases.push_back(VibrationCase({}, recording, rule));
  }
  const StudyResult result = testing::RunStudy(study, {.runs = 20});
  const auto value = [&](const char* rule, const char* figure) {
    return testing::ValueOf(result, {rule, "ahrs"}, figure);
  };
  constexpr double kExpected = 0.22 * kDegree;
  const double smnc = value("smnc", "rms_total_40_45s");
  EXPECT_NEAR(smnc, kExpected, 0.1 * kExpected);
  EXPECT_GT(value("smnc", "inside_40_45s"), 0.99);
  EXPECT_LT(value("smnc", "rms_total_10_60s"), 0.33 * kDegree);
  EXPECT_LT(smnc, 0.7 * value("gate 0.88", "rms_total_40_45s"));
  EXPECT_NEAR(value("held gate 0.88", "rms_total_40_45s"), smnc,
              0.1 * kExpected);
}

TEST(AttitudeEstimation, SolutionsAreGivenAtTheStampsOfTheFile) {
  Dataset dataset = SimulateVibrationAttitude(Calm(), 3);
  const PagedVector<ImuSample> samples = dataset.imu.samples;
  dataset.imu.stamp_offset = -0.02;
  for (ImuSample& sample : dataset.imu.samples) sample.t -= 0.02;
  Reconstruction estimation(dataset, AttitudeAlone());
  const Solution solution = estimation.Run("ahrs");
  ASSERT_EQ(solution.states.size(), samples.size());
  ASSERT_EQ(solution.covariances.size(), samples.size());
  ASSERT_EQ(solution.attitude->accel_sigma.size(), samples.size());
  for (std::size_t k = 0; k < samples.size(); k += 50) {
    EXPECT_NEAR(solution.states[k].t, samples[k].t, 1e-12);
  }
}

/// A body swung about in a room, three times its own weight at the peaks.
Dataset Swing() {
  Dataset dataset;
  constexpr double kStep = 0.01;
  const Eigen::Vector3d kAmplitude(0.3, 0.2, 0.15);
  const double kRate = 5.0;
  Eigen::Quaterniond q_nb = Eigen::Quaterniond::Identity();
  AidingStream magnetometer;
  magnetometer.sensor.kind = &MagnetometerKind();
  const auto w_at = [](double t) {
    return Eigen::Vector3d(0.8 * std::sin(0.7 * t), 0.6 * std::cos(0.9 * t),
                           0.7 * std::sin(1.1 * t));
  };
  for (int k = 0; k <= 4000; ++k) {
    const double t = k * kStep;
    if (k > 0) {
      q_nb = (q_nb * Exp(kStep * w_at(t - 0.5 * kStep))).normalized();
    }
    const Eigen::Vector3d a_n =
        -kRate * kRate * kAmplitude * std::sin(kRate * t);
    dataset.imu.samples.push_back(
        {t, w_at(t),
         q_nb.conjugate() *
             (a_n - Eigen::Vector3d(0.0, 0.0, kStandardGravity))});
    magnetometer.measurements.push_back(
        {t, 0, false,
         MagneticField{q_nb.conjugate() * Eigen::Vector3d(20.0, 0.0, 40.0), 3.5,
                       MagneticField::Form::kVector}});
    TruthPoint truth;
    truth.t = t;
    truth.q_nb = q_nb;
    dataset.truth.push_back(truth);
  }
  dataset.imu.noise.gyro_noise_density = 1e-4;
  dataset.imu.noise.accel_noise_density = 1e-2;
  dataset.streams.push_back(magnetometer);
  return dataset;
}

Eigen::Quaterniond NedAttitude(const State& x) {
  return Eigen::Quaterniond(x.C_en()).conjugate() * x.q_eb;
}

/// Largest error of attitude from 5 s to 35 s [rad].
double LargestError(const Dataset& dataset, const Solution& solution) {
  double largest = 0.0;
  for (std::size_t k = 500; k < 3500; k += 100) {
    largest = std::max(largest, NedAttitude(solution.states[k])
                                    .angularDistance(*dataset.truth[k].q_nb));
  }
  return largest;
}

/// 30 uT that travel along, on the whole way or for a quarter of it, and 30 uT
/// that pass by for as long: had these their full say they would turn the
/// heading by some 20 deg; the swing adds its own.
TEST(AttitudeEstimation, SmootherSeesThroughMagnets) {
  const Eigen::Vector3d magnet(15.0, -20.0, 16.0);
  for (const std::string kind :
       {"attached", "attached for a part", "passing"}) {
    Dataset dataset = Swing();
    for (Measurement& z : dataset.streams.front().measurements.Edited()) {
      Eigen::Vector3d& field_b = std::get<MagneticField>(z.model).field_b;
      const auto k = static_cast<std::size_t>(std::lround(z.t / 0.01));
      const bool part = z.t > 12.0 && z.t < 22.0;
      if (kind == "passing") {
        if (part) field_b += dataset.truth[k].q_nb->conjugate() * magnet;
      } else if (kind == "attached" || part) {
        field_b += magnet;
      }
    }
    Reconstruction estimation(dataset, AttitudeAlone());
    const Solution solution = estimation.Run("ahrs_smoother");
    EXPECT_LT(LargestError(dataset, solution), 2.5 * kDegree) << kind;
    const auto flagged = std::count(solution.attitude->magnetic.begin(),
                                    solution.attitude->magnetic.end(), -1);
    EXPECT_EQ(flagged > 0, kind == "passing") << kind;
    const bool told =
        !solution.notes.empty() && solution.notes.front().starts_with(
                                       "a magnet of 30 uT that travels "
                                       "along from 12.1 to 21.9 s");
    EXPECT_EQ(told, kind == "attached for a part") << kind;
  }
}

double HeadingError(const Dataset& dataset, const Solution& solution,
                    std::size_t k) {
  return Log(NedAttitude(solution.states[k]) *
             dataset.truth[k].q_nb->conjugate())
      .z();
}

/// Gyro scale factors of 0.4 %, which turn the free integral by up to 30 deg,
/// with a field that is of no use in motion and with one that is.
TEST(AttitudeEstimation, TwentyTurnsWithAScaleErrorAreConsistent) {
  const int runs = testing::SeedCount(12, 100);
  constexpr std::uint64_t kFirstSeed = 501;
  const StudyTable table = RotationTable(kFreeRotationBegin, kFreeRotationEnd);
  for (const double disturbance : {60.0, 0.0}) {
    const Recording recording = [disturbance](std::uint64_t seed) {
      FreeRotationOptions options = DrawFreeRotation(seed);
      options.motion_disturbance = disturbance;
      return SimulateFreeRotation(options, seed);
    };
    const StudyResult result = testing::RunStudy(
        {"",
         {},
         {table},
         {{{},
           [&] { return recording; },
           NavigationTrialOf({.methods = {"ahrs", "ahrs_smoother"},
                              .cells = table,
                              .judged_every = 0.1})}}},
        {.runs = runs, .first_seed = kFirstSeed});
    for (const char* method : {"ahrs", "ahrs_smoother"}) {
      const auto value = [&](const char* figure) {
        return testing::ValueOf(result, {method}, figure);
      };
      EXPECT_TRUE(AneesBounds(runs, 3, 0.999).Contains(value("nees")))
          << method << value("nees");
      EXPECT_GT(value("inside"), 0.98) << method;
    }
    EXPECT_LT(testing::ValueOf(result, {"ahrs_smoother"}, "heading_rms"),
              1.0 * kDegree);
  }
}

/// The field where the hand moves is turned by 9 deg against the one where it
/// rests, which points north: what cannot be told from the other way round, so
/// that half of it is left.
TEST(AttitudeEstimation, ASurveyIsNoWorseThanNone) {
  FreeRotationOptions options;
  options.motion_field_n = {19.0, 3.0, 42.0};
  options.gyro_scale = {0.003, -0.002, 0.004};
  for (const bool even : {false, true}) {
    if (even) options.motion_field_n = options.rest_field_n;
    Dataset dataset = SimulateFreeRotation(options, 1);
    dataset.ahrs.correlation_time = 1.0;
    for (Measurement& z : dataset.streams.front().measurements.Edited()) {
      std::get<MagneticField>(z.model).sigma = 2.0;
    }
    double error[2] = {};
    for (const bool survey : {false, true}) {
      dataset.ahrs.survey = survey;
      Reconstruction estimation(dataset, AttitudeAlone());
      const Solution solution = estimation.Run("ahrs_smoother");
      for (std::size_t k = 0; k < solution.states.size(); k += 100) {
        error[survey] = std::max(error[survey],
                                 std::abs(HeadingError(dataset, solution, k)));
      }
    }
    EXPECT_LT(error[1], std::max(error[0], 0.5 * kDegree));
    EXPECT_LT(error[1], (even ? 1.0 : 5.5) * kDegree);
  }
}

/// Which of the two fields points north is not known: the heading's sigma says
/// so, and the result is doubtful; where the field is even it is usable.
TEST(AttitudeEstimation, TwoNorthsAreTold) {
  for (const bool even : {true, false}) {
    FreeRotationOptions options;
    if (!even) options.motion_field_n = {18.8, 6.8, 40.0};
    Dataset dataset = SimulateFreeRotation(options, 1);
    dataset.ahrs.correlation_time = 1.0;
    for (Measurement& z : dataset.streams.front().measurements.Edited()) {
      std::get<MagneticField>(z.model).sigma = 3.5;
    }
    Reconstruction estimation(dataset, AttitudeAlone());
    const Solution solution = estimation.Run("ahrs_smoother");
    EXPECT_EQ(solution.grade, even ? Grade::kUsable : Grade::kDoubtful)
        << solution.verdict;
    const double sigma = std::sqrt(solution.covariances.Get(4000)(2, 2));
    EXPECT_LT(std::abs(HeadingError(dataset, solution, 4000)), 3.0 * sigma);
    EXPECT_EQ(sigma > 2.0 * kDegree, !even) << sigma;
  }
}

/// A magnetometer that is late by more than it turns in a step: its clock is
/// found, and told.
TEST(AttitudeEstimation, FindsTheClockOfTheMagnetometer) {
  constexpr double kDelay = 0.04;
  Dataset dataset = SimulateFreeRotation({}, 8);
  AidingStream& stream = dataset.streams.front();
  for (Measurement& z : stream.measurements.Edited()) z.t += kDelay;
  const auto constant = [&dataset] {
    Reconstruction estimation(dataset, AttitudeAlone());
    const Solution solution = estimation.Run("ahrs_smoother");
    for (const ConstantEstimate& c : solution.constants) {
      if (c.name == "magnetometer_time_offset") return std::optional(c);
    }
    return std::optional<ConstantEstimate>();
  };
  EXPECT_FALSE(constant());
  stream.sensor.time_offset_sigma = 0.05;
  const auto found = constant();
  ASSERT_TRUE(found);
  EXPECT_LT(found->sigma, 0.2 * 0.05);
  EXPECT_NEAR(found->value, -kDelay, 3.0 * found->sigma);
  EXPECT_EQ(found->verdict, ConstantEstimate::Verdict::kObserved);
  // The filter cannot, and says so.
  Reconstruction estimation(dataset, AttitudeAlone());
  EXPECT_EQ(NoUseOf(estimation.Run("ahrs")).size(), 1u);
}

/// Headings of another sensor in place of the field, from any heading at the
/// start; a pitch of the body does not matter.
/// Of a clock that is off and not asked for nothing else tells.
TEST(AttitudeEstimation, HearsOfTheClockOfTheMagnetometer) {
  Dataset dataset = SimulateFreeRotation({}, 14);
  for (const double late : {0.0, 0.03}) {
    for (Measurement& z : dataset.streams.front().measurements.Edited()) {
      z.t += late;
    }
    Reconstruction estimation(dataset, AttitudeAlone());
    const Solution solution = estimation.Run("ahrs_smoother");
    const bool said =
        std::any_of(solution.evidence.begin(), solution.evidence.end(),
                    [](const Evidence& e) {
                      return e.what.find("s earlier than they are stamped") !=
                             std::string::npos;
                    });
    EXPECT_EQ(said, late > 0.0) << solution.verdict;
  }
}

TEST(AttitudeEstimation, HeadingsAreUsed) {
  FreeRotationOptions options;
  options.gyro_bias = {0.004, -0.003, 0.005};
  Dataset dataset = SimulateFreeRotation(options, 4);
  constexpr double kSigma = 0.5 * kDegree;
  AidingStream compass;
  compass.sensor.name = "compass";
  compass.sensor.kind = &HeadingKind();
  compass.sensor.own_vector = Eigen::Vector3d::UnitX();
  Random random(4);
  for (std::size_t k = 150; k < dataset.truth.size(); k += 100) {
    GenericReading z;
    z.model = &BaselineDirection();
    z.sigma << kSigma, 0.0, 1.0, 1.0;
    z.value(0) =
        DirectionOf(*dataset.truth[k].q_nb * Eigen::Vector3d::UnitX())(0) +
        kSigma * random.Normal();
    compass.measurements.push_back({dataset.truth[k].t, 0, false, z});
  }
  dataset.streams = {compass};
  Reconstruction estimation(dataset, AttitudeAlone());
  for (const char* method : {"ahrs", "ahrs_smoother"}) {
    const Solution solution = estimation.Run(method);
    for (const std::size_t k : {1000u, 4000u, 8000u}) {
      const double sigma = std::sqrt(solution.covariances.Get(k)(2, 2));
      EXPECT_LT(sigma, 2.0 * kSigma) << method << k;
      EXPECT_LT(std::abs(HeadingError(dataset, solution, k)), 4.0 * sigma)
          << method << k;
    }
    EXPECT_EQ(solution.verdict.find("counts from the start"),
              std::string::npos);
  }
  // Without them the heading drifts, and that is said.
  dataset.streams.clear();
  Reconstruction alone(dataset, AttitudeAlone());
  EXPECT_NE(alone.Run("ahrs_smoother").verdict.find("counts from the start"),
            std::string::npos);
}

TEST(AttitudeEstimation, DoesNotTurnWhileItRests) {
  FreeRotationOptions options;
  options.gyro_bias = {0.004, -0.003, 0.005};
  Dataset dataset = SimulateFreeRotation(options, 2);
  dataset.streams.clear();
  Reconstruction estimation(dataset, AttitudeAlone());
  const Solution solution = estimation.Run("ahrs_smoother");
  for (const auto& [from, to] : {std::pair(100, 1400), std::pair(7700, 8900)}) {
    EXPECT_LT(NedAttitude(solution.states[static_cast<std::size_t>(from)])
                  .angularDistance(NedAttitude(
                      solution.states[static_cast<std::size_t>(to)])),
              0.1 * kDegree);
  }
}

TEST(AttitudeEstimation, HeedsItsSettingsOrSaysNot) {
  Dataset dataset = SimulateFreeRotation({}, 3);
  dataset.ahrs.correlation_time = 1.0;
  const auto heading_sigma = [&] {
    Reconstruction estimation(dataset, AttitudeAlone());
    return std::sqrt(
        estimation.Run("ahrs_smoother").covariances.Get(700)(2, 2));
  };
  for (const bool survey : {true, false}) {
    dataset.ahrs.survey = survey;
    double sigma[2] = {};
    for (const int times : {1, 2}) {
      for (Measurement& z : dataset.streams.front().measurements.Edited()) {
        std::get<MagneticField>(z.model).sigma = 2.0 * times;
      }
      sigma[times - 1] = heading_sigma();
    }
    EXPECT_GT(sigma[1], 1.5 * sigma[0]) << survey;
  }
  // Nothing is as quiet as this: rest is not known.
  dataset.ahrs.rest_sigma = 1e-3;
  const double resting = heading_sigma();
  dataset.stationary.enabled = true;
  dataset.stationary.gyro_threshold = 1e-9;
  EXPECT_NE(heading_sigma(), resting);
  // The filter cannot, and says so.
  Reconstruction estimation(dataset, AttitudeAlone());
  EXPECT_EQ(NoUseOf(estimation.Run("ahrs")).size(), 1u);
}

/// What a configuration leaves open of the magnetometer is in the sigma.
TEST(AttitudeEstimation, StatedSigmasOfTheMagnetometerCount) {
  constexpr double kDeclination = 3.0 * kDegree;
  Dataset dataset = SimulateFreeRotation({}, 5);
  const auto variance = [&](const char* method) {
    Reconstruction estimation(dataset, AttitudeAlone());
    return estimation.Run(method).covariances.Get(4000)(2, 2);
  };
  for (const char* method : {"ahrs", "ahrs_smoother"}) {
    dataset.streams.front().sensor.magnetic.declination_sigma.reset();
    const double without = variance(method);
    dataset.streams.front().sensor.magnetic.declination_sigma = kDeclination;
    EXPECT_NEAR(variance(method) - without, kDeclination * kDeclination, 1e-9);
  }
}

/// A place whose dip is another one than stated may turn north as much. Another
/// scale of the readings says nothing.
TEST(AttitudeEstimation, AnotherDipThanStatedIsInTheHeadingsSigma) {
  constexpr double kOff = 3.0 * kDegree;
  Dataset dataset = SimulateFreeRotation({}, 5);
  MagneticSurroundings& magnetic = dataset.streams.front().sensor.magnetic;
  for (Measurement& z : dataset.streams.front().measurements.Edited()) {
    std::get<MagneticField>(z.model).form = MagneticField::Form::kVector;
  }
  const MagneticSurroundings true_field = magnetic;
  const double norm = std::hypot(true_field.horizontal, true_field.down);
  const double dip = std::atan2(true_field.down, true_field.horizontal);
  const auto variance = [&](const char* method, double stated_dip,
                            double scale) {
    magnetic.horizontal = scale * norm * std::cos(stated_dip);
    magnetic.down = scale * norm * std::sin(stated_dip);
    Reconstruction estimation(dataset, AttitudeAlone());
    return estimation.Run(method).covariances.Get(kTurned)(2, 2);
  };
  for (const char* method : {"ahrs", "ahrs_smoother"}) {
    const double without = variance(method, dip, 1.0);
    // The dip is found to a tenth of a degree.
    EXPECT_NEAR(std::sqrt(variance(method, dip - kOff, 1.0) - without),
                std::sin(kOff) / std::cos(dip), 0.1 * kDegree / std::cos(dip))
        << method;
    EXPECT_NEAR(variance(method, dip, 0.8), without, 0.01 * without) << method;
  }
}

/// A bias of the accelerometer that is known exactly is taken off.
TEST(AttitudeEstimation, GivenBiasOfTheAccelerometerIsTakenOff) {
  Dataset dataset = SimulateFreeRotation({}, 10);
  const Eigen::Vector3d bias(0.2, -0.1, 0.3);
  for (const char* method : {"ahrs", "ahrs_smoother"}) {
    Dataset biased = dataset;
    for (ImuSample& sample : biased.imu.samples) sample.accel += bias;
    biased.initial.accel_bias = bias;
    Reconstruction with(biased, AttitudeAlone());
    Reconstruction without(dataset, AttitudeAlone());
    const State x = with.Run(method).states[kTurned];
    EXPECT_LT(NedAttitude(x).angularDistance(
                  NedAttitude(without.Run(method).states[kTurned])),
              1e-6);
  }
}

/// What is left open of it tilts the attitude, and turns the heading by the dip,
/// 2 : 1 to the north, until the body turns; then it is found, within its sigma.
TEST(AttitudeEstimation, BiasOfTheAccelerometerIsFoundInTurns) {
  constexpr double kSigma = 0.2;
  const double tilt = kSigma / kStandardGravity;
  Dataset dataset = SimulateFreeRotation({}, 10);
  const Eigen::Vector3d bias(0.2, -0.1, 0.3);
  for (ImuSample& sample : dataset.imu.samples) sample.accel += bias;
  dataset.initial.accel_bias_sigma = Eigen::Vector3d::Constant(kSigma);
  Reconstruction estimation(dataset, AttitudeAlone());
  const Solution filtered = estimation.Run("ahrs");
  const ErrorMatrix P = filtered.covariances.Get(kAtRest);
  // Of a level that is known to 5 deg beforehand.
  const double posterior = tilt / std::hypot(1.0, tilt / (5.0 * kDegree));
  // The slope of the field changes, by a twentieth, when the reference is learned,
  // by which white readings of 0.5 uT seem to tell a little of the tilt.
  EXPECT_NEAR(std::sqrt(P(0, 0)), posterior, 0.1 * posterior);
  EXPECT_NEAR(std::sqrt(P(1, 1)), posterior, 0.1 * posterior);
  EXPECT_NEAR(std::sqrt(P(2, 2)), 2.0 * posterior, 0.15 * 2.0 * posterior);
  Dataset without = dataset;
  without.streams.clear();
  Reconstruction level(without, AttitudeAlone());
  const ErrorMatrix P_level = level.Run("ahrs").covariances.Get(kAtRest);
  EXPECT_NEAR(std::sqrt(P_level(0, 0)), posterior, 0.01 * posterior);
  EXPECT_NEAR(std::sqrt(P_level(1, 1)), posterior, 0.01 * posterior);
  const Solution smoothed = estimation.Run("ahrs_smoother");
  double chi2 = 0.0;
  int axis = 0;
  for (const ConstantEstimate& one : smoothed.constants) {
    if (!one.name.starts_with("accel_bias")) continue;
    const double error = (one.value - bias(axis++)) / one.sigma;
    EXPECT_LT(one.sigma, 0.2 * kSigma) << one.name;
    chi2 += error * error;
  }
  EXPECT_EQ(axis, 3);
  EXPECT_LT(chi2, ChiSquareQuantile(0.999, 3.0));
  const Interval credible = AneesBounds(1, 6, 0.9999);
  for (const std::size_t k : {kAtRest, kTurned}) {
    EXPECT_LT(Nees(dataset, filtered, k), credible.upper) << k;
    EXPECT_LT(Nees(dataset, smoothed, k), credible.upper) << k;
  }
}

/// Where it is said to be known better than it is, the turns tell.
TEST(AttitudeEstimation, AWrongBiasOfTheAccelerometerIsDoubtful) {
  Dataset dataset = SimulateFreeRotation({}, 10);
  dataset.initial.accel_bias_sigma = Eigen::Vector3d::Constant(0.03);
  const auto evidence = [&dataset](const char* method) {
    Reconstruction estimation(dataset, AttitudeAlone());
    const Solution solution = estimation.Run(method);
    return std::any_of(solution.evidence.begin(), solution.evidence.end(),
                       [](const Evidence& e) {
                         return e.rule == "given_values" &&
                                e.what.starts_with("accel_bias");
                       });
  };
  EXPECT_FALSE(evidence("ahrs"));
  EXPECT_FALSE(evidence("ahrs_smoother"));
  for (ImuSample& sample : dataset.imu.samples) sample.accel.x() += 0.3;
  EXPECT_TRUE(evidence("ahrs"));
  EXPECT_TRUE(evidence("ahrs_smoother"));
}

const Evidence* EvidenceOf(const Solution& solution, const std::string& rule) {
  const auto found =
      std::find_if(solution.evidence.begin(), solution.evidence.end(),
                   [&rule](const Evidence& e) { return e.rule == rule; });
  return found == solution.evidence.end() ? nullptr : &*found;
}

/// Of forces in another unit the direction is right, and it is used.
TEST(AttitudeEstimation, AnotherUnitOfForceIsDoubtfulAndNoHarm) {
  Dataset dataset = SimulateFreeRotation({}, 12);
  const auto solve = [&dataset](const char* method) {
    Reconstruction estimation(dataset, AttitudeAlone());
    return estimation.Run(method);
  };
  for (const char* method : {"ahrs", "ahrs_smoother"}) {
    const Solution right = solve(method);
    EXPECT_EQ(EvidenceOf(right, "gravity"), nullptr);
    const PagedVector<ImuSample> samples = dataset.imu.samples;
    for (ImuSample& sample : dataset.imu.samples) {
      sample.accel /= kStandardGravity;
    }
    const Solution other = solve(method);
    dataset.imu.samples = samples;
    ASSERT_NE(EvidenceOf(other, "gravity"), nullptr);
    EXPECT_EQ(other.grade, Grade::kDoubtful) << other.verdict;
    EXPECT_LT(NedAttitude(other.states[4000])
                  .angularDistance(NedAttitude(right.states[4000])),
              0.05 * kDegree);
  }
}

/// A magnetometer that repeats its readings is late, but its errors go on for
/// longer than that; one that repeats them for longer counts too often.
TEST(AttitudeEstimation, StaleFieldIsDoubtfulAsFarAsItsErrorsLast) {
  Dataset dataset = SimulateFreeRotation({}, 13);
  const MeasurementSeries fresh = dataset.streams.front().measurements;
  const double rate = static_cast<double>(fresh.size() - 1) /
                      (fresh.back().t - fresh.front().t);
  for (const double held : {0.5, 3.0}) {
    const auto rows = static_cast<std::size_t>(std::lround(held * rate));
    MeasurementSeries stale;
    for (std::size_t i = 0; i < fresh.size(); ++i) {
      Measurement z = fresh[i];
      z.model = Measurement(fresh[i - i % rows]).model;
      stale.push_back(z);
    }
    dataset.streams.front().measurements = std::move(stale);
    Reconstruction estimation(dataset, AttitudeAlone());
    const Solution solution = estimation.Run("ahrs_smoother");
    const Evidence* found = EvidenceOf(solution, "stale_readings");
    ASSERT_NE(found, nullptr) << held;
    EXPECT_EQ(found->grade, held < dataset.ahrs.correlation_time
                                ? Grade::kDoubtful
                                : Grade::kUnusable);
  }
}

TEST(AttitudeEstimation, WithheldFieldIsNotUsed) {
  Dataset dataset = SimulateFreeRotation({}, 6);
  for (Measurement& z : dataset.streams.front().measurements.Edited()) {
    z.withheld = true;
  }
  Reconstruction estimation(dataset, AttitudeAlone());
  const Solution solution = estimation.Run("ahrs");
  EXPECT_EQ(std::count(solution.attitude->magnetic.begin(),
                       solution.attitude->magnetic.end(), 0),
            static_cast<long>(solution.states.size()));
}

TEST(AttitudeEstimation, SaysWhichKeysItMakesNoUseOf) {
  Dataset dataset = SimulateFreeRotation({}, 9);
  Sensor& sensor = dataset.streams.front().sensor;
  const auto notes = [&dataset](const char* method) {
    Reconstruction estimation(dataset, AttitudeAlone());
    return NoUseOf(estimation.Run(method));
  };
  for (const char* method : {"ahrs", "ahrs_smoother"}) {
    EXPECT_TRUE(notes(method).empty());
  }
  sensor.gate_probability = 0.99;
  sensor.loss.kind = RobustLoss::Kind::kHuber;
  for (const char* method : {"ahrs", "ahrs_smoother"}) {
    const std::vector<std::string> said = notes(method);
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said.front().find("'gate', 'loss' of 'magnetometer'"),
              std::string::npos);
  }
}

TEST(AttitudeEstimation, SaysOfWhatItMakesNoUse) {
  Dataset dataset = SimulateFreeRotation({}, 7);
  AidingStream gnss;
  gnss.sensor.name = "gnss";
  gnss.measurements.push_back({1.0, 1, false, PositionFix()});
  dataset.streams.push_back(gnss);
  Reconstruction estimation(dataset, AttitudeAlone());
  for (const char* method : {"ahrs", "ahrs_smoother"}) {
    const std::vector<std::string> said = NoUseOf(estimation.Run(method));
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said.front().find("'gnss'"), std::string::npos);
  }
}

/// In a turn of 4 deg/s, midway between samples that are increments.
TEST(AttitudeEstimation, GoesOnTurningBetweenIncrements) {
  const Dataset dataset = Simulate(FindScenario("test_aircraft"), 41);
  Reconstruction estimation(dataset, AttitudeAlone());
  const Solution solution = estimation.Run("ahrs_smoother");
  std::vector<double> times;
  std::vector<Eigen::Quaterniond> middle;
  for (std::size_t k = 0; k + 1 < solution.states.size(); ++k) {
    const State& a = solution.states[k];
    const State& b = solution.states[k + 1];
    if (a.t < 30.0 || a.t > 40.0) continue;
    times.push_back(0.5 * (a.t + b.t));
    middle.push_back(a.q_eb.slerp(0.5, b.q_eb));
    ASSERT_GT(middle.back().angularDistance(a.q_eb), 2e-4);
  }
  ASSERT_GT(times.size(), 900u);
  const Solution sampled = estimation.Sample(solution, times);
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_LT(sampled.states[i].q_eb.angularDistance(middle[i]), 1e-4);
  }
}

}  // namespace
}  // namespace hindsight
