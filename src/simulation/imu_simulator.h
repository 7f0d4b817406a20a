#ifndef HINDSIGHT_SIMULATION_IMU_SIMULATOR_H_
#define HINDSIGHT_SIMULATION_IMU_SIMULATOR_H_

#include <cstddef>

#include "imu/imu_stream.h"
#include "simulation/trajectory.h"

namespace hindsight {

/// Two-sample coning and sculling undone: the increments (integrals of angular
/// rate and specific force in body axes) that Integrate(RatesFromIncrements())
/// turns into exactly this rotation vector `phi` [rad] and velocity increment
/// `dv` [m/s] in the axes at the start of the sample. `previous` and its length
/// are the sample before. Fixed point; the rotation of one sample must be well
/// below 1 rad.
ImuSample InvertSample(double dt_previous, const ImuSample& previous, double dt,
                       const Eigen::Vector3d& phi, const Eigen::Vector3d& dv);

/// Perfect IMU samples of a trajectory, one after another at t_begin + k/rate,
/// the first at t_begin. Nothing is stored, so a day costs no memory.
///
/// Increments come from inverting the mechanisation on the rotating Earth
/// between exact states i and j, dt apart:
///   phi = Log(R_i' R_j),   dv = R_i' (V_j - V_i - dt (g_i + g_j)/2),
/// in the inertial axes that coincide with e at t_i: R_j = E C_j,
/// V = v + w_ie x p, E = Exp(w_ie dt), g gravitation; then InvertSample. The
/// first sample, whose interval lies before the motion, is the rate at t_begin
/// times dt.
///
/// Rates are the instantaneous w_ib_b and f_b.
class ImuSimulator {
 public:
  /// `trajectory` must outlive the object. rate_hz > 0.
  ImuSimulator(Trajectory* trajectory, ImuStream::Kind kind, double rate_hz,
               double t_end);

  /// Samples there will be.
  std::size_t size() const { return size_; }
  /// Fills the next sample and returns true, or returns false after the last.
  bool Next(ImuSample* sample);
  /// Motion at the stamp of the sample last returned.
  const Motion& motion() const { return motion_; }

 private:
  /// State at a stamp in the inertial axes that coincide with e there.
  struct Inertial {
    Eigen::Vector3d V = Eigen::Vector3d::Zero();
    Eigen::Vector3d gravitation = Eigen::Vector3d::Zero();
    Eigen::Quaterniond R = Eigen::Quaterniond::Identity();
  };
  static Inertial InertialOf(const Motion& motion);

  Trajectory* trajectory_;
  ImuStream::Kind kind_;
  double rate_hz_;
  std::size_t size_ = 0;
  std::size_t next_ = 0;
  Motion motion_;
  Inertial inertial_;
  ImuSample previous_;
  double previous_span_ = 0.0;  ///< [s]
};

}  // namespace hindsight

#endif  // HINDSIGHT_SIMULATION_IMU_SIMULATOR_H_
