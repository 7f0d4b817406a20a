#ifndef HINDSIGHT_STATE_STATE_H_
#define HINDSIGHT_STATE_STATE_H_

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "state/error_layout.h"

namespace hindsight {

/// The navigation state at time t and the parameters that are estimated beside
/// it. Frames: e is ECEF (WGS-84), b is body forward-right-down, at the IMU.
struct State {
  double t = 0.0;  ///< [s] since the epoch of the data set
  Eigen::Vector3d p_e = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d v_e = Eigen::Vector3d::Zero();  ///< [m/s], over the Earth
  Eigen::Quaterniond q_eb = Eigen::Quaterniond::Identity();
  Eigen::Vector3d b_g = Eigen::Vector3d::Zero();  ///< measured - true [rad/s]
  Eigen::Vector3d b_a = Eigen::Vector3d::Zero();  ///< measured - true [m/s^2]
  /// Full blocks of the layout beyond the navigation state, at
  /// Block::parameter_offset.
  ParameterVector parameters;

  Eigen::Matrix3d C_en() const { return NedAxes(p_e); }
  Eigen::Vector3d v_n() const { return C_en().transpose() * v_e; }
  /// (roll, pitch, heading) [rad].
  Eigen::Vector3d euler() const {
    return EulerFromQuaternion(
        Eigen::Quaterniond(C_en().transpose() * q_eb.toRotationMatrix()));
  }
};

/// A state from the quantities people use: geodetic position, NED velocity
/// [m/s], (roll, pitch, heading) [rad].
State MakeState(double t, const Geodetic& position, const Eigen::Vector3d& v_n,
                const Eigen::Vector3d& euler);

/// Value of a three- or one-component parameter block, or `fallback` if the
/// layout does not estimate it.
Eigen::Vector3d Parameter3(const ErrorLayout& layout, const State& x,
                           BlockKind kind, int sensor,
                           const Eigen::Vector3d& fallback);
double Parameter1(const ErrorLayout& layout, const State& x, BlockKind kind,
                  int sensor, double fallback);

/// x [+] d, the tangent of all estimators. d is truth minus estimate, resolved
/// in the NED axes C_en at x.p_e:
///   p = p^ + C_en dr,  v = v^ + C_en dv,  C_eb = Exp(C_en psi) C^_eb,
///   b = b^ + db, every other block additive.
State Retract(const ErrorLayout& layout, const State& x, const ErrorVector& d);

/// The d for which Retract(reference, d) = x, in the axes at reference.
/// Masked components are dropped.
ErrorVector Local(const ErrorLayout& layout, const State& reference,
                  const State& x);

/// Transport of the tangent at `from` to the tangent at `to`:
/// T = d Local(to, Retract(from, d)) / d d, at the d that leads from one to the
/// other. Covariances follow P_to = T P_from T'.
ErrorMatrix Transport(const ErrorLayout& layout, const State& from,
                      const State& to);

}  // namespace hindsight

#endif  // HINDSIGHT_STATE_STATE_H_
