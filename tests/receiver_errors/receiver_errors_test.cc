#include "receiver_errors/receiver_errors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/random.h"
#include "base/units.h"
#include "earth/wgs84.h"
#include "filters/forward_filter.h"
#include "measurements/height_fix.h"
#include "measurements/magnetic_field.h"
#include "receiver_errors/mode_sequence.h"
#include "receiver_errors/onset.h"
#include "receiver_errors/sensor_findings.h"
#include "receiver_errors/sequence_smoother.h"
#include "support/test_problem.h"

namespace hindsight {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::MakeProblem;
using ::testing::Not;
using ::testing::StartsWith;
using testing::TacticalNoise;
using testing::TestProblem;
using testing::TestProblemOptions;
using testing::TypicalLayout;

TestProblem FixesOfOneMinute(double spacing = 1.0,
                             double velocity_sigma = 0.0) {
  TestProblemOptions options;
  options.spacing = spacing;
  options.noise = TacticalNoise(true);
  options.layout = TypicalLayout(options.noise);
  options.errors = true;
  options.duration = 60.0;
  options.position_sigma = 0.5;
  options.velocity_sigma = velocity_sigma;
  return MakeProblem(options, 3);
}

/// Of the positions alone.
ReceiverErrors FindThem(const Problem& problem, const LinearTape& tape) {
  std::vector<ReceiverErrors> all =
      FindReceiverErrors(problem, tape, {.known = {1}});
  return std::move(all.at(0));
}

/// As decided before.
ReceiverErrors TakeThem(const ErrorDecisions& decisions, const Problem& problem,
                        const LinearTape& tape) {
  const DecidedErrors decided = {
      std::make_shared<const ErrorDecisions>(decisions)};
  std::vector<ReceiverErrors> all = FindReceiverErrors(
      problem, tape, {.decided = &decided, .go_on = [](double) -> bool {
                        throw std::logic_error("searched anew");
                      }});
  return std::move(all.at(0));
}

/// What is found about the true trajectory, and the problem extended by it.
struct Found {
  explicit Found(const TestProblem& test)
      : problem(test.Pose(GateDecisions(test.measurements.size(), 1))),
        tape(RunLinearizedFilter(test.truth, &problem)),
        errors(FindThem(problem, tape)) {
    if (errors.Stands()) errors.Extend(&problem);
  }

