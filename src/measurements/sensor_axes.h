#ifndef HINDSIGHT_MEASUREMENTS_SENSOR_AXES_H_
#define HINDSIGHT_MEASUREMENTS_SENSOR_AXES_H_

#include "measurements/point_motion.h"

namespace hindsight {

/// The axes s of a sensor, and their sensitivities: what every model that
/// measures in its own axes (odometer, DVL, acoustic bearing) shares.
///   C_se  = C_sb C_be,   C_sb = Exp(m) C_sb(nominal),
///   C_se' = -C_sb [w_eb x] C_be.
struct SensorAxes {
  Eigen::Vector3d m;  ///< mounting (boresight) rotation vector [rad]
  Eigen::Matrix3d C_sb;
  Eigen::Matrix3d C_se;
};

SensorAxes AxesOfSensor(const ModelContext& context, const PointMotion& motion);

/// Adds A * d(C_se u_e)/d(error) to H for a vector u_e held fixed in e and any
/// A (rows x 3) that acts on vectors in s.
void AddAxesColumns(const ModelContext& context, const PointMotion& motion,
                    const SensorAxes& axes, const Eigen::Vector3d& u_e,
                    const RowTimes3& A, RowJacobian* H);

/// Adds A * d(C_se v)/d(error) to H, v the velocity of the mounting point.
void AddSensorVelocityColumns(const ModelContext& context,
                              const PointMotion& motion, const SensorAxes& axes,
                              const RowTimes3& A, RowJacobian* H);

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_SENSOR_AXES_H_
