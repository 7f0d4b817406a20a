#ifndef HINDSIGHT_SIMULATION_MOTION_PROFILE_H_
#define HINDSIGHT_SIMULATION_MOTION_PROFILE_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

namespace hindsight {

/// One manoeuvre. A rate (of speed, heading or pitch) rises from zero to its
/// value over `blend`, holds, and falls to zero over `blend`, along 3s^2 -
/// 2s^3, so that body rates and specific force are continuous and
/// differentiable. With blend = 0 the rate steps, as in much of the literature.
struct Segment {
  enum class Kind {
    kStraight,    ///< speed, heading and pitch are held for `duration`
    kStop,        ///< brakes at `rate` if it moves, stands for `duration`
    kAccelerate,  ///< changes speed to `speed` at `rate`
    kTurn,        ///< changes heading by `angle` at `rate`
    kPitch,       ///< changes pitch and path angle by `angle` at `rate`
  };
  Kind kind = Kind::kStraight;
  double duration = 0.0;  ///< [s]
  double speed = 0.0;     ///< [m/s]
  double angle = 0.0;     ///< [rad]; positive to the right, and nose up
  double rate = 0.0;      ///< > 0 [m/s^2] or [rad/s]
  double blend = 1.0;     ///< [s]
  /// Coordinated turn: tan(roll) = speed cos(pitch) heading' / g, so that the
  /// specific force has no lateral part; needs blend > 0.
  bool banked = false;

  static Segment Straight(double duration);
  static Segment Stop(double duration, double deceleration = 2.0);
  static Segment Accelerate(double speed, double acceleration);
  static Segment Turn(double angle, double rate);
  static Segment BankedTurn(double angle, double rate);
  static Segment Pitch(double angle, double rate);
};

/// Speed along the forward axis and Euler angles (ZYX) against level axes, with
/// their derivatives; [m/s], [rad], per second.
struct BodyMotion {
  double speed = 0.0, speed_rate = 0.0;
  double roll = 0.0, roll_rate = 0.0;
  double pitch = 0.0, pitch_rate = 0.0;
  double heading = 0.0, heading_rate = 0.0;

  /// Velocity and its derivative in the level axes.
  Eigen::Vector3d Velocity() const;
  Eigen::Vector3d Acceleration() const;
  /// Body to level axes.
  Eigen::Quaterniond Attitude() const;
  /// Rate of the body against the level axes, in body axes [rad/s].
  Eigen::Vector3d BodyRate() const;
};

/// A sequence of segments as an analytic function of time, t = 0 at the start.
class MotionProfile {
 public:
  /// Throws InputError naming the segment (counted from 1) that cannot be
  /// driven: a rate or duration that is not positive, a turn with bank and no
  /// blend, a pitch beyond 85 deg, a negative speed.
  MotionProfile(const std::vector<Segment>& segments, double start_speed,
                double start_heading);

  double duration() const { return pieces_.back().t_end; }

  /// Beyond the end the last speed and attitude are held.
  BodyMotion At(double t) const;

  /// Times at which a derivative of the motion may jump, ascending.
  const std::vector<double>& knots() const { return knots_; }

 private:
  struct Piece {
    Segment::Kind kind = Segment::Kind::kStraight;
    bool banked = false;
    double t_begin = 0.0, t_end = 0.0;
    double speed = 0.0, heading = 0.0, pitch = 0.0;  ///< at t_begin
    double rate = 0.0;   ///< signed plateau of the ramped quantity
    double blend = 0.0;  ///< [s]
  };

  void Append(const Segment& segment, std::size_t number);
  void AppendHold(double duration);
  void AppendRamp(const Segment& segment, double change, Segment::Kind kind);

  std::vector<Piece> pieces_;
  std::vector<double> knots_;
  BodyMotion end_;
  mutable std::size_t hint_ = 0;
};

}  // namespace hindsight

#endif  // HINDSIGHT_SIMULATION_MOTION_PROFILE_H_
