#ifndef HINDSIGHT_FILTERS_INFORMATION_H_
#define HINDSIGHT_FILTERS_INFORMATION_H_

#include "state/error_layout.h"

namespace hindsight {

/// What later measurements say of a vector x: the quadratic form
/// -x' Y x / 2 + y' x of its log-likelihood, Y = P^-1, y = P^-1 x^. Starts at
/// zero, when nothing is known. Held as the square root |U x - z|^2 / 2, with
/// Y = U' U symmetric and positive semidefinite by construction and y = U' z,
/// and in units of `scale`, a typical standard deviation of each component:
/// metres, radians and m/s^2 side by side would cost eight digits. Arguments
/// and results are in plain units.
class Information {
 public:
  /// `scale` > 0 in every component.
  explicit Information(const ErrorVector& scale);

  /// Back over the interval x+ = Phi x + c + w, w ~ (0, Q):
  ///   Y <- Phi' (I + Y Q)^-1 Y Phi,   y <- Phi' (I + Y Q)^-1 (y - Y c),
  /// the exact discrete form of the differential equations (18), (19), (26) of
  /// Yu, Lee, Park and Han 2002. With L L' = I + U Q U':
  ///   U <- L^-1 U Phi,   z <- L^-1 (z - U c).
  void PropagateBack(const ErrorMatrix& Phi, const ErrorMatrix& Q,
                     const ErrorVector& c);

  /// To the variable u of x = T (u - shift).
  void Substitute(const ErrorMatrix& T, const ErrorVector& shift);

  /// Adds z = H x + v, v ~ (0, R): Y += H' R^-1 H, y += H' R^-1 z. Throws
  /// EstimationError if R is not positive definite.
  void Add(const RowJacobian& H, const RowMatrix& R, const RowVector& z);

  struct Estimate {
    ErrorVector mean;
    ErrorMatrix P;
  };
  /// Fusion with an independent estimate (m, P_f):
  ///   P_s = L (I + L' Y L)^-1 L',  L L' = P_f,   mean = m + P_s (y - Y m).
  /// P_s <= P_f by construction. Throws EstimationError if P_f is not positive
  /// definite.
  Estimate Fuse(const ErrorVector& m, const ErrorMatrix& P_f) const;

  /// What this information says alone, its mean as the difference from m:
  ///   P = Y^-1,   mean = P (y - Y m),
  /// Y with a prior of ten million scales, which keeps it regular and weighs
  /// nothing where measurements speak. A standard deviation beyond a million
  /// scales says that nothing is known.
  Estimate AloneAbout(const ErrorVector& m) const;

 private:
  ErrorVector scale_;
  ErrorMatrix U_;
  ErrorVector z_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_INFORMATION_H_
