#include "receiver_errors/error_dynamics.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <tuple>

namespace hindsight {
namespace {

constexpr ErrorStep kBegins = {ErrorMode::kDrifting, true};

/// Moments of an error r u, u being uniform over a part of the time since the fix before, by
/// the midpoint rule; what has been good before adds none.
TEST(ErrorDynamics, ADriftBeganAtAnyTimeOfItsOnset) {
  ErrorParameters p;
  p.rate_sigma = 0.3;
  constexpr int kPieces = 100000;
  ErrorStep begins = kBegins;
  for (const double since : {0.2, 1.0, 7.5}) {
    for (const auto& [onset, least, most] :
         {std::tuple{Onset::kUsual, 0.0, 1.0},
          {Onset::kFirst, 0.75, 1.0},
          {Onset::kSecond, 0.5, 0.75},
          {Onset::kThird, 0.25, 0.5},
          {Onset::kFourth, 0.0, 0.25}}) {
      begins.onset = onset;
      double ee = 0.0;
      double er = 0.0;
      for (int i = 0; i < kPieces; ++i) {
        const double u = since * (least + (most - least) * (i + 0.5) / kPieces);
        ee += u * u * 0.09 / kPieces;
        er += u * 0.09 / kPieces;
      }
      // Whatever other nodes there are in between.
      for (const double dt : {0.2, 0.1}) {
        const ErrorDynamics d = DynamicsOf(p, begins, dt, {since, true});
        EXPECT_NEAR(d.q_ee, ee, 1e-8 * ee);
        EXPECT_NEAR(d.q_er, er, 1e-8 * er);
        EXPECT_DOUBLE_EQ(d.q_rr, 0.09);
        EXPECT_EQ(d.ee, 1.0);
        EXPECT_EQ(d.er, 0.0);
        EXPECT_EQ(d.rr, 0.0);
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> Q(
            ErrorQ(d));
        EXPECT_GT(Q.eigenvalues().minCoeff(), 0.0);
      }
    }
  }
}

/// Of an error r T, whatever the interval; in a quarter of T where that is told.
TEST(ErrorDynamics, ADriftBeganAtTheFixBefore) {
  ErrorParameters p;
  p.rate_sigma = 0.3;
  const ErrorDynamics d = DynamicsOf(p, kBegins, 0.1, {2.0, false});
  EXPECT_DOUBLE_EQ(d.q_ee, 0.36);
  EXPECT_DOUBLE_EQ(d.q_er, 0.18);
  EXPECT_DOUBLE_EQ(d.q_rr, 0.09);
  ErrorStep late = kBegins;
  late.onset = Onset::kFourth;
  const ErrorDynamics of_late = DynamicsOf(p, late, 0.1, {2.0, false});
  EXPECT_DOUBLE_EQ(of_late.q_ee, 0.09 * 0.25 / 3.0);
  EXPECT_DOUBLE_EQ(of_late.q_er, 0.09 * 0.25);
}

/// A drift that goes on knows nothing of the time since the fix before.
TEST(ErrorDynamics, ADriftGoesOnByItsRate) {
  const ErrorParameters p;
  const ErrorDynamics d =
      DynamicsOf(p, {ErrorMode::kDrifting}, 0.5, {9.0, true});
  EXPECT_EQ(d.er, 0.5);
  EXPECT_EQ(d.q_ee, 0.0);
  EXPECT_EQ(d.q_er, 0.0);
}

}  // namespace
}  // namespace hindsight
