#include "filters/covariance_policy.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>

#include "base/random.h"
#include "filters/kalman.h"

namespace hindsight {
namespace {

constexpr double kGamma = 3.0;

ErrorLayout TwelveStates() {
  ErrorLayout layout;
  const ErrorLayout all = NavigationLayout({});
  for (const Block& block : all.blocks()) {
    if (block.key.kind != BlockKind::kPosition) layout.Add(block);
  }
  return layout;
}

CovarianceOptions HInfinity(double gamma) {
  CovarianceOptions options;
  options.rule = RiccatiRule::kHInfinity;
  options.gamma = gamma;
  return options;
}

CovarianceOptions Modified(double alpha, double delta) {
  CovarianceOptions options;
  options.rule = RiccatiRule::kModifiedHInfinity;
  options.alpha = alpha;
  options.delta = delta;
  return options;
}

ErrorMatrix RandomCovariance(int n, Random* random) {
  ErrorMatrix A(n, n);
  for (double& value : A.reshaped()) value = random->Normal();
  return A * A.transpose() + 0.1 * ErrorMatrix::Identity(n, n);
}

/// L'L of attitude in radians, of twelve states.
ErrorMatrix AttitudeWeight() {
  ErrorMatrix W = ErrorMatrix::Zero(12, 12);
  W.block<3, 3>(3, 3).setIdentity();
  return W;
}

TEST(CovariancePolicy, WithoutInformationPEscapesAtGammaSquaredOverP0) {
  const ErrorLayout layout = TwelveStates();
  constexpr double kP0 = 4.0;
  constexpr double kEscape = kGamma * kGamma / kP0;
  for (const double dt : {0.01, 0.1, 0.7}) {
    CovariancePolicy policy(HInfinity(kGamma), layout);
    ErrorMatrix P = kP0 * ErrorMatrix::Identity(12, 12);
    ErrorVector dx = ErrorVector::Zero(12);
    double t = 0.0;
    try {
      while (t < 2.0 * kEscape) {
        policy.Bound(t + dt, dt, &dx, &P);
        t += dt;
        ASSERT_TRUE(P.allFinite());
        EXPECT_NEAR(1.0 / P(4, 4), 1.0 / kP0 - t / (kGamma * kGamma), 1e-9);
        EXPECT_NEAR(P(0, 0), kP0, 1e-12);  // velocity is not bounded
      }
      FAIL() << "no escape";
    } catch (const FiniteEscape& escape) {
      EXPECT_NEAR(escape.t(), kEscape, 1e-6) << dt;
      EXPECT_LE(t, kEscape);
      EXPECT_GT(t + dt, kEscape - 1e-9);
    }
  }
}

TEST(CovariancePolicy, BoundIsTheInformationFormAndItsGain) {
  const ErrorLayout layout = TwelveStates();
  Random random(2);
  const ErrorMatrix P_minus = RandomCovariance(12, &random);
  LinearizedMeasurement z;
  z.Resize(3, 12);
  z.H.leftCols(3).setIdentity();
  z.H(1, 4) = 0.3;
  z.R.diagonal().setConstant(0.5);
  z.residual << 0.3, -0.2, 0.1;
  constexpr double kStep = 0.05;
  ErrorMatrix P = P_minus;
  ErrorVector dx = ErrorVector::Zero(12);
  Update(z, Innovate(z, dx, P), &dx, &P);
  CovariancePolicy(HInfinity(kGamma), layout).Bound(1.0, kStep, &dx, &P);

  const ErrorMatrix information = P_minus.inverse() +
                                  z.H.transpose() * z.R.inverse() * z.H -
                                  kStep / (kGamma * kGamma) * AttitudeWeight();
  const ErrorMatrix expected = information.inverse();
  EXPECT_LT((P - expected).cwiseAbs().maxCoeff(), 1e-10);
  const ErrorVector gain_dx =
      expected * z.H.transpose() * z.R.inverse() * z.residual;
  EXPECT_LT((dx - gain_dx).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(CovariancePolicy, ExistsExactlyWhereTheInformationIsPositiveDefinite) {
  const ErrorLayout layout = TwelveStates();
  Random random(3);
  int escaped = 0;
  constexpr int kTrials = 200;
  for (int i = 0; i < kTrials; ++i) {
    ErrorMatrix P = RandomCovariance(12, &random);
    const double theta = 0.15 * random.Uniform();
    const ErrorMatrix information = P.inverse() - theta * AttitudeWeight();
    const bool exists = Eigen::SelfAdjointEigenSolver<ErrorMatrix>(information)
                            .eigenvalues()
                            .minCoeff() > 0.0;
    ErrorVector dx = ErrorVector::Zero(12);
    CovariancePolicy policy(Modified(0.0, theta), layout);
    if (exists) {
      EXPECT_NO_THROW(policy.Bound(1.0, 1.0, &dx, &P));
    } else {
      EXPECT_THROW(policy.Bound(1.0, 1.0, &dx, &P), FiniteEscape);
      ++escaped;
    }
  }
  EXPECT_GT(escaped, kTrials / 10);
  EXPECT_LT(escaped, kTrials * 9 / 10);
}

TEST(CovariancePolicy, AWeightBeyondNumbersEscapesAtOnceAndIsNeverNaN) {
  const ErrorLayout layout = TwelveStates();
  CovarianceOptions small_unit = HInfinity(kGamma);
  small_unit.L[0].unit = 1e-200;
  for (CovarianceOptions options : {small_unit, HInfinity(1e-200)}) {
    ErrorMatrix P = ErrorMatrix::Identity(12, 12);
    ErrorVector dx = ErrorVector::Zero(12);
    try {
      CovariancePolicy(options, layout).Bound(1.0, 0.1, &dx, &P);
      FAIL() << "no escape";
    } catch (const FiniteEscape& escape) {
      EXPECT_NEAR(escape.t(), 0.9, 1e-9);
    }
    options.back_off = true;
    CovariancePolicy(options, layout).Bound(1.0, 0.1, &dx, &P);
    EXPECT_EQ(P, ErrorMatrix::Identity(12, 12));
    EXPECT_TRUE(dx.isZero(0.0));
  }
}

TEST(CovariancePolicy, RecordsTheShareOfInformationThatTheWeightLeft) {
  const ErrorLayout layout = TwelveStates();
  CovariancePolicy policy(HInfinity(kGamma), layout);
  ErrorMatrix P = 2.0 * ErrorMatrix::Identity(12, 12);
  ErrorVector dx = ErrorVector::Zero(12);
  EXPECT_EQ(policy.record().least_information, 1.0);
  policy.Bound(0.5, 0.5, &dx, &P);
  EXPECT_NEAR(policy.record().least_information,
              1.0 - 0.5 * 2.0 / (kGamma * kGamma), 1e-12);
  P = ErrorMatrix::Identity(12, 12);
  policy.Bound(1.0, 0.5, &dx, &P);
  EXPECT_NEAR(policy.record().least_information,
              1.0 - 0.5 * 2.0 / (kGamma * kGamma), 1e-12);
  EXPECT_EQ(policy.record().back_offs, 0);
}

TEST(CovariancePolicy, BackedOffItStaysFinite) {
  const ErrorLayout layout = TwelveStates();
  CovarianceOptions options = HInfinity(kGamma);
  options.back_off = true;
  CovariancePolicy policy(options, layout);
  ErrorMatrix P = 4.0 * ErrorMatrix::Identity(12, 12);
  ErrorVector dx = ErrorVector::Zero(12);
  for (int i = 0; i < 1000; ++i) policy.Bound(0.1 * i, 0.1, &dx, &P);
  EXPECT_TRUE(P.allFinite());
  EXPECT_EQ(P.llt().info(), Eigen::Success);
  EXPECT_GT(policy.record().back_offs, 0);
  // P^-1 = 0.25 falls by 1 / 90 a step: after 20 of them 2.5 steps are left, of
  // which the next takes 1 / 2.5; the one after would take more than half.
  EXPECT_NEAR(policy.record().least_information, 0.6, 1e-9);
  // A step of theta = 0.1 / 9 doubles what is above 45 rad^2.
  EXPECT_GT(P(3, 3), 40.0);
  EXPECT_LT(P(3, 3), 90.0 + 1e-9);
}

TEST(CovariancePolicy, AlphaIsAPrescribedDegreeOfStability) {
  // P' = (A + alpha I) P + P (A + alpha I)' + Q by fine Euler steps.
  const ErrorLayout layout = TwelveStates();
  Random random(4);
  ErrorMatrix A(12, 12);
  for (double& value : A.reshaped()) value = 0.1 * random.Normal();
  const ErrorMatrix Q = RandomCovariance(12, &random);
  const ErrorMatrix P0 = RandomCovariance(12, &random);
  constexpr double kAlpha = 0.4;
  for (const bool all : {false, true}) {
    ErrorMatrix S = ErrorMatrix::Zero(12, 12);
    S.diagonal().head(all ? 12 : 6).setConstant(kAlpha);
    CovarianceOptions options = Modified(kAlpha, 0.0);
    options.alpha_on_all = all;
    const CovariancePolicy policy(options, layout);
    const double dt = 1e-3;
    Transition transition;
    const ErrorMatrix I = ErrorMatrix::Identity(12, 12);
    transition.Phi = I + dt * A + 0.5 * dt * dt * A * A;
    transition.Q = dt * Q;
    ErrorMatrix P = P0;
    ErrorMatrix P_euler = P0;
    for (int i = 0; i < 500; ++i) {
      policy.Predict(transition, dt, &P);
      for (int j = 0; j < 20; ++j) {
        const ErrorMatrix F = A + S;
        P_euler +=
            (dt / 20.0 * (F * P_euler + P_euler * F.transpose() + Q)).eval();
      }
    }
    EXPECT_LT((P - P_euler).norm() / P_euler.norm(), 1e-3);
    // Without alpha the two differ by far more.
    EXPECT_GT(P.norm() / P0.norm(), 1.2);
  }
}

TEST(CovariancePolicy, LimitsAreKalmanToTheLastDigit) {
  const ErrorLayout layout = TwelveStates();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const CovarianceOptions& options :
       {CovarianceOptions{}, HInfinity(infinity), Modified(0.0, 0.0)}) {
    CovariancePolicy policy(options, layout);
    EXPECT_TRUE(policy.is_kalman());
    Random random(5);
    ErrorMatrix P = RandomCovariance(12, &random);
    const ErrorMatrix before = P;
    ErrorVector dx = ErrorVector::Ones(12);
    policy.Bound(1.0, 1.0, &dx, &P);
    EXPECT_EQ(P, before);
    EXPECT_EQ(dx, ErrorVector(ErrorVector::Ones(12)));
  }
}

TEST(CovariancePolicy, UnitsOfLScaleItsWeight) {
  const ErrorLayout layout = TwelveStates();
  CovarianceOptions options = HInfinity(kGamma);
  options.L = {{BlockKind::kAttitude, 0.5}, {BlockKind::kVelocity, 2.0}};
  Random random(6);
  ErrorMatrix P = 0.1 * RandomCovariance(12, &random);
  ErrorMatrix information = P.inverse();
  const double theta = 0.1 / (kGamma * kGamma);
  information.diagonal().segment<3>(3).array() -= theta / 0.25;
  information.diagonal().head<3>().array() -= theta / 4.0;
  ErrorVector dx = ErrorVector::Zero(12);
  CovariancePolicy(options, layout).Bound(1.0, 0.1, &dx, &P);
  EXPECT_LT(
      (P * information - ErrorMatrix::Identity(12, 12)).cwiseAbs().maxCoeff(),
      1e-9);
  options.L = {{BlockKind::kPosition, 1.0}};
  EXPECT_THROW(CovariancePolicy(options, layout), std::logic_error);
}

}  // namespace
}  // namespace hindsight
