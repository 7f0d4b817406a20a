#ifndef HINDSIGHT_SIMULATION_TRAJECTORY_H_
#define HINDSIGHT_SIMULATION_TRAJECTORY_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "earth/wgs84.h"
#include "imu/kinematics.h"
#include "simulation/motion_profile.h"
#include "state/motion.h"

namespace hindsight {

/// What a perfect IMU reads at that instant:
///   w_ib_b = w_eb_b + C_be w_ie,   f_b = C_be (a_e + 2 w_ie x v_e - g(p_e)).
Kinematics TrueKinematics(const Motion& motion);

/// A true motion as a function of time.
class Trajectory {
 public:
  virtual ~Trajectory() = default;
  virtual double t_begin() const = 0;
  virtual double t_end() const = 0;
  /// Motion at t in [t_begin, t_end]. Ascending calls are the fast ones.
  virtual Motion At(double t) = 0;
};

/// Drives a MotionProfile over the ellipsoid. The forward axis lies along the
/// velocity. Headings count from axes that start as north-east-down and are
/// then carried along without turning about the vertical, so that a straight
/// segment at constant height is a geodesic and poles are places like any
/// other.
class SegmentTrajectory : public Trajectory {
 public:
  /// `grid_hz`: position is integrated over steps of this rate, split at the
  /// knots of the profile; times t = k/grid_hz are the cheapest to ask for.
  /// Error of the position against the integral of the velocity: rounding,
  /// below 1e-6 m after 30 min.
  SegmentTrajectory(const Geodetic& start, MotionProfile profile,
                    double grid_hz);

  double t_begin() const override { return 0.0; }
  double t_end() const override { return profile_.duration(); }
  Motion At(double t) override;

 private:
  /// Position and carried axes, with the local curvature of the ellipsoid.
  struct Place {
    Eigen::Vector3d p_e;
    /// Rounding of p_e, carried so that it does not add up over a day.
    Eigen::Vector3d p_e_rest = Eigen::Vector3d::Zero();
    Eigen::Quaterniond q_ew;
    Eigen::Matrix3d C_en;
    double meridian_radius = 0.0;    ///< at height [m]
    double transverse_radius = 0.0;  ///< at height [m]
  };

  static void Locate(Place* place);
  /// Rotation vector in e of the level axes over the displacement d_e; given a
  /// velocity it is their rate.
  static Eigen::Vector3d LevelRotation(const Place& place,
                                       const Eigen::Vector3d& d_e);
  void Advance(double from, double to, Place* place) const;
  void Step(double from, double to, Place* place) const;
  void MoveTo(std::size_t grid_index);
  double GridTime(std::size_t index) const {
    return static_cast<double>(index) / grid_hz_;
  }

  MotionProfile profile_;
  double grid_hz_;
  std::vector<Place> checkpoints_;  ///< at every kCheckpointEvery-th grid time
  std::size_t index_ = 0;           ///< grid time at which place_ holds
  Place place_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_SIMULATION_TRAJECTORY_H_
