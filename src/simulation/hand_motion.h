#ifndef HINDSIGHT_SIMULATION_HAND_MOTION_H_
#define HINDSIGHT_SIMULATION_HAND_MOTION_H_

#include <array>
#include <cstdint>
#include <vector>

#include "simulation/trajectory.h"

namespace hindsight {

/// A motion of a hand, from rest to rest.
struct HandMotion {
  double duration =
      0.0;  ///< [s], at least kShortestHandMotion; 0: there is none
  std::uint64_t seed = 1;
};

/// It rests for 10 s at each end and rises and falls in 3 s.
inline constexpr double kShortestHandMotion = 30.0;

/// The motion of a sensor held in a hand: position, in north-east-down axes of
/// the start, and Euler angles are each a sum of sine waves with amplitudes,
/// frequencies and phases drawn from the seed, times an envelope that rises from
/// and falls to rest and has two continuous derivatives. Roll and pitch stay
/// within 60 deg. Sizes are those of the hands of the BROAD recordings (Laidig
/// et al., Data 2021) that neither rest nor hurry: rates of about 1.5 rad/s
/// and accelerations of about 2 m/s^2 in the root mean square of an axis, half
/// of their power below 1 Hz, excursions of some decimetres; a slow wave beside them
/// moves to and fro in a room.
class HandTrajectory : public Trajectory {
 public:
  HandTrajectory(const Geodetic& start, double heading, const HandMotion& hand);

  double t_begin() const override { return 0.0; }
  double t_end() const override { return duration_; }
  Motion At(double t) override;

 private:
  struct Wave {
    double amplitude = 0.0;
    double omega = 0.0;  ///< [rad/s]
    double phase = 0.0;  ///< [rad]
  };
  /// A quantity and its derivatives by time.
  struct Course {
    double value = 0.0;
    double rate = 0.0;
    double acceleration = 0.0;
  };
  using Waves = std::vector<Wave>;

  Course EnvelopeAt(double t) const;
  static Course SumOf(const Waves& waves, const Course& envelope, double t);

  double duration_;
  double heading_;
  Eigen::Vector3d p_e_;
  Eigen::Matrix3d C_en_;
  std::array<Waves, 3> position_;  ///< north, east, down [m]
  std::array<Waves, 3> euler_;     ///< roll, pitch, heading [rad]
};

}  // namespace hindsight

#endif  // HINDSIGHT_SIMULATION_HAND_MOTION_H_
