#include "evaluation/grade.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "measurements/noise_kind.h"
#include "measurements/sensor_kind.h"
#include "support/test_motion.h"

namespace hindsight {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;
using testing::TypicalLayout;
using testing::TypicalState;

/// A hundred seconds, known to 0.1 m, 0.01 m/s, 0.1 deg and 1 deg of heading,
/// with a residual of one sigma each second.
class GradeTest : public ::testing::Test {
 protected:
  GradeTest() {
    solution_.method = "batch";
    solution_.layout = TypicalLayout();
    const int dim = solution_.layout.dim();
    solution_.covariances = CovarianceSeries(dim, 101);
    ErrorVector sigma = ErrorVector::Constant(dim, 1e-4);
    sigma.segment<3>(0).setConstant(0.1);
    sigma.segment<3>(3).setConstant(0.01);
    sigma.segment<3>(6) = Eigen::Vector3d(0.1, 0.1, 1.0) * kDegree;
    for (int k = 0; k <= 100; ++k) {
      State x = TypicalState();
      x.t = k;
      solution_.states.push_back(x);
      Set(static_cast<std::size_t>(k), sigma);
      ResidualRecord record;
      record.t = k;
      record.residual = Eigen::Vector3d::Zero();
      record.nis = 3.0;
      solution_.residuals.push_back(record);
    }
    sigma_ = sigma;
    sensors_.resize(1);
    sensors_[0].name = "gnss";
  }

  void Set(std::size_t k, const ErrorVector& sigma) {
    const ErrorMatrix P = sigma.cwiseAbs2().asDiagonal();
    solution_.covariances.Set(k, P);
  }

  void ConcludeWith(const Judged& judged) { Conclude(judged, {}, &solution_); }
  void ConcludePlain() {
    ConcludeWith({.solution = solution_, .sensors = sensors_});
  }

  /// The one piece of evidence that lowers the grade.
  const Evidence& Against() const {
    const Evidence* found = nullptr;
    int count = 0;
    for (const Evidence& e : solution_.evidence) {
      if (e.grade == Grade::kUsable) continue;
      found = &e;
      ++count;
    }
    EXPECT_EQ(count, 1);
    static const Evidence kNone;
    return found == nullptr ? kNone : *found;
  }

