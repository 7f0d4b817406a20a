#ifndef HINDSIGHT_FILTERS_LINEAR_KALMAN_H_
#define HINDSIGHT_FILTERS_LINEAR_KALMAN_H_

#include "filters/kalman.h"

namespace hindsight {

/// An estimate with its covariance.
struct Track {
  ErrorVector x;
  ErrorMatrix P;
};

/// A linear system as one sensor's filter sees it:
///   x_k = A x_(k-1) + w, w ~ (0, Q);   z = H x + v, v ~ (0, R).
struct LinearSensor {
  ErrorMatrix A;
  ErrorMatrix Q;
  RowJacobian H;
  RowMatrix R;
};

/// x <- A x, P <- A P A' + Q.
void Predict(const LinearSensor& sensor, Track* track);

/// Kalman update with the measurement z, Joseph form (filters/kalman.h).
void Correct(const LinearSensor& sensor, const RowVector& z, Track* track);

}  // namespace hindsight

#endif  // HINDSIGHT_FILTERS_LINEAR_KALMAN_H_
