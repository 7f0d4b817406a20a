#include "evaluation/combined_constants.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "base/chi_square.h"
#include "base/error.h"
#include "base/random.h"

namespace hindsight {
namespace {

constexpr double kPriorSigma = 0.5;

/// What linear data z = H x + v of unit noise make of two constants.
RecordedConstants Recording(const std::string& source, const Eigen::MatrixXd& H,
                            const Eigen::VectorXd& z) {
  const Eigen::MatrixXd W0 =
      Eigen::Matrix2d::Identity() / (kPriorSigma * kPriorSigma);
  RecordedConstants one;
  one.source = source;
  one.names = {"log_scale", "log_offset"};
  one.units = {"1", "m"};
  one.P = (W0 + H.transpose() * H).inverse();
  one.prior_value = Eigen::Vector2d(0.1, -0.2);
  one.value = one.P * (W0 * one.prior_value + H.transpose() * z);
  one.prior_sigma = Eigen::Vector2d::Constant(kPriorSigma);
  return one;
}

Eigen::MatrixXd Design(Random* random, int rows) {
  Eigen::MatrixXd H(rows, 2);
  for (int i = 0; i < rows; ++i) {
    H.row(i) << 1.0 + random->Normal(), random->Normal();
  }
  return H;
}

Eigen::VectorXd Noise(Random* random, int rows) {
  Eigen::VectorXd v(rows);
  for (int i = 0; i < rows; ++i) v(i) = random->Normal();
  return v;
}

/// Both recordings at once are one least-squares problem with one prior.
TEST(CombinedConstants, AreTheLeastSquaresOfAllData) {
  Random random(1);
  const Eigen::Vector2d x(0.3, -0.1);
  const Eigen::MatrixXd H1 = Design(&random, 40);
  // One row alone: one direction of the two says nothing.
  const Eigen::MatrixXd H2 = Design(&random, 1);
  const Eigen::VectorXd z1 = H1 * x + Noise(&random, 40);
  const Eigen::VectorXd z2 = H2 * x + Noise(&random, 1);
  const std::vector<RecordedConstants> all = {Recording("a", H1, z1),
                                              Recording("b", H2, z2)};
  const CombinedConstants combined = CombineConstants(all);
  Eigen::MatrixXd H(41, 2);
  H << H1, H2;
  Eigen::VectorXd z(41);
  z << z1, z2;
  const RecordedConstants expected = Recording("both", H, z);
  for (int i = 0; i < 2; ++i) {
    const ConstantEstimate& c = combined.constants[static_cast<std::size_t>(i)];
    EXPECT_NEAR(c.value, expected.value(i), 1e-9);
  }
  EXPECT_LT((combined.P - expected.P).norm(), 1e-9 * expected.P.norm());
  EXPECT_EQ(combined.dof, 3.0);
  EXPECT_TRUE(combined.evidence.empty());
}

TEST(CombinedConstants, OfRecordingsThatAgreeHaveHonestSigmas) {
  constexpr int kRuns = 200;
  Random random(2);
  double together = 0.0;
  double nees = 0.0;
  int doubtful = 0;
  for (int run = 0; run < kRuns; ++run) {
    const Eigen::Vector2d x =
        Eigen::Vector2d(0.1, -0.2) +
        kPriorSigma * Eigen::Vector2d(random.Normal(), random.Normal());
    std::vector<RecordedConstants> all;
    for (const char* name : {"a", "b", "c"}) {
      const Eigen::MatrixXd H = Design(&random, 100);
      all.push_back(Recording(name, H, H * x + Noise(&random, 100)));
    }
    const CombinedConstants combined = CombineConstants(all);
    const Eigen::Vector2d error(combined.constants[0].value - x(0),
                                combined.constants[1].value - x(1));
    nees += error.dot(combined.P.inverse() * error) / kRuns;
    together += combined.chi_square / kRuns;
    if (!combined.evidence.empty()) ++doubtful;
  }
  EXPECT_TRUE(AneesBounds(kRuns, 2, 0.999).Contains(nees)) << nees;
  EXPECT_TRUE(AneesBounds(kRuns, 6, 0.999).Contains(together)) << together;
  EXPECT_LE(doubtful, 6);  // 0.6 % each; more than six of 200: 1 in 10000
}

/// What varies from recording to recording has that in the next one's sigma.
TEST(CombinedConstants, WhatVariesIsDoubtfulAndWide) {
  constexpr int kRuns = 100;
  constexpr double kTau = 0.2;
  Random random(3);
  double squares = 0.0;
  int told = 0;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<RecordedConstants> all;
    for (int k = 0; k < 8; ++k) {
      const Eigen::Vector2d x(0.3, kTau * random.Normal());
      const Eigen::MatrixXd H = Design(&random, 1000);
      all.push_back(
          Recording(std::to_string(k), H, H * x + Noise(&random, 1000)));
    }
    const CombinedConstants combined = CombineConstants(all);
    if (combined.evidence.empty()) continue;
    ++told;
    EXPECT_EQ(combined.evidence[0].grade, Grade::kDoubtful);
    EXPECT_GT(combined.agreement[1].varies_by, 0.0);
    const double next = kTau * random.Normal();
    squares += std::pow(
        (combined.constants[1].value - next) / combined.constants[1].sigma, 2);
  }
  EXPECT_EQ(told, kRuns);
  // Of seven degrees of freedom tau is known to a quarter: heavier tails.
  EXPECT_GT(squares / kRuns, 0.6);
  EXPECT_LT(squares / kRuns, 2.0);
}

TEST(CombinedConstants, WhatCannotBeCombinedIsNamed) {
  Random random(4);
  const Eigen::MatrixXd H = Design(&random, 10);
  const RecordedConstants a = Recording("a", H, Noise(&random, 10));
  RecordedConstants b = Recording("b", H, Noise(&random, 10));
  b.units[1] = "rad";
  EXPECT_THROW(CombineConstants(std::vector{a, b}), InputError);
  b.units[1] = "m";
  b.from = "a";
  EXPECT_THROW(CombineConstants(std::vector{a, b}), InputError);
  b.from = "";
  b.names = {"x_scale", "x_offset"};
  EXPECT_THROW(CombineConstants(std::vector{a, b}), InputError);
}

}  // namespace
}  // namespace hindsight
