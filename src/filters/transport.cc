#include "filters/transport.h"

#include <Eigen/LU>

#include "filters/kalman.h"

namespace hindsight {
namespace {

/// Size of the leading part of T beyond which it is the identity.
Eigen::Index TurnedSize(const ErrorMatrix& T) {
  Eigen::Index size = T.rows();
  while (size > 0 && T(size - 1, size - 1) == 1.0 &&
         T.col(size - 1).head(size - 1).isZero(0.0) &&
         T.row(size - 1).head(size - 1).isZero(0.0)) {
    --size;
  }
  return size;
}

/// P <- A P A' with A the identity but for its leading part.
void Turn(const ErrorMatrix& A, ErrorMatrix* P) {
  const Eigen::Index size = A.rows();
  const ErrorMatrix rows = A * P->topRows(size);
  P->topRows(size) = rows;
  const ErrorMatrix columns = P->leftCols(size) * A.transpose();
  P->leftCols(size) = columns;
  Symmetrize(P);
}

}  // namespace

void MoveCovariance(const ErrorMatrix& T, ErrorMatrix* P) {
  const Eigen::Index size = TurnedSize(T);
  Turn(T.topLeftCorner(size, size), P);
}

WayBack::WayBack(const ErrorMatrix& T) {
  const Eigen::Index size = TurnedSize(T);
  if (size == 0) return;
  inverse_ = ErrorMatrix(T.topLeftCorner(size, size)).partialPivLu().inverse();
}

void WayBack::Move(ErrorVector* d, ErrorMatrix* P) const {
  const Eigen::Index size = inverse_.rows();
  if (size == 0) return;
  d->head(size) = (inverse_ * d->head(size)).eval();
  Turn(inverse_, P);
}

}  // namespace hindsight
