#ifndef HINDSIGHT_IMU_IMU_LINK_H_
#define HINDSIGHT_IMU_IMU_LINK_H_

#include "imu/preintegration.h"
#include "state/state.h"

namespace hindsight {

/// Calibration of the IMU as the state has it; scale factors only if the
/// layout estimates them.
ImuCalibration CalibrationOf(const ErrorLayout& layout, const State& x);

/// Distance over the ground from x in dt [m], for blocks that change with it:
/// |v| dt, at least 1 cm/s, since water and wind change of themselves too.
double Travelled(const State& x, double dt);

/// The state at t_j that the summary and the Earth predict from x_i. Biases and
/// parameters decay as their evolutions say.
///   P_j = p_i + V_i dt + R_i dp + dt^2 (g_i/3 + g_j/6),
///   V_j = V_i + R_i dv + dt (g_i + g_j)/2,   R_j = R_i dR,
/// in the inertial axes that coincide with e at t_i; V = v + w_ie x p, g is
/// gravitation; then turned back into e by E(dt)^-1.
State Predict(const ErrorLayout& layout, const State& x_i,
              const ImuSummary& summary);

/// The parameters alone, after dt from x_i, as their evolutions say.
void PredictParameters(const ErrorLayout& layout, const State& x_i, double dt,
                       State* x_j);

/// The five navigation blocks (p, v, psi, b_g, b_a) of the link between two
/// states, linearised at both:
///   r(x_i [+] d_i, x_j [+] d_j) = residual + J_i d_i + J_j d_j + J_s d_s
///                               = noise.
/// Rows: r_p [m] and r_v [m/s] in body axes at t_i, r_R [rad] in body axes at
/// t_j, bias defects. d_s are the scale factors (gyro, accelerometer) at t_i.
struct ImuLink {
  using Vector15 = Eigen::Matrix<double, 15, 1>;
  using Matrix15 = Eigen::Matrix<double, 15, 15>;
  Vector15 residual;
  Matrix15 J_i, J_j;
  Eigen::Matrix<double, 15, 6> J_s;
};

/// `jacobians` false fills the residual only.
void EvaluateLink(const ErrorLayout& layout, const ImuSummary& summary,
                  const State& x_i, const State& x_j, bool jacobians,
                  ImuLink* out);

/// Covariance of the link's residual, the noise of the summary completed by the
/// bias noise. Of a position at least (1e-6 m)^2, which is more than accelerometers
/// leave in less than some 20 ms: in normal equations a position that is known to
/// a metre is the difference of two numbers that are larger by the square of the
/// ratio, and double precision has 16 digits.
ImuLink::Matrix15 LinkNoise(const ImuSummary& summary);

/// The link as a linear transition over a layout:
///   d_j = Phi d_i + c + w,  w ~ (0, Q),
/// Phi = -J_j^-1 J_i, c = -J_j^-1 r, Q = J_j^-1 S J_j^-T; blocks beyond the
/// navigation state follow their own evolutions. With x_j = Predict(x_i) c = 0.
struct Transition {
  ErrorMatrix Phi;
  ErrorMatrix Q;
  ErrorVector c;
};
void LinearizeTransition(const ErrorLayout& layout, const ImuSummary& summary,
                         const State& x_i, const State& x_j, Transition* out);
/// The same with another S than LinkNoise of the summary.
void LinearizeTransition(const ErrorLayout& layout, const ImuSummary& summary,
                         const ImuLink::Matrix15& S, const State& x_i,
                         const State& x_j, Transition* out);

}  // namespace hindsight

#endif  // HINDSIGHT_IMU_IMU_LINK_H_
