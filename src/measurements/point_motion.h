#ifndef HINDSIGHT_MEASUREMENTS_POINT_MOTION_H_
#define HINDSIGHT_MEASUREMENTS_POINT_MOTION_H_

#include "measurements/model.h"

namespace hindsight {

/// A linear map of a vector in e to the rows of a measurement.
using RowTimes3 = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMaxRows, 3>;

/// Motion of a sensor's mounting point at the state's time, and its
/// sensitivities: what the lever-arm and time-offset terms of every model come
/// from. Earth frame e.
///   p = p_e + C_eb l,   v = v_e + C_eb (w_eb x l),
///   w_eb = (w_ib - b_g)/(1 + s_g) - C_be w_ie,
///   a = C_eb ((f - b_a)/(1 + s_a) + w_eb x (w_eb x l)) + g - 2 w_ie x v_e;
/// a leaves out the change of w_eb.
struct PointMotion {
  Eigen::Matrix3d C_en;  ///< at the state's position
  Eigen::Matrix3d C_eb;
  Eigen::Vector3d l_b;
  Eigen::Vector3d w_ib_b;  ///< calibrated [rad/s]
  Eigen::Vector3d w_eb_b;  ///< [rad/s]
  /// Over the Earth [m/s^2]; zero unless a time offset is estimated.
  Eigen::Vector3d a_e;
  Eigen::Vector3d p_e;
  Eigen::Vector3d v_e;
};

PointMotion MotionOfSensor(const ModelContext& context);

/// Adds A * dp/d(error) to H, for any A (rows x 3) that acts on vectors in e.
void AddPositionColumns(const ModelContext& context, const PointMotion& motion,
                        const RowTimes3& A, RowJacobian* H);

/// Adds A * dv/d(error) to H.
void AddVelocityColumns(const ModelContext& context, const PointMotion& motion,
                        const RowTimes3& A, RowJacobian* H);

/// Adds A * dw_eb/d(error) to H, for any A that acts on vectors in b.
void AddBodyRateColumns(const ModelContext& context, const PointMotion& motion,
                        const RowTimes3& A, RowJacobian* H);

/// Rotation of the NED axes with position: C_en(p + C_en dr) =
/// C_en(p) (I + [theta x]), theta = NedTurn dr [rad/m].
Eigen::Matrix3d NedTurn(const Eigen::Vector3d& p_e);

}  // namespace hindsight

#endif  // HINDSIGHT_MEASUREMENTS_POINT_MOTION_H_
