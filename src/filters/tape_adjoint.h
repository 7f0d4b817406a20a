#ifndef HINDSIGHT_FILTERS_TAPE_ADJOINT_H_
#define HINDSIGHT_FILTERS_TAPE_ADJOINT_H_

#include <Eigen/Core>
#include <functional>

#include "filters/linear_tape.h"

namespace hindsight {

/// The adjoint of the filter on a tape about a fixed nominal, walked backward
/// from its end (Bryson and Frazier 1963): what the innovations from here on say
/// of the error of the predicted state,
///   before z:  lambda <- H' S^-1 nu + (I - K H)' lambda,
///              Lambda <- H' S^-1 H + (I - K H)' Lambda (I - K H),
///   before the interval:  lambda <- Phi' lambda,  Lambda <- Phi' Lambda Phi.
/// After all measurements of an epoch the smoothed covariance there is
///   P = P- - P- Lambda P-.
class TapeAdjoint {
 public:
  explicit TapeAdjoint(const LinearTape& tape)
      : lambda_(ErrorVector::Zero(tape.dim())),
        Lambda_(ErrorMatrix::Zero(tape.dim(), tape.dim())) {}

  const ErrorVector& lambda() const { return lambda_; }
  const ErrorMatrix& Lambda() const { return Lambda_; }

  /// Over an interval with that transition.
  void BackOver(const ErrorMatrix& Phi);
  /// Before an accepted measurement.
  void BackBefore(const TapeMeasurement& z);

 private:
  ErrorVector lambda_;
  ErrorMatrix Lambda_;
};

/// lambda before an accepted measurement, were its innovation nu.
ErrorVector LambdaBefore(const TapeMeasurement& z, const RowVector& nu,
                         const ErrorVector& lambda);

/// Calls `visit` with Lambda of each epoch from the last to the first, its own
/// measurements included. Requires a tape about a fixed nominal.
void ForEachLambda(
    const LinearTape& tape,
    const std::function<void(std::size_t k, const ErrorMatrix& Lambda)>& visit);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_TAPE_ADJOINT_H_