  Problem problem;
  LinearTape tape;
  ReceiverErrors errors;
};

TEST(ReceiverErrors, OfFixesAsStatedDoNotStand) {
  const TestProblem test = FixesOfOneMinute();
  const Found found(test);
  EXPECT_FALSE(found.errors.Stands());
  EXPECT_EQ(found.errors.log_gain(), 0.0);
  EXPECT_THAT(found.errors.Notes(
                  CovarianceSeries(found.tape.dim(), found.tape.size()))[0],
              HasSubstr("errors as stated"));
  EXPECT_TRUE(found.errors.Doubts().empty());
}

TEST(ReceiverErrors, OfABiasedStretchBecomeStates) {
  TestProblem test = FixesOfOneMinute();
  for (Measurement& z : test.measurements) {
    if (z.t < 20.5 || z.t > 40.5) continue;
    auto& fix = std::get<PositionFix>(z.model);
    fix.p_e += NedAxes(fix.p_e) * Eigen::Vector3d(30.0, -20.0, 10.0);
  }
  const Found found(test);
  ASSERT_TRUE(found.errors.Stands());
  EXPECT_GT(found.errors.log_gain(), 100.0);
  const ErrorLayout& layout = found.problem.layout;
  ASSERT_TRUE(layout.Has(BlockKind::kSensorError, 0));
  EXPECT_GE(layout.dim(), test.layout.dim() + 3);
  EXPECT_EQ(found.problem.prior.P.rows(), layout.dim());

  const ModePart modes = found.errors.Modes();
  const std::vector<double> trust = found.errors.Trust();
  ASSERT_EQ(modes.probabilities.size(), test.truth.size());
  EXPECT_LT(trust[30], 0.01);
  EXPECT_GT(trust[10], 0.9);
  EXPECT_NEAR(modes.probabilities[30].sum(), 1.0, 1e-9);

  EXPECT_TRUE(found.errors.Doubts().empty());

  const std::vector<State> states = found.errors.States(layout);
  EXPECT_LT((states[30].p_e - test.truth[30].p_e).norm(), 3.0);
  const Block& e = *layout.Find(BlockKind::kSensorError, 0);
  EXPECT_NEAR(states[30].parameters(e.parameter_offset), 30.0, 3.0);
}

/// A jump of ten sigmas of a fix behind a gap of three seconds, over which the IMU as
/// stated drifts by a metre: what it states is the amplitude of a vibration, which
/// integrates to nothing.
TEST(ReceiverErrors, ShowBesideAnImuThatIsBetterThanStated) {
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.noise.accel_noise_density = 0.3;
  options.noise.gyro_noise_density = 8e-3;
  options.layout = TypicalLayout(options.noise);
  options.duration = 40.0;
  options.spacing = 0.5;
  options.position_sigma = 0.1;
  options.velocity_sigma = 0.0;
  TestProblem test = MakeProblem(options, 3);
  Random random(11);
  GateDecisions used;
  for (Measurement& z : test.measurements) {
    auto& fix = std::get<PositionFix>(z.model);
    Eigen::Vector3d e_n = 0.1 * random.NormalVector3();
    if (z.t > 13.0 && z.t < 27.0) e_n += Eigen::Vector3d(1.0, 1.0, 0.0);
    fix.p_e += NedAxes(fix.p_e) * e_n;
    const bool gap = (z.t > 11.2 && z.t < 14.2) || (z.t > 25.2 && z.t < 28.2);
    used.push_back(static_cast<char>(!gap));
  }
  Problem problem = test.Pose(used);
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  const ReceiverErrors errors = FindThem(problem, tape);
  ASSERT_TRUE(errors.Stands());
  const CovarianceSeries P(tape.dim(), tape.size());
  EXPECT_THAT(errors.Notes(P)[0], HasSubstr("beside noise of the IMU 0.0"));
  errors.Extend(&problem);
  const std::vector<State> states = errors.States(problem.layout);
  for (std::size_t k = 0; k < states.size(); ++k) {
    EXPECT_LT((states[k].p_e - test.truth[k].p_e).norm(), 0.5) << k;
  }
}

/// Two bad ones of a second's five are in no average of a second, but they are in
/// the problem that is solved.
TEST(ReceiverErrors, OfFastFixesMayBeOutliersAlone) {
  TestProblem test = FixesOfOneMinute(0.2);
  EXPECT_FALSE(Found(test).errors.Stands());
  for (const std::size_t k : {61u, 62u, 123u, 124u, 200u}) {
    auto& fix = std::get<PositionFix>(test.measurements[k].model);
    fix.p_e += NedAxes(fix.p_e) * Eigen::Vector3d(15.0, -10.0, 0.0);
  }
  const Found found(test);
  ASSERT_TRUE(found.errors.Stands());
  EXPECT_GT(found.errors.log_gain(), 100.0);
  EXPECT_THAT(found.errors.Notes(
                  CovarianceSeries(found.tape.dim(), found.tape.size()))[0],
              HasSubstr("white errors"));
  EXPECT_EQ(found.problem.layout.dim(), test.layout.dim());
  EXPECT_EQ(found.problem.timeline.sensors()[0].loss.kind,
            RobustLoss::Kind::kMixture);
}

/// Change points of seconds are moved to fixes, and the noise is that of the fixes about
/// the moved ones: what lies between would be taken for outliers.
TEST(ReceiverErrors, OfFastFixesLeaveThemTheirNoise) {
  TestProblem test = FixesOfOneMinute(0.2);
  for (Measurement& z : test.measurements) {
    if (z.t < 20.5 || z.t >= 40.3) continue;
    auto& fix = std::get<PositionFix>(z.model);
    fix.p_e += NedAxes(fix.p_e).col(0) * (8.0 * (z.t - 20.5));
  }
  const Found found(test);
  ASSERT_TRUE(found.errors.Stands());
  EXPECT_THAT(found.errors.InWords(), HasSubstr("drifting from 20.6 to 40.4"));
  const RobustLoss& loss = found.problem.timeline.sensors()[0].loss;
  EXPECT_LT(loss.outlier_share, 0.03);
  const auto& fix = std::get<PositionFix>(
      found.problem.timeline.all_measurements().front().model);
  EXPECT_LT(std::sqrt(fix.R_n(0, 0)), 1.15 * 0.5);
}

/// That it is the fixes behind the jump that are wrong, nothing tells.
TEST(ReceiverErrors, OfALoneSensorToItsLastFixAreDoubtful) {
  TestProblem test = FixesOfOneMinute();
  for (Measurement& z : test.measurements) {
    if (z.t < 40.5) continue;
    auto& fix = std::get<PositionFix>(z.model);
    fix.p_e += NedAxes(fix.p_e) * Eigen::Vector3d(30.0, -20.0, 10.0);
  }
  const Found found(test);
  ASSERT_TRUE(found.errors.Stands());
  const std::vector<Evidence> doubts = found.errors.Doubts();
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_EQ(doubts[0].grade, Grade::kDoubtful);
  EXPECT_THAT(doubts[0].what, HasSubstr("errs from 41 to 60 s"));
  EXPECT_NEAR(doubts[0].value.value(),
              kEndsOfAnError * (1.0 - 2.0 * 19.0 / 60.0), 0.1);
}

void AddStep(double from, TestProblem* test, double factor = 1.0) {
  for (Measurement& z : test->measurements) {
    if (z.t < from) continue;
    auto& fix = std::get<PositionFix>(z.model);
    fix.p_e += NedAxes(fix.p_e) * (factor * Eigen::Vector3d(30.0, -20.0, 10.0));
  }
}

/// Of a step of 37.4 m in the middle: good before it and biased behind it; or,
/// `behind` less likely in the logarithm, the other way about.
ErrorDecisions TwoTellings(const Problem& problem, const LinearTape& tape,
                           double behind, int sensor = 0, double step = 30.5) {
  ErrorDecisions decisions(problem, tape, sensor);
  decisions.choice.chosen = 1;
  decisions.regimes.kind = ErrorRegimes::Kind::kSwitching;
  Hypothesis one;
  one.parameters.sigma = 30.0;
  one.parameters.tau = 1e8;
  one.sequence.resize(tape.size());
  Hypothesis other = one;
  for (std::size_t i = 0; i < tape.size(); ++i) {
    const bool later = tape.t(i) > step;
    (later ? one : other).sequence[i].mode = ErrorMode::kBiased;
  }
  one.sequence[static_cast<std::size_t>(std::ceil(step))].anew = true;
  other.sequence[0].anew = true;
  other.log_posterior = -behind;
  decisions.regimes.hypotheses = {one, other};
  return decisions;
}

struct Averaged {
  std::optional<Evidence> doubt;
  double off = 0.0;       ///< at 10 s [m]
  double variance = 0.0;  ///< there, north, beyond one of 1 m^2
};

struct Telling {
  double behind = 0.0;       ///< of the other; infinite: there is none
  double step = 30.5;        ///< [s]
  bool at_start = false;     ///< the chosen one errs before the step
  double start_sigma = 1e4;  ///< of the position a priori, an axis [m]
  double factor = 1.0;       ///< on the step
  double sigma = 1.0;        ///< of the chosen solution, an axis [m]
};

Averaged AverageTellings(const Telling& asked) {
  TestProblem test = FixesOfOneMinute();
  test.prior.P.topLeftCorner<3, 3>() =
      Eigen::Matrix3d::Identity() * asked.start_sigma * asked.start_sigma;
  AddStep(asked.step, &test, asked.factor);
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  ErrorDecisions tellings =
      TwoTellings(problem, tape, asked.behind, 0, asked.step);
  std::vector<Hypothesis>& both = tellings.regimes.hypotheses;
  if (asked.at_start) std::swap(both[0], both[1]);
  if (std::isinf(asked.behind)) both.pop_back();
  both.front().log_posterior = 0.0;
  const ReceiverErrors errors = TakeThem(tellings, problem, tape);
  errors.Extend(&problem);
  std::vector<State> states = errors.States(problem.layout);
  const int dim = problem.layout.dim();
  CovarianceSeries P(dim, states.size());
  for (std::size_t k = 0; k < states.size(); ++k) {
    P.Set(k, ErrorMatrix(asked.sigma * asked.sigma *
                         ErrorMatrix::Identity(dim, dim)));
  }
  Averaged out;
  out.doubt = errors.Average(problem.layout, &states, &P);
  out.off = (states[10].p_e - test.truth[10].p_e).norm();
  out.variance = P.Get(10)(0, 0) - asked.sigma * asked.sigma;
  return out;
}

/// Probabilities of 62 and 38 %.
TEST(ReceiverErrors, ThatAreAboutAsLikelyInTwoWaysGiveTheMean) {
  const Averaged mean = AverageTellings({.behind = 0.5});
  ASSERT_TRUE(mean.doubt.has_value());
  EXPECT_EQ(mean.doubt->grade, Grade::kDoubtful);
  EXPECT_THAT(mean.doubt->what, StartsWith("38 % likely up to "));
  EXPECT_NEAR(mean.off, 0.38 * 37.4, 2.0);
  EXPECT_NEAR(mean.variance, 0.38 * 0.62 * 900.0, 30.0);
}

/// 1.1 m are many sigmas of the solution, but little for fixes of 0.5 m: the mean,
/// whose covariance holds both, needs no doubt.
TEST(ReceiverErrors, ThatAreSmallGiveTheMeanWithoutDoubt) {
  const Averaged mean =
      AverageTellings({.behind = 0.5, .factor = 0.03, .sigma = 0.1});
  EXPECT_FALSE(mean.doubt.has_value());
  EXPECT_NEAR(mean.off, 0.38 * 1.1, 0.3);
  EXPECT_NEAR(mean.variance, 0.38 * 0.62 * 0.81, 0.1);
}

/// Probabilities of 95 and 5 %, by the search and by the roles exchanged.
TEST(ReceiverErrors, OfWhichOneIsFarLikelierAreNoMean) {
  const Averaged likelier = AverageTellings({.behind = 3.0, .step = 45.5});
  EXPECT_FALSE(likelier.doubt.has_value());
  EXPECT_LT(likelier.off, 2.0);
  EXPECT_NEAR(likelier.variance, 0.05 * 900.0, 10.0);
}

/// One per cent, of which 36 m are ten sigmas of the widened covariance, spoils what
/// is stated; one in three thousand is none to speak of.
TEST(ReceiverErrors, OfARivalBeyondTheCovariancesAreDoubtful) {
  const Averaged beyond =
      AverageTellings({.behind = 4.6, .step = 45.5, .start_sigma = 10.0});
  ASSERT_TRUE(beyond.doubt.has_value());
  EXPECT_EQ(beyond.doubt->grade, Grade::kDoubtful);
  EXPECT_THAT(beyond.doubt->what, StartsWith("1 % likely up to 36"));
  EXPECT_THAT(beyond.doubt->what, Not(HasSubstr("mean")));
  EXPECT_LT(beyond.off, 2.0);
  EXPECT_FALSE(
      AverageTellings({.behind = 8.0, .step = 45.5, .start_sigma = 10.0})
          .doubt.has_value());
}

constexpr double kOneAlone = std::numeric_limits<double>::infinity();

/// What a priori speaks for an error of the share that it has at the end of a
/// recording, against one of the rest of it at its begin.
double ProbabilityOfExchange(double share, bool at_start) {
  const double well = LogOddsOfBeginningWell();
  const double log_odds =
      kEndsOfAnError * (1.0 - 2.0 * share) + (at_start ? -well : well);
  return 1.0 / (1.0 + std::exp(log_odds));
}

/// The search met one telling alone: the other one has its probability
/// nevertheless.
TEST(ReceiverErrors, WithTheirRolesExchangedAreARival) {
  const Averaged half = AverageTellings({.behind = kOneAlone, .step = 30.5});
  const double p = ProbabilityOfExchange(29.0 / 60.0, false);
  ASSERT_TRUE(half.doubt.has_value());
  EXPECT_NEAR(half.off, p * 37.4, 1.5);
  EXPECT_NEAR(half.variance, p * (1.0 - p) * 900.0, 30.0);

  const Averaged third = AverageTellings({.behind = kOneAlone, .step = 40.5});
  const double p3 = ProbabilityOfExchange(19.0 / 60.0, false);
  EXPECT_FALSE(third.doubt.has_value());
  EXPECT_LT(third.off, 2.0);
  EXPECT_NEAR(third.variance, p3 * 900.0, 10.0);
}

/// What is said to err from the first fix on leaves the whole trajectory to what
/// follows: the mean is taken whatever the odds, as long as they are doubtful.
TEST(ReceiverErrors, ThatErrFromTheFirstFixGiveTheMean) {
  const Averaged quarter =
      AverageTellings({.behind = kOneAlone, .step = 15.5, .at_start = true});
  const double p = ProbabilityOfExchange(15.0 / 60.0, true);
  ASSERT_TRUE(quarter.doubt.has_value());
  EXPECT_NEAR(quarter.off, (1.0 - p) * 37.4, 2.0);
}

/// A start that is known decides: to 10 m, a step of 37 m tells its side.
TEST(ReceiverErrors, OfAKnownStartHaveNoExchangedRoles) {
  const Averaged known =
      AverageTellings({.behind = kOneAlone, .step = 30.5, .start_sigma = 10.0});
  EXPECT_FALSE(known.doubt.has_value());
  EXPECT_LT(known.off, 2.0);
  EXPECT_LT(known.variance, 5.0);
}

/// Of two receivers that agree nowhere one has jumped: which one is off before that only
/// what is known of the start tells.
TEST(ReceiverErrors, ThroughoutBesideOneOtherMayBeThoseOfTheOther) {
  for (const double start_sigma : {1e4, 1.0}) {
    TestProblem test = FixesOfOneMinute();
    test.prior.P.topLeftCorner<3, 3>() =
        Eigen::Matrix3d::Identity() * start_sigma * start_sigma;
    AddStep(-1.0, &test, 0.5);
    AddStep(10.5, &test);
    Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
    const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
    ErrorDecisions decisions = TwoTellings(problem, tape, 0.0, 0, 10.5);
    std::vector<Hypothesis>& all = decisions.regimes.hypotheses;
    all.pop_back();
    for (ErrorStep& step : all.front().sequence) step.mode = ErrorMode::kBiased;
    all.front().sequence.front().anew = true;
    decisions.alone = false;
    const auto doubt_of = [&] {
      const ReceiverErrors errors = TakeThem(decisions, problem, tape);
      EXPECT_EQ(errors.Doubts().size(),
                !decisions.beside.empty() && start_sigma > 100.0 ? 1u : 0u);
      Problem extended = problem;
      errors.Extend(&extended);
      std::vector<State> states = errors.States(extended.layout);
      CovarianceSeries P(extended.layout.dim(), states.size());
      for (std::size_t k = 0; k < states.size(); ++k) {
        P.Set(k, ErrorMatrix(ErrorMatrix::Identity(extended.layout.dim(),
                                                   extended.layout.dim())));
      }
      return errors.Average(extended.layout, &states, &P);
    };
    EXPECT_FALSE(doubt_of().has_value());
    decisions.beside = "right";
    const std::optional<Evidence> doubt = doubt_of();
    ASSERT_EQ(doubt.has_value(), start_sigma > 100.0);
    if (doubt) {
      EXPECT_THAT(doubt->what,
                  AllOf(StartsWith("1.2 % likely up to 18 m off: "),
                        HasSubstr("; or else biased from 11 s to the end")));
    }
  }
}

/// Of two sensors one is right before the step and one behind it.
TEST(ReceiverErrors, ThatAreAboutAsLikelyOfAnotherSensorGiveTheMean) {
  TestProblem test = FixesOfOneMinute();
  test.prior.P.topLeftCorner<3, 3>() *= 1e8;
  AddStep(30.5, &test);
  const Problem posed = test.Pose(GateDecisions(test.measurements.size(), 1));
  Problem problem = posed;
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  ErrorDecisions tellings = TwoTellings(problem, tape, 0.0);
  std::vector<Hypothesis>& both = tellings.regimes.hypotheses;
  ErrorDecisions other = tellings;
  other.regimes.hypotheses.erase(other.regimes.hypotheses.begin());
  both.pop_back();
  const ReceiverErrors one = TakeThem(tellings, problem, tape);
  const ReceiverErrors rival = TakeThem(other, problem, tape);
  one.Extend(&problem);
  const Block* e = problem.layout.Find(BlockKind::kSensorError, 0);
  ASSERT_NE(e, nullptr);
  // Two sensors of which neither is likely enough by itself may be together.
  const std::vector<std::vector<double>> all = {{0.4}, {0.1}, {0.2, 0.2}};
  for (const std::vector<double>& probabilities : all) {
    std::vector<State> states = one.States(problem.layout);
    const double error = states[45].parameters(e->parameter_offset);
    CovarianceSeries P(problem.layout.dim(), states.size());
    std::vector<RivalSensor> rivals;
    double probability = 0.0;
    for (const double of_one : probabilities) {
      rivals.push_back({&rival, of_one});
      probability += of_one;
    }
    one.AverageWith(rivals, problem.layout, &states, &P);
    const double moved = probability > 0.3 ? probability : 0.0;
    EXPECT_NEAR((states[10].p_e - test.truth[10].p_e).norm(), moved * 37.4,
                2.0);
    EXPECT_NEAR(states[45].parameters(e->parameter_offset),
                (1.0 - moved) * error, 1e-9);
    EXPECT_NEAR(P.Get(10)(0, 0), (1.0 - moved) * probability * 900.0, 30.0);
  }
}

/// A whole-interval problem takes complete blocks alone.
TEST(ReceiverErrors, OfASensorOfOneRowHaveACompleteBlock) {
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.layout = TypicalLayout(options.noise);
  options.duration = 60.0;
  TestProblem test = MakeProblem(options, 3);
  test.sensors[1].kind = &HeightKind();
  for (Measurement& z : test.measurements) {
    if (z.sensor != 1) continue;
    HeightFix height;
    const auto k = static_cast<std::size_t>(std::lround(z.t));
    height.height =
        GeodeticFromEcef(test.truth[k].p_e).height + (z.t > 30.5 ? 50.0 : 0.0);
    z.model = height;
  }
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  const ReceiverErrors errors =
      TakeThem(TwoTellings(problem, tape, 3.0, 1), problem, tape);
  errors.Extend(&problem);
  const Block* e = problem.layout.Find(BlockKind::kSensorError, 1);
  ASSERT_NE(e, nullptr);
  EXPECT_EQ(e->dim, 3);
  const std::vector<State> states = errors.States(problem.layout);
  EXPECT_NEAR(states[45].parameters(e->parameter_offset), 50.0, 3.0);
}

/// Two minutes of a drive whose compass is 40 deg off from 50 to 80 s, by something on
/// the vehicle.
TestProblem DisturbedCompass(MagneticField::Form form) {
  constexpr double kSigma = 0.5;  // [uT]
  TestProblemOptions options;
  options.noise = TacticalNoise(true);
  options.layout = TypicalLayout(options.noise);
  options.errors = true;
  options.duration = 120.0;
  options.position_sigma = 0.5;
  TestProblem test = MakeProblem(options, 3);
  Sensor& compass = test.sensors[1];
  compass.kind = &MagnetometerKind();
  compass.magnetic.horizontal = 20.0;
  compass.magnetic.down = 40.0;
  const Eigen::Vector3d m_n = UndisturbedField(compass.magnetic, 0.0);
  Random random(7);
  for (Measurement& z : test.measurements) {
    if (z.sensor != 1) continue;
    const State& x = test.truth[static_cast<std::size_t>(std::lround(z.t))];
    const double turn = z.t > 49.5 && z.t < 80.5 ? 40.0 * kDegree : 0.0;
    const Eigen::AngleAxisd off(turn, Eigen::Vector3d::UnitZ());
    z.model =
        MagneticField{x.q_eb.conjugate() * (NedAxes(x.p_e) * (off * m_n)) +
                          kSigma * random.NormalVector3(),
                      kSigma, form};
  }
  return test;
}

/// A compass that something on the vehicle turns is the sensor that errs, not the
/// receiver that it contradicts.
TEST(ReceiverErrors, OfACompassAreFound) {
  for (const auto form :
       {MagneticField::Form::kHeading, MagneticField::Form::kVector}) {
    const TestProblem test = DisturbedCompass(form);
    Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
    const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
    const std::vector<ReceiverErrors> found =
        FindReceiverErrors(problem, tape, {});
    ASSERT_EQ(found.size(), 2u);
    ASSERT_TRUE(found[0].Stands());
    EXPECT_EQ(found[0].sensor(), 1);
    const std::vector<double> changes = found[0].ChangeTimes();
    ASSERT_GE(changes.size(), 2u) << found[0].InWords();
    EXPECT_NEAR(changes.front(), 50.0, 0.5) << found[0].InWords();
    EXPECT_NEAR(changes.back(), 81.0, 0.5) << found[0].InWords();
    CovarianceSeries P(tape.dim(), tape.size());
    for (std::size_t k = 0; k < tape.size(); ++k) {
      P.Set(k, ErrorMatrix::Identity(tape.dim(), tape.dim()));
    }
    EXPECT_THAT(found[0].Notes(P),
                Contains(HasSubstr(
                    form == MagneticField::Form::kHeading ? "rad" : "uT")));
  }
}

/// The first node has no fix: the receiver errs from the first fix on.
TEST(ReceiverErrors, FromTheFirstFixAreDoubtful) {
  TestProblem test = FixesOfOneMinute();
  test.prior.P.topLeftCorner<3, 3>() *= 1e6;
  AddStep(30.5, &test);
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  problem.decisions.front() = 0;
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  ErrorDecisions decisions = TwoTellings(problem, tape, 0.0);
  Hypothesis other = decisions.regimes.hypotheses.back();
  other.sequence.erase(other.sequence.begin());
  other.sequence.front().anew = true;
  decisions.regimes.hypotheses = {other};
  const ReceiverErrors errors = TakeThem(decisions, problem, tape);
  const std::vector<Evidence> doubts = errors.Doubts();
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_THAT(doubts[0].what, HasSubstr("errs from 0 to 30 s"));
}

TEST(ReceiverErrors, FromTheFirstFixToTheLastAreDoubtful) {
  TestProblem test = FixesOfOneMinute();
  test.prior.P.topLeftCorner<3, 3>() *= 1e6;
  AddStep(30.5, &test);
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  ErrorDecisions decisions = TwoTellings(problem, tape, 0.0);
  Hypothesis both = decisions.regimes.hypotheses.back();
  for (ErrorStep& step : both.sequence) step.mode = ErrorMode::kBiased;
  both.sequence[31].anew = true;
  decisions.regimes.hypotheses = {both};
  const std::vector<Evidence> doubts =
      TakeThem(decisions, problem, tape).Doubts();
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_EQ(doubts[0].grade, Grade::kDoubtful);
  EXPECT_THAT(doubts[0].what, HasSubstr("errs from its first fix to its last"));
}

/// Noise that stands, beside which errors of other fixes than the tape's were as likely.
TEST(ReceiverErrors, UndecidedOfOtherFixesAreSearchedAnew) {
  const TestProblem test = FixesOfOneMinute();
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  ErrorDecisions decisions = *FindThem(problem, tape).Decisions();
  ASSERT_FALSE(decisions.stands());
  decisions.undecided = {Hypothesis{ModeSequence(61)}};
  EXPECT_EQ(decisions.likeliest_noise.sequence.size(), 61u);
  EXPECT_TRUE(TakeThem(decisions, problem, tape).IsUndecided());
  decisions.undecided = {Hypothesis{ModeSequence(3)}};
  EXPECT_THROW(TakeThem(decisions, problem, tape), std::logic_error);
}

/// Of two that noise is hardly likelier than, the one that leads elsewhere.
TEST(ReceiverErrors, ThatNoiseDoesNotRuleOutAreDoubtfulWhereTheyLeadElsewhere) {
  TestProblem test = FixesOfOneMinute();
  AddStep(30.5, &test, 0.2);
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  ErrorDecisions decisions(problem, tape, 0);
  decisions.likeliest_noise = {ModeSequence(61)};
  decisions.likeliest_noise.parameters.outlier_share = 0.0;
  Hypothesis throughout{ModeSequence(61, {.mode = ErrorMode::kBiased})};
  throughout.sequence.front().anew = true;
  throughout.parameters.tau = 20.0;
  throughout.parameters.outlier_share = 0.0;
  throughout.log_posterior = -2.0;
  Hypothesis hardly = throughout;
  hardly.parameters.sigma = 1e-3;
  throughout.parameters.sigma = 10.0;
  CovarianceSeries P(tape.dim(), tape.size());
  for (std::size_t k = 0; k < tape.size(); ++k) {
    P.Set(k, ErrorMatrix(0.01 * ErrorMatrix::Identity(tape.dim(), tape.dim())));
  }
  decisions.undecided = {hardly};
  EXPECT_FALSE(TakeThem(decisions, problem, tape).DoubtOfNoise(P).has_value());
  decisions.undecided = {hardly, throughout};
  const ReceiverErrors errors = TakeThem(decisions, problem, tape);
  const auto doubt = errors.DoubtOfNoise(P);
  ASSERT_TRUE(doubt.has_value());
  EXPECT_THAT(doubt->what, StartsWith("12 % likely up to "));
  EXPECT_THAT(errors.Notes(P),
              Contains(HasSubstr("not ruled out, 7.4 times less likely than "
                                 "noise: Gauss-Markov errors, sigma 10 m")));
  // What leads there is noise that is likelier than what stands.
  decisions.undecided = {throughout};
  decisions.likeliest_noise = throughout;
  EXPECT_FALSE(TakeThem(decisions, problem, tape).DoubtOfNoise(P).has_value());
}

/// A slow error of all fixes, of which only the walk is seen: covariances are those of
/// the problem that is extended by what is expected of it.
TEST(ReceiverErrors, AreExpectedLargerThanTheTrajectoryIsToldBy) {
  const TestProblem test = FixesOfOneMinute();
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  ErrorDecisions decisions(problem, tape, 0);
  decisions.choice.chosen = 1;
  Hypothesis one{ModeSequence(61, {.mode = ErrorMode::kBiased})};
  one.sequence.front().anew = true;
  one.parameters.sigma = 1.0;
  one.parameters.tau = 10.0;
  one.parameters.down = 0.5;
  decisions.regimes.kind = ErrorRegimes::Kind::kGaussMarkov;
  decisions.regimes.hypotheses = {one};
  const auto extended = [&](const ErrorDecisions& by, bool is_expected) {
    Problem out = problem;
    const ReceiverErrors errors = TakeThem(by, problem, tape);
    errors.Extend(&out);
    EXPECT_EQ(errors.Expect(&out), is_expected);
    return out;
  };
  const Problem likely = extended(decisions, false);
  decisions.regimes.expected = one.parameters;
  decisions.regimes.expected->sigma = 3.0;
  decisions.regimes.expected->tau = 90.0;
  const Problem expected = extended(decisions, true);
  one.parameters = *decisions.regimes.expected;
  decisions.regimes.hypotheses = {one};
  decisions.regimes.expected.reset();
  const Problem large = extended(decisions, false);
  EXPECT_EQ(expected.prior.P, large.prior.P);
  EXPECT_GT(expected.prior.P.trace(), likely.prior.P.trace());
  const int e = expected.layout.Find(BlockKind::kSensorError, 0)->offset;
  EXPECT_EQ(expected.prior.P(e, e), 9.0);
  EXPECT_EQ(expected.prior.P(e + 2, e + 2), 2.25);
  for (std::size_t k = 0; k + 1 < tape.size(); ++k) {
    const auto a = expected.timeline.StepsAfter(k);
    const auto b = large.timeline.StepsAfter(k);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].phi, b[i].phi);
      EXPECT_EQ(a[i].variance, b[i].variance);
      EXPECT_EQ(a[i].down, b[i].down);
    }
    EXPECT_NE(a[0].phi, likely.timeline.StepsAfter(k)[0].phi);
  }
}