  Solution solution_;
  std::vector<Sensor> sensors_;
  ErrorVector sigma_;
};

TEST_F(GradeTest, AHealthySolutionIsUsableAndSaysHowWellEverythingIsKnown) {
  sigma_(8) = 19.0 * kDegree;
  Set(0, sigma_);
  ConcludePlain();
  EXPECT_EQ(solution_.grade, Grade::kUsable);
  // sqrt(3) of an axis; the heading is 19 deg at one epoch, 1 deg at others.
  EXPECT_THAT(
      solution_.verdict,
      StartsWith("usable: position to 0.17 m if no error of gnss lasts, "
                 "velocity to 0.017 m/s, tilt to 0.14 deg, "
                 "heading to 2.1 deg (19 at worst)"));
  for (const Evidence& e : solution_.evidence) {
    EXPECT_EQ(e.rule, "accuracy");
    EXPECT_EQ(e.grade, Grade::kUsable);
  }
}

TEST_F(GradeTest, ALoneReceiverWithoutLastingErrorsIsSaidToHaveNone) {
  const auto says = [this] {
    ConcludePlain();
    return solution_.verdict.find("0.17 m if no error of gnss lasts") !=
           std::string::npos;
  };
  sensors_[0].kind = &PositionKind();
  EXPECT_TRUE(says()) << solution_.verdict;
  EXPECT_EQ(solution_.grade, Grade::kUsable);
  sensors_[0].noise.kind = &GaussMarkovNoise();
  EXPECT_FALSE(says());
  sensors_[0].noise = {};
  sensors_.push_back(sensors_[0]);
  EXPECT_FALSE(says());
}

/// Ten innovations, a tenth of what is stated: chance has a third of it once in
/// 5000 times.
TEST_F(GradeTest, SigmasThatHideErrorsAreNamed) {
  sensors_[0].kind = &PositionKind();
  const auto says = [this](double rms, std::size_t count) {
    const InnovationFigure figure = {.count = count, .rms = rms};
    ConcludeWith({.solution = solution_,
                  .sensors = sensors_,
                  .innovations = std::span(&figure, 1)});
    EXPECT_EQ(solution_.grade, Grade::kUsable);
    return solution_.verdict.find(
               "hard to see, whose sigmas are 10 times what its innovations "
               "say") != std::string::npos;
  };
  EXPECT_TRUE(says(0.1, 10)) << solution_.verdict;
  EXPECT_FALSE(says(0.4, 1000)) << solution_.verdict;
  EXPECT_FALSE(says(0.1, 1)) << solution_.verdict;
}

TEST_F(GradeTest, WhatNoSensorTestsIsDoubtful) {
  solution_.residuals.resize(3);
  ConcludePlain();
  EXPECT_EQ(Against().rule, "innovations");
  EXPECT_EQ(solution_.verdict,
            "doubtful: no sensor has the 4 measurements that a test of whether "
            "the model fits takes");
  solution_.residuals.clear();
  ConcludePlain();
  EXPECT_EQ(solution_.grade, Grade::kUsable);
}

TEST_F(GradeTest, WhatIsNotFiniteOrDidNotConvergeIsNotUsable) {
  solution_.converged = false;
  ConcludePlain();
  EXPECT_EQ(solution_.grade, Grade::kUnusable);
  EXPECT_EQ(solution_.verdict, "not usable: the iteration did not converge");
  Conclude({.solution = solution_, .sensors = sensors_, .hindrance = "a gap"},
           {}, &solution_);
  EXPECT_EQ(solution_.verdict,
            "not usable: the iteration did not converge: a gap");
  EXPECT_THAT(Against().causes, ElementsAre("a gap"));
  solution_.converged = true;
  sigma_(3) = std::numeric_limits<double>::quiet_NaN();
  Set(7, sigma_);
  ConcludePlain();
  EXPECT_EQ(Against().rule, "failure");
  EXPECT_EQ(Against().t_begin, 7.0);
  EXPECT_THAT(solution_.verdict, HasSubstr("from 7.0 s on are not finite"));
}

TEST_F(GradeTest, StateThatIsUnobservedOverHalfOfTheIntervalIsNotUsable) {
  ErrorVector unknown = sigma_;
  unknown(8) = 21.0 * kDegree;
  for (std::size_t k = 0; k < 50; ++k) Set(k, unknown);
  ConcludePlain();
  EXPECT_EQ(solution_.grade, Grade::kUsable);
  EXPECT_THAT(solution_.unobserved, SizeIs(1));
  for (std::size_t k = 50; k < 60; ++k) Set(k, unknown);
  ConcludePlain();
  EXPECT_EQ(solution_.grade, Grade::kUnusable);
  EXPECT_EQ(Against().rule, "unobserved");
  EXPECT_THAT(solution_.verdict,
              StartsWith("not usable: attitude[down] is not observed from 0.0 "
                         "s to 59.0 s"));
  // Where nothing tells north, the heading is not asked for.
  ConcludeWith({.solution = solution_, .relative_heading = true});
  EXPECT_EQ(solution_.grade, Grade::kUsable);
  EXPECT_THAT(solution_.verdict, HasSubstr("counts from the start"));
}

TEST_F(GradeTest, HeightThatNothingMeasuresIsDoubtfulAndPlacesAreTold) {
  ErrorVector unknown = sigma_;
  unknown(2) = 1e4;
  for (std::size_t k = 0; k < 60; ++k) Set(k, unknown);
  ConcludePlain();
  EXPECT_EQ(solution_.grade, Grade::kDoubtful);
  EXPECT_EQ(Against().rule, "unobserved");
  EXPECT_THAT(solution_.verdict,
              StartsWith("doubtful: nothing measures the height, which is "
                         "known to 1e+04 m alone"));
  const auto places =
      std::find_if(solution_.evidence.begin(), solution_.evidence.end(),
                   [](const Evidence& e) { return e.rule == "accuracy"; });
  ASSERT_NE(places, solution_.evidence.end());
  EXPECT_THAT(places->what, StartsWith("position over the ground to "));
  EXPECT_LT(*places->value, 100.0);
}

TEST_F(GradeTest, LargeResidualsAreNotUsable) {
  for (ResidualRecord& r : solution_.residuals) r.nis = 3.0 * 4.9 * 4.9;
  ConcludePlain();
  EXPECT_EQ(solution_.grade, Grade::kUsable);
  for (ResidualRecord& r : solution_.residuals) r.nis = 3.0 * 5.1 * 5.1;
  ConcludePlain();
  EXPECT_EQ(solution_.grade, Grade::kUnusable);
  EXPECT_EQ(Against().rule, "residuals");
  EXPECT_NEAR(*Against().value, 5.1, 1e-9);
  EXPECT_EQ(Against().limit, 5.0);
  EXPECT_FALSE(Against().causes.empty());
  EXPECT_FALSE(Against().remedies.empty());
}

TEST_F(GradeTest, VerdictIsOneSentenceOfTheWorstReason) {
  sensors_.resize(3);
  sensors_[1].name = "wheels";
  sensors_[2].name = "depth";
  for (int i = 1; i < 3; ++i) {
    for (std::size_t k = 0; k <= 100; ++k) {
      solution_.residuals.push_back(solution_.residuals[k]);
      solution_.residuals.back().sensor = i;
    }
  }
  for (ResidualRecord& r : solution_.residuals) {
    const double rms = r.sensor == 1 ? 40.0 : 6.0;
    r.nis = 3.0 * rms * rms;
  }
  ConcludePlain();
  EXPECT_EQ(solution_.verdict,
            "not usable: residuals of wheels are 40.0 times what their sigma "
            "says (limit 5), and 2 more reasons (see summary.json)");
  for (ResidualRecord& r : solution_.residuals) {
    if (r.sensor == 0) r.nis = 3.0;
  }
  ConcludePlain();
  EXPECT_THAT(solution_.verdict,
              HasSubstr("and 1 more reason (see summary.json)"));
  EXPECT_LE(("batch is " + solution_.verdict).size(), 160u);
}

TEST_F(GradeTest, WhatIsAlwaysToldIsInTheVerdictBesideTheWorstReason) {
  for (ResidualRecord& r : solution_.residuals) r.nis = 3.0 * 50.0 * 50.0;
  const Evidence ended{.grade = Grade::kDoubtful,
                       .what = "it was ended",
                       .is_always_told = true};
  ConcludeWith({.solution = solution_, .sensors = sensors_, .doubts = {ended}});
  EXPECT_EQ(solution_.verdict,
            "not usable: residuals of gnss are 50.0 times what their sigma "
            "says (limit 5); it was ended");
}

TEST_F(GradeTest, FaultOfTheRecordingIsNamedBeforeWhatComesOfIt) {
  for (ResidualRecord& r : solution_.residuals) r.nis = 3.0 * 50.0 * 50.0;
  const Evidence frozen{.rule = "frozen_imu",
                        .grade = Grade::kDoubtful,
                        .what = "imu repeats one reading for 5 s from 20 s",
                        .is_cause = true};
  ConcludeWith(
      {.solution = solution_, .sensors = sensors_, .recording = {frozen}});
  EXPECT_EQ(solution_.verdict,
            "not usable: imu repeats one reading for 5 s from 20 s, and 1 more "
            "reason (see summary.json)");
}

TEST_F(GradeTest, LongReasonIsCutAtAWord) {
  RivalSolution rival;
  rival.probability = 0.5;
  rival.description = std::string(300, 'x');
  for (std::size_t i = 9; i < 300; i += 10) rival.description[i] = ' ';
  solution_.rivals = {rival};
  ConcludePlain();
  EXPECT_LE(("two_filter_conventional is " + solution_.verdict).size(), 160u);
  EXPECT_THAT(solution_.verdict, ::testing::EndsWith("x..."));
}

TEST_F(GradeTest, ClockThatDoesNotSettleIsNotUsable) {
  ConcludeWith({.solution = solution_, .unsettled = "gnss"});
  EXPECT_EQ(Against().rule, "clock");
  EXPECT_THAT(
      solution_.verdict,
      StartsWith("not usable: the time offset of gnss does not settle"));
}

TEST_F(GradeTest, SmootherIsDoubtfulAtOneTimeAndNotUsableThroughout) {
  LinearisationError error{.largest = 1.4,
                           .component = "velocity[north]",
                           .t = 12.0,
                           .rms = 1.4,
                           .rms_component = "velocity[north]",
                           .settled = true};
  const auto conclude = [&] {
    ConcludeWith({.solution = solution_, .linearisation = error});
  };
  conclude();
  EXPECT_EQ(solution_.grade, Grade::kUsable);
  error.largest = 40.0;
  conclude();
  EXPECT_EQ(solution_.grade, Grade::kDoubtful);
  EXPECT_EQ(Against().t_begin, 12.0);
  EXPECT_EQ(Against().value, 40.0);
  EXPECT_THAT(solution_.verdict,
              AllOf(StartsWith("doubtful: "), HasSubstr("velocity[north] at "
                                                        "12.0 s")));
  EXPECT_THAT(Describe(Against()), HasSubstr("method iterated or batch"));
  error.rms = 3.1;
  conclude();
  EXPECT_EQ(solution_.grade, Grade::kDoubtful);
  error.rms = 3.2;
  conclude();
  EXPECT_EQ(solution_.grade, Grade::kUnusable);
  // A new linearisation that does not rest cures nothing.
  error.settled = false;
  conclude();
  EXPECT_THAT(Against().better_methods, IsEmpty());
}

TEST_F(GradeTest, FilterMustBeBeyondChance) {
  LinearisationError error;
  error.largest = 40.0;
  error.causal = true;
  for (const auto& [rms, grade] :
       {std::pair(1.9, Grade::kUsable), std::pair(2.0, Grade::kDoubtful),
        std::pair(3.2, Grade::kDoubtful), std::pair(3.3, Grade::kUnusable)}) {
    error.rms = rms;
    ConcludeWith({.solution = solution_, .linearisation = error});
    EXPECT_EQ(solution_.grade, grade) << rms;
  }
}

TEST_F(GradeTest, RivalNearlyAsLikelyIsToldWithItsProbability) {
  RivalSolution rival;
  rival.description = "heading turned by 178 deg";
  for (const auto& [probability, grade] :
       {std::pair(0.002, Grade::kUsable), std::pair(0.003, Grade::kDoubtful),
        std::pair(0.31, Grade::kDoubtful), std::pair(0.33, Grade::kUnusable)}) {
    rival.probability = probability;
    solution_.rivals = {rival};
    ConcludePlain();
    EXPECT_EQ(solution_.grade, grade) << probability;
    if (grade == Grade::kUsable) continue;
    EXPECT_EQ(Against().rule, "rival");
    EXPECT_NEAR(*Against().value, 100.0 * probability, 1e-9);
    EXPECT_THAT(Against().what, HasSubstr("heading turned by 178 deg"));
  }
}

TEST_F(GradeTest, RivalsCountByTheirSum) {
  RivalSolution rival;
  rival.probability = 0.15;
  rival.description = "clock 2 s later";
  solution_.rivals = {rival, rival};
  ConcludePlain();
  EXPECT_EQ(solution_.grade, Grade::kDoubtful);
  solution_.rivals = {rival, rival, rival};
  ConcludePlain();
  EXPECT_EQ(solution_.grade, Grade::kUnusable);
  EXPECT_NEAR(*Against().value, 45.0, 1e-9);
  EXPECT_THAT(Against().what,
              HasSubstr("15 % likely: clock 2 s later; with all others 45 %"));
}

TEST_F(GradeTest, ValueAtABoundIsDoubtful) {
  solution_.bounded = {
      {"the factor on the stated sigma", "1", 99.0, 0.01, 100.0},
      {"the share of outliers", "1", 0.001,
       -std::numeric_limits<double>::infinity(), 0.4}};
  ConcludePlain();
  EXPECT_EQ(solution_.grade, Grade::kUsable);
  for (const double bound : {0.01, 100.0}) {
    solution_.bounded[0].value = bound;
    ConcludePlain();
    EXPECT_EQ(solution_.grade, Grade::kDoubtful);
    EXPECT_EQ(Against().rule, "bounds");
    EXPECT_EQ(Against().limit, bound);
  }
}

TEST_F(GradeTest, WhatTheRecordingShowsIsPassedOnUnderItsOwnName) {
  const Evidence frozen{
      .rule = "frozen_imu", .grade = Grade::kDoubtful, .what = "the IMU rests"};
  ConcludeWith({.solution = solution_, .recording = {frozen}});
  EXPECT_EQ(solution_.grade, Grade::kDoubtful);
  EXPECT_EQ(Against().rule, "frozen_imu");
}

TEST_F(GradeTest, ObserverHasNoSigmasToSpeakOf) {
  solution_.observer = ObserverFigures{};
  ConcludePlain();
  EXPECT_EQ(solution_.verdict, "usable: by P, which is no covariance");
}

TEST(GradeRules, HaveNamesOfTheirOwn) {
  std::vector<std::string> names;
  for (const GradeRule& rule : GradeRules()) names.emplace_back(rule.name);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

Solution Graded(const std::string& method, Grade grade, int pieces = 1) {
  Solution solution;
  solution.method = method;
  solution.grade = grade;
  for (int i = 0; i < pieces && grade != Grade::kUsable; ++i) {
    solution.evidence.push_back({.rule = "residuals", .grade = grade});
  }
  solution.evidence.push_back({.rule = "accuracy"});
  return solution;
}

constexpr const char* kPreference[] = {"batch", "rts", "ekf"};

TEST(Best, IsByGradeThenByEvidenceThenByPreference) {
  using enum Grade;
  const auto best = [](const std::vector<Solution>& solutions) {
    return solutions
        .at(static_cast<std::size_t>(BestOf(solutions, kPreference)))
        .method;
  };
  EXPECT_EQ(best({Graded("ekf", kUsable), Graded("batch", kUsable),
                  Graded("rts", kUsable)}),
            "batch");
  EXPECT_EQ(best({Graded("batch", kDoubtful), Graded("ekf", kUsable)}), "ekf");
  EXPECT_EQ(best({Graded("batch", kUnusable), Graded("ekf", kDoubtful)}),
            "ekf");
  EXPECT_EQ(best({Graded("batch", kDoubtful, 2), Graded("rts", kDoubtful, 1)}),
            "rts");
  EXPECT_EQ(BestOf({}, kPreference), -1);
}

TEST(Best, AdviceNamesOnlyMethodsThatAreBetter) {
  std::vector<Solution> solutions = {Graded("rts", Grade::kUnusable),
                                     Graded("batch", Grade::kUnusable)};
  std::vector<std::string>& advised = solutions[0].evidence[0].better_methods;
  advised = {"iterated", "batch"};
  AdviseBetterMethods(&solutions);
  EXPECT_THAT(advised, ElementsAre("iterated"));
  advised = {"iterated", "batch"};
  solutions[1].grade = Grade::kUsable;
  AdviseBetterMethods(&solutions);
  EXPECT_THAT(advised, ElementsAre("iterated", "batch"));
}

/// Four new linearisations did not settle, but the batch did.
TEST(Best, BetterMethodThatStandsBesideIsAdvisedFirst) {
  std::vector<Solution> solutions = {Graded("rts", Grade::kUnusable),
                                     Graded("batch", Grade::kUsable),
                                     Graded("iterated", Grade::kUnusable)};
  Evidence& evidence = solutions[0].evidence[0];
  evidence.rule = "linearisation";
  evidence.remedies = {"a better known start"};
  AdviseBetterMethods(&solutions);
  EXPECT_THAT(WhatToTry(evidence),
              ElementsAre("method batch", "a better known start"));
}

/// Found when the second was judged; the first shares the doubt.
TEST(ShareDisagreements, TellsBothMethods) {
  std::vector<Solution> solutions = {Graded("iterated", Grade::kUsable),
                                     Graded("batch", Grade::kDoubtful),
                                     Graded("rts", Grade::kUsable)};
  solutions[1].evidence[0].rule = "disagreement";
  solutions[1].evidence[0].against = "iterated";
  for (int twice = 0; twice < 2; ++twice) {
    ShareDisagreements(&solutions);
    EXPECT_EQ(solutions[0].grade, Grade::kDoubtful);
    EXPECT_EQ(solutions[0].evidence.size(), 2u);
    EXPECT_THAT(solutions[0].verdict, StartsWith("doubtful"));
    EXPECT_EQ(solutions[1].evidence.size(), 2u);
    EXPECT_EQ(solutions[2].grade, Grade::kUsable);
  }
}

Solution WithPositions(const std::string& method) {
  Solution solution;
  solution.method = method;
  solution.layout = TypicalLayout();
  return solution;
}

TEST(ShareFindings, WhatASearchDoubtsHoldsForAllThatSeeTheWholeInterval) {
  std::vector<Solution> all = {WithPositions("batch"), WithPositions("ekf"),
                               WithPositions("robust_batch"),
                               WithPositions("rts")};
  all[1].forward = true;
  ShareFindings(&all);
  for (const Solution& one : all) EXPECT_TRUE(one.usable()) << one.method;
  AddEvidence(
      {.rule = "search", .grade = Grade::kDoubtful, .what = "gnss errs"},
      &all[2]);
  for (int twice = 0; twice < 2; ++twice) {
    ShareFindings(&all);
    EXPECT_EQ(all[0].grade, Grade::kDoubtful);
    ASSERT_EQ(all[0].evidence.size(), 1u);
    EXPECT_THAT(all[0].verdict,
                StartsWith("doubtful: robust_batch: gnss errs"));
    EXPECT_TRUE(all[1].usable());
    EXPECT_EQ(all[2].evidence.size(), 1u);
    EXPECT_EQ(all[3].grade, Grade::kDoubtful);
  }
}

TEST(ShareFindings, WhatAComparisonShowsIsOfTheMethodThatItNames) {
  std::vector<Solution> all = {WithPositions("batch"), WithPositions("ekf"),
                               WithPositions("robust_batch"),
                               WithPositions("rts")};
  all[1].forward = true;
  const Evidence sure = {
      .rule = "too_sure", .grade = Grade::kDoubtful, .what = "4 sigma off"};
  all[2].compared = {{"ekf", sure}, {"rts", sure}};
  for (int twice = 0; twice < 2; ++twice) {
    ShareFindings(&all);
    for (const std::size_t i : {0u, 1u, 2u}) EXPECT_TRUE(all[i].usable()) << i;
    EXPECT_EQ(all[3].evidence.size(), 1u);
    EXPECT_THAT(all[3].verdict, StartsWith("doubtful: 4 sigma off"));
  }
}

/// Nor does any other rule tell of other methods.
TEST(ShareFindings, ASearchThatWasEndedSaysNothing) {
  std::vector<Solution> all = {WithPositions("batch"),
                               WithPositions("robust_batch")};
  AddEvidence({.rule = "search",
               .grade = Grade::kDoubtful,
               .what = "was ended",
               .is_always_told = true},
              &all[1]);
  AddEvidence({.rule = "linearisation", .grade = Grade::kDoubtful}, &all[1]);
  ShareFindings(&all);
  EXPECT_TRUE(all[0].usable());
}

TEST(FailedSolution, IsNotUsableForItsReason) {
  const Solution failed = FailedSolution("hinf", "the filter diverged");
  EXPECT_EQ(failed.grade, Grade::kUnusable);
  EXPECT_FALSE(failed.usable());
  EXPECT_EQ(failed.verdict, "not usable: the filter diverged");
}

}  // namespace
}  // namespace hindsight
