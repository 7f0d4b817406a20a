#ifndef HINDSIGHT_ALIGNMENT_MOTION_VECTORS_H_
#define HINDSIGHT_ALIGNMENT_MOTION_VECTORS_H_

#include <Eigen/Core>
#include <vector>

#include "alignment/alignment.h"

namespace hindsight {

/// Velocities, or positions if there are none, as vectors over a window. In the
/// inertial axes that coincide with e at t_0, and the body axes b_0 of t_0,
/// with E = Exp(w_ie (t - t_0)), V = E (v + w_ie x p), P = E p and gravitation
/// gamma, a point at lever arm l obeys exactly
///   velocity  V - int E gamma      = V_0 + C (dv + dR (w_ib x l)),
///   position  P - int int E gamma  = P_0 + V_0 (t - t_0) + C (dp + dR l),
/// with C = C_eb(t_0) and dR, dv, dp the IMU's integrals from t_0 on: the
/// Earth's rotation, transport and gravity are all in it (Wu and Pan 2013,
/// Velocity/Position Integration Formula, parts I and II, in inertial instead
/// of navigation axes). The constants V_0 and P_0 are free.
struct MotionVector {
  double t = 0.0;
  Eigen::Vector3d a;  ///< left side [m/s] or [m]
  Eigen::Vector3d b;  ///< what C turns
  /// Change of b with (true - used) gyro (0-2) and accelerometer bias (3-5).
  Eigen::Matrix<double, 3, 6> J;
  double sigma = 0.0;  ///< of a, an axis
};

struct MotionVectors {
  bool of_velocity = false;
  std::vector<MotionVector> vectors;
};

/// The motion in [input.t, t_end], integrated at the given biases. Velocities
/// come from velocity fixes alone; where there are none positions are taken.
MotionVectors CollectMotion(const AlignmentInput& input, double t_end,
                            const Eigen::Vector3d& b_g,
                            const Eigen::Vector3d& b_a);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_MOTION_VECTORS_H_
