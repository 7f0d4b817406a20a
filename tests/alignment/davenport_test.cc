#include "alignment/davenport.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

struct Pair {
  Eigen::Vector3d a, b;
};

std::vector<Pair> Pairs(const Eigen::Quaterniond& C, double sigma,
                        Random* random) {
  std::vector<Pair> pairs;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d b = 2.0 * random->NormalVector3();
    pairs.push_back({C * b + sigma * random->NormalVector3(), b});
  }
  return pairs;
}

Eigen::Matrix3d Profile(const std::vector<Pair>& pairs) {
  Eigen::Matrix3d B = Eigen::Matrix3d::Zero();
  for (const Pair& p : pairs) B += p.a * p.b.transpose();
  return B;
}

double Loss(const std::vector<Pair>& pairs, const Eigen::Quaterniond& C) {
  double loss = 0.0;
  for (const Pair& p : pairs) loss += 0.5 * (p.a - C * p.b).squaredNorm();
  return loss;
}

TEST(Davenport, FindsAnyRotationFromExactVectors) {
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Quaterniond C =
        Exp(random.NormalVector3().normalized() * M_PI * i / 49.0);
    const VectorMatch match = MatchVectors(Profile(Pairs(C, 0.0, &random)));
    EXPECT_LT(match.q.angularDistance(C), 1e-7) << i;
  }
}

TEST(Davenport, GapsAreTheLossOfTheAttitudesTurnedByHalfATurn) {
  Random random(2);
  const Eigen::Quaterniond C = Exp(Eigen::Vector3d(0.3, -2.0, 1.0));
  const std::vector<Pair> pairs = Pairs(C, 0.1, &random);
  const VectorMatch match = MatchVectors(Profile(pairs));
  const double best = Loss(pairs, match.q);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = match.axes.col(i);
    EXPECT_NEAR(Loss(pairs, Exp(M_PI * axis) * match.q) - best, match.gaps(i),
                1e-9);
    constexpr double kSmall = 1e-3;
    EXPECT_NEAR(Loss(pairs, Exp(kSmall * axis) * match.q) - best,
                match.gaps(i) * kSmall * kSmall / 4.0, 1e-9);
  }
}

TEST(Davenport, CovarianceIsThatOfMonteCarlo) {
  constexpr int kRuns = 4000;
  constexpr double kSigma = 0.05;
  Random random(3);
  const Eigen::Quaterniond C = Exp(Eigen::Vector3d(-1.0, 0.4, 2.0));
  const std::vector<Pair> exact = Pairs(C, 0.0, &random);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (int run = 0; run < kRuns; ++run) {
    std::vector<Pair> pairs = exact;
    for (Pair& p : pairs) p.a += kSigma * random.NormalVector3();
    const Eigen::Vector3d psi =
        Log(C * MatchVectors(Profile(pairs)).q.conjugate());
    scatter += psi * psi.transpose() / kRuns;
  }
  const Eigen::Matrix3d P =
      kSigma * kSigma * MatchVectors(Profile(exact)).Covariance(1.0);
  // Relative scatter of a variance over 4000 runs: 2.2 %, four sigmas.
  EXPECT_LT((scatter - P).cwiseAbs().maxCoeff(), 0.09 * P.norm());
}

TEST(Davenport, OneDirectionLeavesTheTurnAboutItOpen) {
  const Eigen::Vector3d down(0.0, 0.0, 9.8);
  const VectorMatch match = MatchVectors(down * down.transpose());
  EXPECT_NEAR(match.gaps(0), 0.0, 1e-9);
  EXPECT_NEAR(std::abs(match.axes.col(0).z()), 1.0, 1e-9);
  EXPECT_NEAR(match.Covariance(3.0)(2, 2), 3.0, 1e-9);
  EXPECT_LT(match.Covariance(3.0)(0, 0), 0.03);
}

}  // namespace
}  // namespace hindsight
