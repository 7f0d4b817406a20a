#include "evaluation/withheld_rule.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "evaluation/innovation_test.h"

namespace hindsight {
namespace {

constexpr double kFalse = 0.01;

/// Predictions whose errors last as long as a trajectory's: N(0, size^2), with
/// the correlation `keep` from one to the next.
std::vector<ResidualRecord> Withheld(std::uint64_t seed, int count, double size,
                                     double keep) {
  Random random(seed);
  std::vector<ResidualRecord> all;
  double error = random.Normal();
  for (int i = 0; i < count; ++i) {
    ResidualRecord one;
    one.t = i;
    one.withheld = true;
    one.accepted = false;
    one.residual = RowVector::Constant(1, 0.2 * size * error);
    one.sigma = RowVector::Constant(1, 0.2);
    all.push_back(one);
    error = keep * error + std::sqrt(1.0 - keep * keep) * random.Normal();
  }
  return all;
}

double ExcessOf(const std::vector<ResidualRecord>& records) {
  const std::vector<WithheldFigure> figures = TestWithheld(records, kFalse);
  EXPECT_EQ(figures.size(), 1u);
  return figures.front().excess;
}

class WithheldFigureOf : public ::testing::TestWithParam<double> {};

TEST_P(WithheldFigureOf, RightSigmasIsRarelyBeyondChance) {
  constexpr int kRuns = 400;
  int beyond = 0;
  for (int run = 0; run < kRuns; ++run) {
    if (ExcessOf(Withheld(static_cast<unsigned>(run), 100, 1.0, GetParam())) >
        1.0) {
      ++beyond;
    }
  }
  // Correlations are known from a hundred of them only.
  EXPECT_LE(beyond, 3 * kRuns / 100);
}

TEST_P(WithheldFigureOf, ErrorsFiveTimesAsLargeIsFound) {
  EXPECT_GT(ExcessOf(Withheld(9, 400, 5.0, GetParam())), 2.0);
}

INSTANTIATE_TEST_SUITE_P(Correlations, WithheldFigureOf,
                         ::testing::Values(0.0, 0.8, 0.95));

TEST(Withheld, FewAreNotJudged) {
  EXPECT_TRUE(TestWithheld(Withheld(1, 3, 9.0, 0.0), kFalse).empty());
}

Grade GradeOfWithheld(double size, bool sensor_is_used,
                      const RobustLoss& loss = {}, std::size_t outliers = 0) {
  Solution solution;
  solution.residuals = Withheld(5, 400, size, 0.0);
  for (std::size_t i = 0; i < outliers; ++i) {
    solution.residuals[10 * i].residual *= 40.0;
    solution.residuals[10 * i].nis = 1600.0;
  }
  if (sensor_is_used) {
    solution.residuals.push_back(solution.residuals.front());
    solution.residuals.back().withheld = false;
    solution.residuals.back().accepted = true;
  }
  Sensor sensor;
  sensor.name = "gnss";
  sensor.loss = loss;
  const std::vector<Sensor> sensors = {sensor};
  std::vector<Evidence> evidence;
  FindOddPredictions({.solution = solution, .sensors = sensors}, &evidence);
  return GradeOf(evidence);
}

TEST(Withheld, FarOffLowerTheGrade) {
  EXPECT_EQ(GradeOfWithheld(1.0, true), Grade::kUsable);
  EXPECT_EQ(GradeOfWithheld(2.0, true), Grade::kDoubtful);
  EXPECT_EQ(GradeOfWithheld(5.0, true), Grade::kUnusable);
}

/// Nothing vouches for what is withheld as a whole.
TEST(Withheld, OfASensorThatIsNotUsedMakeDoubtfulAtMost) {
  EXPECT_EQ(GradeOfWithheld(1.0, false), Grade::kUsable);
  EXPECT_EQ(GradeOfWithheld(5.0, false), Grade::kDoubtful);
}

/// A mixture has outliers, but no more than it says; of a loss nothing is said.
TEST(Withheld, OfAMixtureAreJudgedWithoutItsOutliers) {
  RobustLoss mixture;
  mixture.kind = RobustLoss::Kind::kMixture;
  mixture.outlier_share = 0.02;
  EXPECT_EQ(GradeOfWithheld(1.0, true, mixture), Grade::kUsable);
  EXPECT_EQ(GradeOfWithheld(1.0, true, mixture, 8), Grade::kUsable);
  EXPECT_NE(GradeOfWithheld(1.0, true, mixture, 40), Grade::kUsable);
  EXPECT_EQ(GradeOfWithheld(5.0, true, mixture), Grade::kUnusable);
  RobustLoss huber;
  huber.kind = RobustLoss::Kind::kHuber;
  EXPECT_EQ(GradeOfWithheld(5.0, true, huber), Grade::kUsable);
}

}  // namespace
}  // namespace hindsight