/// The problem gets what is expected of it, with its probability; not beside errors that
/// are there.
TEST(ReceiverErrors, ThatStayOpenExtendAProblem) {
  const TestProblem test = FixesOfOneMinute();
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  ErrorDecisions decisions(problem, tape, 0);
  Problem extended = problem;
  EXPECT_FALSE(HasOpenBias(decisions));
  EXPECT_EQ(ExtendByOpenBias(decisions, tape, &extended), 0.0);
  EXPECT_EQ(extended.layout.dim(), problem.layout.dim());
  decisions.open.emplace();
  decisions.open->log_odds = -std::log(3.0);
  decisions.open->expected.sigma = 3.0;
  decisions.open->expected.tau = 90.0;
  decisions.open->expected.down = 0.5;
  EXPECT_TRUE(HasOpenBias(decisions));
  EXPECT_NEAR(ExtendByOpenBias(decisions, tape, &extended), 0.25, 1e-12);
  const Block* error = extended.layout.Find(BlockKind::kSensorError, 0);
  ASSERT_NE(error, nullptr);
  const int e = error->offset;
  EXPECT_EQ(extended.layout.dim(), problem.layout.dim() + 3);
  EXPECT_EQ(extended.prior.P(e, e), 9.0);
  EXPECT_EQ(extended.prior.P(e + 2, e + 2), 2.25);
  const auto steps = extended.timeline.StepsAfter(0);
  const auto step = std::ranges::find(steps, error->key, &BlockStep::key);
  ASSERT_NE(step, steps.end());
  EXPECT_NEAR(step->phi, std::exp(-1.0 / 90.0), 1e-12);
  EXPECT_EQ(ExtendByOpenBias(decisions, tape, &extended), 0.0);
  EXPECT_EQ(OpenBiasInWords(decisions),
            decisions.name +
                ": covariances hold it to 25 % that beside noise there are "
                "Gauss-Markov errors of about the stated sigma, as expected "
                "sigma 3 m (1.5 down), correlation time 90 s");
}

