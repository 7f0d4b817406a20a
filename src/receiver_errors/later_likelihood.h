#ifndef HINDSIGHT_RECEIVER_ERRORS_LATER_LIKELIHOOD_H_
#define HINDSIGHT_RECEIVER_ERRORS_LATER_LIKELIHOOD_H_

#include "filters/mixing.h"
#include "measurements/model.h"

namespace hindsight {

/// What the measurements after an instant say of the error x there,
///   ln L(x) = c - |U x - z|^2 / 2,
/// the backward filter of a two-filter smoother in square root form.
class LaterLikelihood {
 public:
  /// Of no measurement, over n errors.
  explicit LaterLikelihood(int n)
      : U_(ErrorMatrix::Zero(n, n)), z_(ErrorVector::Zero(n)) {}
  LaterLikelihood(ErrorMatrix U, ErrorVector z, double c)
      : U_(std::move(U)), z_(std::move(z)), c_(c) {}

  const ErrorMatrix& U() const { return U_; }
  const ErrorVector& z() const { return z_; }
  double c() const { return c_; }

  void AddConstant(double c) { c_ += c; }

  /// Adds a measurement at the instant. Throws EstimationError if its noise is
  /// not positive definite.
  void Add(const LinearizedMeasurement& y);

  /// Back over x+ = Phi x + d + w, w ~ (0, Q): with G G' = I + U Q U',
  ///   c <- c - ln det G,   z <- G^-1 (z - U d),   U <- G^-1 U Phi.
  void BackOver(const ErrorMatrix& Phi, const ErrorMatrix& Q,
                const ErrorVector& d);

  /// What is known of x together with (m, P) of all before: with S = I + U P U',
  ///   m + P U' S^-1 (z - U m),   P - P U' S^-1 U P.
  /// Components after those that (m, P) has are zero, here and below.
  Gaussian Joined(const Gaussian& before) const;

  /// ln E[L] over x ~ (m, P): with G G' = I + U P U',
  ///   c - ln det G - |G^-1 (z - U m)|^2 / 2;
  /// not finite where P is too near to singular for U.
  double LogMean(const Gaussian& before) const;

 private:
  ErrorMatrix U_;
  ErrorVector z_;
  double c_ = 0.0;
};

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_LATER_LIKELIHOOD_H_
