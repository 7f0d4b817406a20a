#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "io/config/scenario_config.h"
#include "measurements/sensor_kind.h"
#include "problems/clock_evidence.h"
#include "problems/forward_stage.h"
#include "problems/marginal_likelihood.h"
#include "problems/reconstruction.h"
#include "support/seed_count.h"
#include "support/shuttle_flight.h"

namespace hindsight {
namespace {

const ConstantEstimate& Constant(const Solution& solution,
                                 const std::string& name) {
  return *std::find_if(
      solution.constants.begin(), solution.constants.end(),
      [&](const ConstantEstimate& c) { return c.name == name; });
}

double RivalShare(const Solution& solution) {
  double sum = 0.0;
  for (const RivalSolution& rival : solution.rivals) sum += rival.probability;
  return sum;
}

/// Root mean square of the heading's error over the nodes [rad].
double HeadingError(const Solution& solution, const Dataset& dataset) {
  double square = 0.0, count = 0.0;
  auto point = dataset.truth.begin();
  for (const State& x : solution.states) {
    while (point + 1 != dataset.truth.end() && (point + 1)->t <= x.t) ++point;
    const double e =
        WrapAngle(x.euler().z() - EulerFromQuaternion(*point->q_nb).z());
    square += e * e;
    count += 1.0;
  }
  return std::sqrt(square / count);
}

/// Wrong choices, and how many the rivals told of them.
struct ChoiceCount {
  int runs = 0;
  int wrong = 0;
  double told = 0.0;
  double variance = 0.0;

  void Add(const Dataset& dataset, double late, const std::string& which) {
    const Solution solution = Solve(dataset, {});
    const double offset = Constant(solution, "gnss_time_offset").value;
    const bool right = std::abs(offset + late) < 0.2 &&
                       HeadingError(solution, dataset) < 20.0 * kDegree;
    const double share = RivalShare(solution);
    for (const RivalSolution& rival : solution.rivals) {
      EXPECT_NE(rival.description, "") << which;
    }
    ++runs;
    wrong += right ? 0 : 1;
    told += share;
    variance += share * (1.0 - share);
    EXPECT_TRUE(right || solution.grade != Grade::kUsable) << which;
  }