/// What stood on averages and does not on all fixes is not ruled out by that.
TEST(ReceiverErrors, ThatAreRefusedOnAllFixesStayOpen) {
  const TestProblem test = FixesOfOneMinute();
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  const SensorTape whole(tape, 0);
  ErrorDecisions decisions(problem, tape, 0);
  decisions.choice.chosen = 1;
  Hypothesis one{ModeSequence(61, {.mode = ErrorMode::kBiased})};
  one.sequence.front().anew = true;
  one.parameters.sigma = 0.05;
  one.parameters.tau = 50.0;
  decisions.regimes.kind = ErrorRegimes::Kind::kGaussMarkov;
  decisions.regimes.hypotheses = {one};
  decisions.regimes.slight = SlightBias{one.parameters, 0.5};
  SensorFindings found(decisions, tape);
  const double gain = found.GainOn(whole);
  ASSERT_LT(std::abs(gain), 4.0);
  const std::string why = found.ObjectionOn(whole, false);
  EXPECT_THAT(why, HasSubstr("over errors as stated"));
  found.Refuse(whole, why);
  ASSERT_TRUE(found.open.has_value());
  EXPECT_NEAR(found.open->Probability(),
              1.0 / (1.0 + 3.0 * std::exp(-gain - 0.5)), 1e-12);
  EXPECT_EQ(found.open->expected.sigma, 0.05);
  EXPECT_EQ(found.choice.refused.size(), 1u);
}

