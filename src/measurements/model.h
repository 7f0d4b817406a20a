#ifndef HINDSIGHT_MEASUREMENTS_MODEL_H_
#define HINDSIGHT_MEASUREMENTS_MODEL_H_

#include "imu/kinematics.h"
#include "measurements/sensor.h"
#include "state/state.h"

namespace hindsight {

/// Everything a model may look at. `kinematics` is the raw IMU reading of the
/// instant: a model subtracts the state's biases itself.
struct ModelContext {
  const ErrorLayout& layout;
  const State& state;
  const Kinematics& kinematics;
  const Sensor& sensor;
  int sensor_index = 0;  ///< the sensor's blocks in the layout
  double stamp = 0.0;    ///< of the measurement, time offset not applied [s]
  /// Rate of the prediction with the sensor's estimated time offset along a
  /// known trajectory (TimeOffsetRate), or nullptr while none is known.
  const RowVector* offset_rate = nullptr;
};

/// A measurement about a state: residual = measured - predicted,
/// predicted(x [+] d) ~ predicted(x) + H d, noise covariance R.
struct LinearizedMeasurement {
  RowVector residual;
  RowJacobian H;
  RowMatrix R;

  void Resize(int rows, int dim) {
    residual.resize(rows);
    H.setZero(rows, dim);
    R.setZero(rows, rows);
  }
};

/// The white covariance of a measurement whose stated one is R: where the
/// layout has its error as coloured states, white_sigma^2 takes the place of
/// R's rows and columns of the active axes. Nothing changes without such states
/// or for a sensor of white noise.
Eigen::Matrix3d WhiteCovariance(const ModelContext& context,
                                const Eigen::Matrix3d& R);

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_MODEL_H_
