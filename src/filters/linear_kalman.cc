#include "filters/linear_kalman.h"

namespace hindsight {

void Predict(const LinearSensor& sensor, Track* track) {
  track->x = (sensor.A * track->x).eval();
  PredictCovariance(sensor.A, sensor.Q, &track->P);
}

void Correct(const LinearSensor& sensor, const RowVector& z, Track* track) {
  // The error-state update about the origin is the linear one.
  LinearizedMeasurement measurement;
  measurement.residual = z;
  measurement.H = sensor.H;
  measurement.R = sensor.R;
  Update(measurement, Innovate(measurement, track->x, track->P), &track->x,
         &track->P);
}

}  // namespace hindsight