/// An error that grows by 3.6 m/s from 21 to 30 s.
TestProblem WithFastDrift() {
  TestProblem test = FixesOfOneMinute();
  for (Measurement& z : test.measurements) {
    if (z.t < 20.5 || z.t > 30.5) continue;
    auto& fix = std::get<PositionFix>(z.model);
    fix.p_e += NedAxes(fix.p_e) *
               Eigen::Vector3d(2.0 * (z.t - 20.0), -3.0 * (z.t - 20.0), 0.0);
  }
  return test;
}

/// What was within its bounds on averages may end at one on all fixes.
TEST(ReceiverErrors, AtABoundOnAllFixesDoNotStand) {
  const TestProblem test = WithFastDrift();
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  const SensorTape whole(tape, 0);
  SensorFindings found(problem, tape, 0, {});
  ASSERT_TRUE(found.stands());
  EXPECT_EQ(found.ObjectionOn(whole, false), "");
  found.regimes.hypotheses.front().parameters.outlier_share = 0.4;
  EXPECT_EQ(found.ObjectionOn(whole, false),
            "have the share of outliers at its bound");
  found.regimes.hypotheses.front().parameters.outlier_share = 0.02;
  found.regimes.hypotheses.front().parameters.scale = kLeastScale;
  EXPECT_EQ(found.ObjectionOn(whole, false), "");
}

