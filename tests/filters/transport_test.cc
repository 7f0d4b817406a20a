#include "filters/transport.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hindsight {
namespace {

constexpr int kDim = 7;

/// The identity but for its first `size` rows and columns.
ErrorMatrix Turning(int size) {
  ErrorMatrix T = ErrorMatrix::Identity(kDim, kDim);
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) T(i, j) += 0.1 * std::sin(1.0 + i + 3 * j);
  }
  return T;
}

ErrorMatrix Covariance() {
  ErrorMatrix A(kDim, kDim);
  for (int i = 0; i < kDim; ++i) {
    for (int j = 0; j < kDim; ++j) A(i, j) = std::cos(2.0 * i + 5.0 * j);
  }
  return A * A.transpose();
}

TEST(Transport, MovesCovarianceAsTheWholeMatrixDoes) {
  for (const int size : {0, 1, 4, kDim}) {
    const ErrorMatrix T = Turning(size);
    const ErrorMatrix P = Covariance();
    ErrorMatrix moved = P;
    MoveCovariance(T, &moved);
    EXPECT_LT((moved - T * P * T.transpose()).norm(), 1e-13 * P.norm()) << size;
    EXPECT_EQ(moved, ErrorMatrix(moved.transpose())) << size;
  }
}

TEST(Transport, TheWayBackUndoesIt) {
  for (const int size : {0, 1, 4, kDim}) {
    const ErrorMatrix T = Turning(size);
    const ErrorVector d = Covariance().col(2);
    ErrorMatrix P = Covariance();
    MoveCovariance(T, &P);
    ErrorVector moved = T * d;
    WayBack(T).Move(&moved, &P);
    EXPECT_LT((moved - d).norm(), 1e-13 * d.norm()) << size;
    EXPECT_LT((P - Covariance()).norm(), 1e-13 * P.norm()) << size;
  }
}

/// An entry far from the diagonal keeps a component in the turned part.
TEST(Transport, SeesCouplingOfTheLastComponent) {
  ErrorMatrix T = ErrorMatrix::Identity(kDim, kDim);
  T(0, kDim - 1) = 0.25;
  const ErrorMatrix P = Covariance();
  ErrorMatrix moved = P;
  MoveCovariance(T, &moved);
  EXPECT_LT((moved - T * P * T.transpose()).norm(), 1e-13 * P.norm());
}

}  // namespace
}  // namespace hindsight
