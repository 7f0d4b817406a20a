#ifndef HINDSIGHT_FILTERS_KALMAN_H_
#define HINDSIGHT_FILTERS_KALMAN_H_

#include "measurements/model.h"

namespace hindsight {

/// What a linear update found out about one measurement.
struct Innovation {
  RowVector residual;  ///< innovation: residual - H dx
  RowMatrix S;         ///< H P H' + R
  double nis = 0.0;    ///< residual' S^-1 residual
  double log_likelihood = 0.0;
};

/// The innovation of z about (dx, P). Throws EstimationError if S is not
/// positive definite.
Innovation Innovate(const LinearizedMeasurement& z, const ErrorVector& dx,
                    const ErrorMatrix& P);

using GainMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                                 kMaxErrorDim, kMaxRows>;

/// Kalman update of (dx, P) in place, covariance in Joseph form
/// (I - K H) P (I - K H)' + K R K', expanded so that it costs O(n^2 rows).
/// Returns the gain K.
GainMatrix Update(const LinearizedMeasurement& z, const Innovation& innovation,
                  ErrorVector* dx, ErrorMatrix* P);

/// P <- Phi P Phi' + Q, symmetric to the last bit.
void PredictCovariance(const ErrorMatrix& Phi, const ErrorMatrix& Q,
                       ErrorMatrix* P);

/// P <- (P + P')/2.
void Symmetrize(ErrorMatrix* P);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_KALMAN_H_