TEST(ReceiverErrors, OfAShortRecordingMayGrowFast) {
  const TestProblem test = WithFastDrift();
  const Found found(test);
  ASSERT_TRUE(found.errors.Stands());
  EXPECT_THAT(found.errors.InWords(), HasSubstr("drifting from"));
  const std::vector<State> states = found.errors.States(found.problem.layout);
  EXPECT_LT((states[28].p_e - test.truth[28].p_e).norm(), 3.0);
}

/// Of a drift that begins at 21 s, in the batch as in the search.
void ExpectGrownAt21(const GrowthMoments& grown,
                     const std::vector<State>& states, Problem* problem) {
  const LinearTape extended = RunLinearizedFilter(states, problem);
  const int e = problem->layout.Find(BlockKind::kSensorError, 0)->offset;
  const int r = problem->layout.Find(BlockKind::kErrorRate, 0)->offset;
  ASSERT_NEAR(extended.t(21), 21.0, 1e-6);
  const ErrorMatrix P = extended.P_minus(21);
  EXPECT_NEAR(P(e, e), P(r, r) * grown.square, 1e-3 * P(e, e));
  EXPECT_NEAR(P(e, r), P(r, r) * grown.by_rate, 1e-3 * P(e, r));
}

/// An error that begins where no fix sees it is one drift, not a bias that drifts on.
TEST(ReceiverErrors, MayBeginToDriftWithinAGap) {
  TestProblem test = FixesOfOneMinute();
  GateDecisions used;
  for (Measurement& z : test.measurements) {
    used.push_back(static_cast<char>(z.t < 13.5 || z.t > 20.5));
    if (z.t < 17.5 || z.t > 32.5) continue;
    auto& fix = std::get<PositionFix>(z.model);
    fix.p_e += NedAxes(fix.p_e) *
               Eigen::Vector3d(1.5 * (z.t - 17.5), -2.0 * (z.t - 17.5), 0.0);
  }
  Problem problem = test.Pose(used);
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  const ReceiverErrors errors = FindThem(problem, tape);
  ASSERT_TRUE(errors.Stands());
  EXPECT_THAT(errors.InWords(),
              AllOf(HasSubstr("drifting from"), Not(HasSubstr("biased"))));
  errors.Extend(&problem);
  const std::vector<State> states = errors.States(problem.layout);
  for (std::size_t k = 0; k < states.size(); ++k) {
    EXPECT_LT((states[k].p_e - test.truth[k].p_e).norm(), 3.0) << k;
  }
  // Eight seconds behind the fix before.
  ExpectGrownAt21(GrowthMoments::Between(0.0, 8.0), states, &problem);
}

