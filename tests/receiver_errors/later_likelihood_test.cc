#include "receiver_errors/later_likelihood.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hindsight {
namespace {

LinearizedMeasurement OfSum(double residual) {
  LinearizedMeasurement z;
  z.residual = RowVector::Constant(1, residual);
  z.R = RowMatrix::Identity(1, 1);
  z.H = RowJacobian::Ones(1, 2);
  return z;
}

double LogMeanOf(const LaterLikelihood& later) {
  return later.LogMean({ErrorVector::Ones(2), ErrorMatrix::Identity(2, 2)});
}

/// The second error is forgotten, by less and less: what is left of it underflows at
/// some step, first its square.
TEST(LaterLikelihood, ForgetsWhatUnderflows) {
  ErrorMatrix forgets = ErrorMatrix::Identity(2, 2);
  forgets(1, 1) = 1e-2;
  ErrorMatrix forgot = ErrorMatrix::Identity(2, 2);
  forgot(1, 1) = 0.0;
  const ErrorMatrix none = ErrorMatrix::Zero(2, 2);
  LaterLikelihood later(2);
  later.Add(OfSum(0.3));
  later.Add(OfSum(-0.5));
  for (int i = 0; i < 200; ++i) {
    later.BackOver(forgets, none, ErrorVector::Zero(2));
    LaterLikelihood without = later;
    without.BackOver(forgot, none, ErrorVector::Zero(2));
    LaterLikelihood more = later;
    LinearizedMeasurement first = OfSum(0.1);
    first.H(0, 1) = 0.0;
    more.Add(first);
    without.Add(first);
    if (i < 10) continue;
    ASSERT_NEAR(LogMeanOf(more), LogMeanOf(without), 1e-9) << i;
  }
}

/// Of an x without the second error, as if that were known to be zero.
TEST(LaterLikelihood, TakesErrorsThatAreLeftOutForZero) {
  LaterLikelihood later(2);
  later.Add(OfSum(0.3));
  later.BackOver(ErrorMatrix::Identity(2, 2), ErrorMatrix::Identity(2, 2),
                 ErrorVector::Zero(2));
  later.Add(OfSum(-0.5));
  const Gaussian first = {ErrorVector::Constant(1, 2.0),
                          ErrorMatrix::Constant(1, 1, 3.0)};
  Gaussian both = {ErrorVector::Zero(2), ErrorMatrix::Zero(2, 2)};
  both.mean(0) = 2.0;
  both.P(0, 0) = 3.0;
  EXPECT_NEAR(later.LogMean(first), later.LogMean(both), 1e-12);
  const Gaussian joined = later.Joined(first);
  const Gaussian expected = later.Joined(both);
  ASSERT_EQ(joined.mean.size(), 1);
  EXPECT_NEAR(joined.mean(0), expected.mean(0), 1e-12);
  EXPECT_NEAR(joined.P(0, 0), expected.P(0, 0), 1e-12);
}

/// ln E[L] of two measurements, against the density of both.
TEST(LaterLikelihood, MeansTheDensityOfWhatFollows) {
  LaterLikelihood later(2);
  later.Add(OfSum(0.3));
  ErrorMatrix Phi = ErrorMatrix::Identity(2, 2);
  Phi(0, 1) = 0.5;
  ErrorMatrix Q = ErrorMatrix::Zero(2, 2);
  Q(1, 1) = 0.2;
  const ErrorVector d = (ErrorVector(2) << 0.1, -0.2).finished();
  later.BackOver(Phi, Q, d);
  later.Add(OfSum(-0.5));
  const Eigen::MatrixXd P = Eigen::MatrixXd::Identity(2, 2);
  const Eigen::VectorXd m = Eigen::VectorXd::Ones(2);
  Eigen::MatrixXd H(2, 2);
  H.row(0) = Eigen::RowVector2d(1.0, 1.0);
  H.row(1) = Eigen::RowVector2d(1.0, 1.0) * Eigen::MatrixXd(Phi);
  Eigen::Matrix2d S = H * P * H.transpose() + Eigen::Matrix2d::Identity();
  S(1, 1) += Q.sum();
  const Eigen::Vector2d off =
      Eigen::Vector2d(-0.5, 0.3) - H * m - Eigen::Vector2d(0.0, d.sum());
  EXPECT_NEAR(LogMeanOf(later),
              -0.5 * off.dot(S.inverse() * off) -
                  0.5 * std::log(S.determinant()) - std::log(2.0 * M_PI),
              1e-12);
}

}  // namespace
}  // namespace hindsight