  void ExpectAsTold() const {
    const double three_sigmas = 3.0 * std::sqrt(variance) + 1e-3;
    EXPECT_LE(wrong, told + three_sigmas) << "of " << runs;
    EXPECT_GE(wrong, told - three_sigmas) << "of " << runs;
  }
};

/// All that makes one swing unlike another scales with the irregularity.
ShuttleOptions Irregular(double irregularity) {
  ShuttleOptions options;
  options.irregularity = irregularity;
  options.drift = irregularity;
  options.turning = 10.0 * kDegree * irregularity;
  return options;
}

/// Flights to and fro, the positions up to three quarters of a second late or
/// early.
TEST(ClockChoice, FlightsToAndFroAreSeldomTurnedRound) {
  const int seeds = testing::SeedCount(8, 60);
  ChoiceCount count;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto s = static_cast<std::uint64_t>(7000 + seed);
    const double late = 1.5 * Random(s, 1).Uniform() - 0.75;
    count.Add(LateShuttle({}, s, late, 0.5), late, std::to_string(seed));
  }
  count.ExpectAsTold();
  // Far more often right than by the prior alone.
  EXPECT_LE(count.wrong, std::max(1, seeds / 6));
}

/// The more regular a flight, the less but the prior tells: how often the wrong
/// clock is chosen is what the rivals say, and no result with one is usable.
TEST(ClockChoice, RegularFlightsAreTurnedRoundAsOftenAsTheRivalsSay) {
  const int seeds = testing::SeedCount(2, 40);
  ChoiceCount all;
  for (const double irregularity : {0.0, 0.003, 0.01, 0.03}) {
    for (int seed = 0; seed < seeds; ++seed) {
      const auto s = static_cast<std::uint64_t>(41000 + seed);
      const double late = 0.5 * Random(s, 1).Normal();
      all.Add(LateShuttle(Irregular(irregularity), s, late, 0.5), late,
              std::to_string(irregularity) + ", " + std::to_string(s));
    }
  }
  all.ExpectAsTold();
  RecordProperty("wrong", all.wrong);
  RecordProperty("told", std::to_string(all.told));
}

/// Without a prior any swing may be any other.
TEST(ClockChoice, AnUnknownClockOfARegularFlightIsRightOrTold) {
  const int seeds = testing::SeedCount(1, 16);
  ChoiceCount all;
  for (const double irregularity : {0.0, 0.003, 0.01, 0.03}) {
    for (int seed = 0; seed < seeds; ++seed) {
      const auto s = static_cast<std::uint64_t>(42000 + seed);
      const double late = 2.0 * Random(s, 1).Normal();
      Dataset dataset = LateShuttle(Irregular(irregularity), s, late, 0.5);
      dataset.streams[0].sensor.time_offset_sigma.reset();
      dataset.streams[0].clock_unknown = true;
      all.Add(dataset, late,
              std::to_string(irregularity) + ", " + std::to_string(s));
    }
  }
  const double three_sigmas = 3.0 * std::sqrt(all.variance) + 1e-3;
  EXPECT_LE(all.wrong, all.told + three_sigmas);
  RecordProperty("wrong", all.wrong);
  RecordProperty("told", std::to_string(all.told));
}

/// Circles of 10 m at 5 m/s: every clock fits, with the heading that goes with
/// it, but for what the Earth's rotation tells of north.
Scenario SteadyCircle() {
  constexpr double kSpeed = 5.0, kTurn = 0.5;
  const double radius_of_earth = 6.38e6;
  Scenario s;
  s.start = {48.0 * kDegree, 11.5 * kDegree, 500.0};
  for (int i = 0; i <= 3000; ++i) {
    ProfilePoint point;
    point.t = 0.02 * i;
    const double heading = kTurn * point.t;
    const double north = kSpeed / kTurn * std::sin(heading);
    const double east = kSpeed / kTurn * (1.0 - std::cos(heading));
    point.position = s.start;
    point.position.latitude += north / radius_of_earth;
    point.position.longitude +=
        east / (radius_of_earth * std::cos(s.start.latitude));
    point.v_n = {kSpeed * std::cos(heading), kSpeed * std::sin(heading), 0.0};
    point.euler.z() = heading;
    s.profile.push_back(point);
  }
  s.imu_rate_hz = 100.0;
  s.imu.noise.gyro_noise_density = 0.1 * kDegree / 60.0;
  s.imu.noise.accel_noise_density = 0.05 / 60.0;
  s.imu.gyro_bias_sigma.setConstant(30.0 * kDegree / 3600.0);
  s.imu.accel_bias_sigma.setConstant(0.02);
  AidingModel gnss(PositionKind());
  gnss.sensor.name = "gnss";
  gnss.rate_hz = 5.0;
  gnss.sigma = Eigen::Vector3d{0.02, 0.02, 0.03};
  s.aiding = {gnss};
  return s;
}

/// Share of the nodes at which the heading is more than five sigmas off.
double WrongHeadings(const Solution& solution, const Dataset& dataset) {
  double wrong = 0.0;
  auto point = dataset.truth.begin();
  for (std::size_t k = 0; k < solution.states.size(); ++k) {
    const State& x = solution.states[k];
    while (point + 1 != dataset.truth.end() && (point + 1)->t <= x.t) ++point;
    const double e =
        WrapAngle(x.euler().z() - EulerFromQuaternion(*point->q_nb).z());
    const double variance = solution.covariances.Get(k)(8, 8);
    if (e * e > 25.0 * variance) wrong += 1.0;
  }
  return wrong / static_cast<double>(solution.states.size());
}

TEST(ClockChoice, AnUnknownClockOfASteadyCircleIsNotTakenForKnown) {
  const int seeds = testing::SeedCount(4, 40);
  for (int seed = 0; seed < seeds; ++seed) {
    const auto s = static_cast<std::uint64_t>(43000 + seed);
    Dataset dataset = Simulate(SteadyCircle(), s);
    dataset.streams[0].clock_unknown = true;
    const Solution solution = Solve(dataset, {});
    if (solution.grade != Grade::kUsable) continue;
    EXPECT_LE(WrongHeadings(solution, dataset), 0.05)
        << "seed " << s << ": " << solution.verdict;
  }
}

/// Every swing like the one before: turned round and half a period later only
/// the prior of the clock tells.
TEST(ClockChoice, PerfectlyPeriodicFlightsHaveARival) {
  const Dataset dataset = LateShuttle(Irregular(0.0), 21, 0.3, 0.5);
  const Solution solution = Solve(dataset, {});
  ASSERT_FALSE(solution.rivals.empty());
  const RivalSolution& rival = solution.rivals.front();
  EXPECT_GT(rival.probability, 0.01);
  EXPECT_LE(rival.probability, 0.5);
  ASSERT_EQ(rival.differences.size(), 2u) << rival.description;
  EXPECT_EQ(rival.differences[0].quantity, "gnss_time_offset");
  EXPECT_NEAR(std::abs(rival.differences[0].value),
              0.5 * ShuttleOptions().period, 0.1);
  EXPECT_EQ(rival.differences[1].quantity, "heading");
  EXPECT_NEAR(std::abs(rival.differences[1].value), kPi, 20.0 * kDegree);
  EXPECT_NE(rival.description.find("clock of gnss 1.3"), std::string::npos)
      << rival.description;
  EXPECT_NE(rival.description.find("heading turned by"), std::string::npos);
  EXPECT_TRUE(rival.final_state);
}

TEST(ClockChoice, AnUnknownClockIsFoundAMinuteOff) {
  Scenario scenario = FindScenario("short_drive");
  Dataset dataset = Simulate(scenario, 4);
  for (AidingStream& stream : dataset.streams) {
    Delay(60.0, &stream);
    stream.clock_unknown = true;
  }
  const Solution solution = Solve(dataset, {});
  for (const char* name : {"gnss_time_offset", "gnss_velocity_time_offset"}) {
    const ConstantEstimate& offset = Constant(solution, name);
    EXPECT_NEAR(offset.value, -60.0, 4.0 * offset.sigma + 1e-3) << name;
    EXPECT_LT(offset.sigma, 0.1) << name;
  }
  EXPECT_NE(solution.grade, Grade::kUnusable) << solution.verdict;
  EXPECT_LT(RivalShare(solution), 1e-3);
  EXPECT_LT(HeadingError(solution, dataset), 2.0 * kDegree);
}

TEST(ClockChoice, AnUnknownClockAtRestIsRefusedByName) {
  Scenario scenario = FindScenario("short_drive");
  scenario.segments = {Segment::Stop(60.0)};
  Dataset dataset = Simulate(scenario, 4);
  dataset.streams[0].clock_unknown = true;
  try {
    Solve(dataset, {});
    FAIL() << "was solved";
  } catch (const EstimationError& error) {
    EXPECT_STREQ(error.what(),
                 "where the clock of gnss stands is not found: its readings "
                 "and the IMU have no motion in common that tells it");
  }
}

MarginalLikelihood LikelihoodOf(double position_sigma, double imu_factor) {
  Scenario scenario = ShuttleFlight({}, 5);
  scenario.imu.noise.gyro_noise_density *= imu_factor;
  scenario.imu.noise.accel_noise_density *= imu_factor;
  scenario.aiding[0].sigma.emplace().setConstant(position_sigma);
  const Dataset dataset = Simulate(scenario, 5);
  ForwardStage stage(dataset, {});
  stage.Run();
  const std::vector<State>& nominal = stage.smoothed().states;
  const GateDecisions used(stage.timeline().all_measurements().size(), 1);
  Problem problem = stage.problem();
  problem.prior = PriorOfComparison(dataset, stage.problem(), nominal.front());
  return MarginalLikelihoodOf(std::move(problem), nominal, used,
                              LikelihoodParts::kWithNoise);
}

/// What two predictions have of the IMU's noise: nothing of an exact one; all
/// that positions can show, less what start and biases take up, where they are
/// exact themselves.
TEST(MarginalLikelihood, CountsWhatTheMeasurementsKnowOfTheImuNoise) {
  const MarginalLikelihood exact_imu = LikelihoodOf(0.1, 1e-4);
  EXPECT_LT(exact_imu.imu_noise, 1.0);
  EXPECT_GE(exact_imu.imu_noise, 0.0);
  const MarginalLikelihood usual = LikelihoodOf(0.1, 1.0);
  EXPECT_GT(usual.imu_noise, 20.0);
  EXPECT_LT(usual.imu_noise, 100.0);
  const MarginalLikelihood exact_fixes = LikelihoodOf(1e-6, 1.0);
  constexpr double kStartAndBiases = 15.0;
  EXPECT_LE(exact_fixes.imu_noise, exact_fixes.rows);
  EXPECT_GT(exact_fixes.imu_noise, exact_fixes.rows - kStartAndBiases - 1.0);
}

TEST(MarginalLikelihood, WhitensAsManyInnovationsAsItCounts) {
  const MarginalLikelihood usual = LikelihoodOf(0.1, 1.0);
  double rows = 0.0, squares = 0.0;
  for (const auto& [measurement, innovation] : usual.whitened) {
    rows += static_cast<double>(innovation.size());
    squares += innovation.squaredNorm();
  }
  EXPECT_EQ(rows, usual.rows);
  EXPECT_NEAR(squares, usual.squares, 1e-6 * squares);
}

/// The likelihood that is kept of the chosen one is that beside the rival's
/// measurements.
TEST(ChosenExplanation, ComparesOneAfterTheOtherAsEachByItself) {
  const Dataset dataset = Simulate(FindScenario("short_drive"), 4);
  ForwardStage chosen(dataset, {});
  chosen.Run();
  ReconstructionOptions shorter;
  shorter.to = dataset.imu.t_end() - 10.0;
  const Explained of_chosen = {chosen.problem(), chosen.smoothed().states};
  ChosenExplanation comparison(dataset, of_chosen);
  for (const auto& options : {ReconstructionOptions(), shorter, shorter}) {
    Dataset late = dataset;
    for (AidingStream& stream : late.streams) Delay(0.5, &stream);
    ForwardStage rival(late, options, chosen.start());
    const std::vector<State> states = rival.SmoothedStates();
    const Explained of_rival = {rival.problem(), states};
    EXPECT_EQ(comparison.LogEvidenceRatio(of_rival),
              LogEvidenceRatio(dataset, of_rival, of_chosen));
  }
}

TEST(ForwardStage, SmoothedStatesAreThoseOfARun) {
  const Dataset dataset = Simulate(FindScenario("short_drive"), 4);
  ForwardStage run(dataset, {});
  run.Run();
  ForwardStage stage(dataset, {}, run.start());
  const std::vector<State> states = stage.SmoothedStates();
  ASSERT_EQ(states.size(), run.smoothed().states.size());
  for (std::size_t k = 0; k < states.size(); ++k) {
    EXPECT_EQ(states[k].p_e, run.smoothed().states[k].p_e) << k;
    EXPECT_EQ(states[k].q_eb.coeffs(), run.smoothed().states[k].q_eb.coeffs())
        << k;
  }
  EXPECT_EQ(stage.problem().decisions, run.problem().decisions);
  const std::vector<State> rested = stage.RestedStates(states);
  ASSERT_EQ(rested.size(), run.relinearised().states.size());
  for (std::size_t k = 0; k < rested.size(); ++k) {
    EXPECT_EQ(rested[k].p_e, run.relinearised().states[k].p_e) << k;
  }
}

}  // namespace
}  // namespace hindsight