/// In the second quarter of the second between two fixes.
TEST(ReceiverErrors, MayBeginToDriftBetweenTwoFixes) {
  constexpr double kBegin = 20.4;
  TestProblem test = FixesOfOneMinute();
  for (Measurement& z : test.measurements) {
    if (z.t < kBegin || z.t > 32.5) continue;
    auto& fix = std::get<PositionFix>(z.model);
    fix.p_e +=
        NedAxes(fix.p_e) * ((z.t - kBegin) * Eigen::Vector3d(12.0, -16.0, 0.0));
  }
  Found found(test);
  ASSERT_TRUE(found.errors.Stands());
  EXPECT_THAT(found.errors.InWords(), AllOf(HasSubstr("drifting from 21 to"),
                                            Not(HasSubstr("biased"))));
  const std::vector<State> states = found.errors.States(found.problem.layout);
  for (std::size_t k = 0; k < states.size(); ++k) {
    EXPECT_LT((states[k].p_e - test.truth[k].p_e).norm(), 1.5) << k;
  }
  ExpectGrownAt21(GrowthMoments::Between(0.5, 0.75), states, &found.problem);
}

/// A step of the IMU's velocity is seen by all that measures as a change of the vehicle's:
/// neither of them errs.
TEST(ReceiverErrors, AreNoneBesideAStepOfTheImuBetweenTwoFixes) {
  constexpr double kStep = 35.45;
  const Eigen::Vector3d dv(5.0, 2.5, 0.0);
  TestProblem test = FixesOfOneMinute(1.0, 0.1);
  for (Measurement& z : test.measurements) {
    if (z.t < kStep) continue;
    if (auto* fix = std::get_if<PositionFix>(&z.model)) {
      fix->p_e += NedAxes(fix->p_e) * ((z.t - kStep) * dv);
    } else {
      std::get<VelocityFix>(z.model).v_n += dv;
    }
  }
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  for (const ReceiverErrors& one : FindReceiverErrors(problem, tape)) {
    EXPECT_THAT(one.InWords(),
                AllOf(HasSubstr("the IMU's velocity steps at 36 s"),
                      Not(HasSubstr("biased")), Not(HasSubstr("drifting"))));
    ASSERT_TRUE(one.Stands());
    const std::vector<ToldVelocityStep> steps = one.VelocitySteps();
    ASSERT_EQ(steps.size(), 1);
    EXPECT_EQ(steps[0].step.begin, 35.0);
    EXPECT_EQ(steps[0].step.end, 36.0);
    EXPECT_GT(steps[0].step.variance, 1.0);
    EXPECT_LT(steps[0].step.variance, 100.0);
    EXPECT_LT((steps[0].size - dv).norm(), 0.1 * dv.norm());
  }
}

TEST(ReceiverErrors, BesideStepsOfAnImuThatHardlyErrsElseAreDoubtful) {
  const TestProblem test = WithFastDrift();
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  ErrorDecisions decisions = SensorFindings(problem, tape, 0, {});
  decisions.regimes.hypotheses.resize(1);
  Hypothesis& one = decisions.regimes.hypotheses.front();
  const auto is_doubtful = [&](double beside_others = 1.0) {
    const auto doubts =
        TakeThem(decisions, problem, tape).Doubts(beside_others);
    return std::ranges::any_of(doubts, [](const Evidence& doubt) {
      return doubt.what.find("the velocity of the IMU steps") !=
             std::string::npos;
    });
  };
  one.parameters.imu_scale = 0.1;
  EXPECT_FALSE(is_doubtful());
  one.sequence[45].velocity_step = true;
  EXPECT_TRUE(is_doubtful());
  one.parameters.imu_scale = 0.9;
  EXPECT_FALSE(is_doubtful());
  EXPECT_TRUE(is_doubtful(0.4));
  one.sequence[45].velocity_step = false;
  EXPECT_FALSE(is_doubtful(0.4));
}

/// A search that has no effort to find a drift begins from what another has met.
TEST(ReceiverErrors, MayBeThoseThatAnotherSearchHasMet) {
  const TestProblem test = WithFastDrift();
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  const ReceiverErrors full = FindThem(problem, tape);
  ErrorQuestion question = {.known = {1}, .share = 1e-6};
  const ReceiverErrors alone =
      FindReceiverErrors(problem, tape, question).at(0);
  EXPECT_LT(alone.log_gain(), full.log_gain() - 7.0);
  question.met = {full.Decisions()};
  const ReceiverErrors after =
      FindReceiverErrors(problem, tape, question).at(0);
  EXPECT_EQ(after.InWords(), full.InWords());
  EXPECT_NEAR(after.log_gain(), full.log_gain(), 1.0);
}

/// Steps of the IMU's velocity were of the trajectory about which they were met.
TEST(ReceiverErrors, MayBeThoseThatAnotherSearchHasMetBesideSteps) {
  constexpr std::size_t kStep = 3;  // before the drift
  const TestProblem test = WithFastDrift();
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  const ReceiverErrors full = FindThem(problem, tape);
  ErrorDecisions beside_steps = *full.Decisions();
  ASSERT_FALSE(beside_steps.met.empty());
  for (MetHypotheses& fit : beside_steps.met) {
    for (Hypothesis& one : fit) one.sequence[kStep].velocity_step = true;
  }
  const ReceiverErrors after =
      FindReceiverErrors(
          problem, tape,
          {.known = {1},
           .met = {std::make_shared<const ErrorDecisions>(beside_steps)},
           .share = 1e-6})
          .at(0);
  EXPECT_EQ(after.InWords(), full.InWords());
}

TEST(ReceiverErrors, AreWeighedWithWhatAnotherSearchHasMetAsLikely) {
  TestProblem test = FixesOfOneMinute();
  for (Measurement& z : test.measurements) {
    if (z.t < 20.5 || z.t > 40.5) continue;
    auto& fix = std::get<PositionFix>(z.model);
    fix.p_e +=
        NedAxes(fix.p_e) * Eigen::Vector3d(0.15 * (z.t - 20.0), 0.0, 0.0);
  }
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  const SensorFindings full(problem, tape, 0, {});
  const SensorFindings after(problem, tape, 0,
                             {.share = 1e-6, .go_on = nullptr}, full.met);
  const auto likely_of = [](const SensorFindings& found) {
    std::vector<ModeSequence> likely;
    for (const Hypothesis& one : LikelyOf(found.regimes)) {
      likely.push_back(one.sequence);
    }
    return likely;
  };
  EXPECT_GT(likely_of(after).size(), 1u);
  EXPECT_THAT(likely_of(after), ::testing::IsSubsetOf(likely_of(full)));
}

/// The search sees averages, of which the evidence is another: what one
/// sensor's errors explain compares with another's on the tape that both have.
TEST(ReceiverErrors, OfFastFixesExplainWhatAllOfThemSay) {
  TestProblem test = FixesOfOneMinute(0.2);
  AddStep(30.5, &test);
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  const SensorFindings found(problem, tape, 0, {});
  ASSERT_TRUE(found.stands());
  double as_stated = 0.0;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    for (const TapeMeasurement& z : tape.measurements(k)) {
      as_stated += z.log_likelihood;
    }
  }
  const Hypothesis& best = found.regimes.hypotheses.front();
  const double with_errors =
      ScoreSequence({tape, 0}, best.parameters, best.sequence).log_likelihood;
  EXPECT_NEAR(found.gain, found.log_prior + with_errors - as_stated,
              1e-6 * found.gain);
  EXPECT_GT(std::abs(found.gain - found.choice.gain), 10.0);
}

TEST(ReceiverErrors, AreTheSameAboutAnotherTapeOfTheSameFixes) {
  TestProblem test = FixesOfOneMinute();
  AddStep(50.5, &test);
  Problem problem = test.Pose(GateDecisions(test.measurements.size(), 1));
  const LinearTape tape = RunLinearizedFilter(test.truth, &problem);
  const ReceiverErrors found = FindThem(problem, tape);
  ASSERT_TRUE(found.Stands());
  const auto decisions = found.Decisions();
  const ReceiverErrors again = TakeThem(*decisions, problem, tape);
  EXPECT_EQ(again.InWords(), found.InWords());
  EXPECT_EQ(again.log_gain(), found.log_gain());
  EXPECT_EQ(again.MeanSquareDistanceTo(found), 0.0);

  Problem fewer = test.Pose(GateDecisions(test.measurements.size(), 1));
  fewer.decisions.front() = 0;
  const LinearTape other = RunLinearizedFilter(test.truth, &fewer);
  EXPECT_EQ(FindingsAgain(*decisions, other), nullptr);
}

}  // namespace
}  // namespace hindsight
