#include "simulation/motion_profile.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/units.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

constexpr double kMaxPitch = 85.0 * kDegree;

/// Integral, value and derivative of a rate that rises, holds and falls.
struct Ramp {
  double change = 0.0;
  double rate = 0.0;
  double rate_rate = 0.0;
};

Ramp EvaluateRise(double rate, double blend, double u) {
  const double s = u / blend;
  const double s2 = s * s;
  return {rate * blend * s2 * s * (1.0 - 0.5 * s), rate * s2 * (3.0 - 2.0 * s),
          rate * 6.0 * s * (1.0 - s) / blend};
}

Ramp EvaluateRamp(double rate, double blend, double duration, double u) {
  const double left = duration - u;
  if (left <= 0.0) return {rate * (duration - blend), 0.0, 0.0};
  if (u < blend) return EvaluateRise(rate, blend, u);
  if (left < blend) {
    const Ramp rise = EvaluateRise(rate, blend, left);
    return {rate * (duration - blend) - rise.change, rise.rate,
            -rise.rate_rate};
  }
  return {rate * (u - 0.5 * blend), rate, 0.0};
}

}  // namespace

Segment Segment::Straight(double duration) {
  Segment s;
  s.duration = duration;
  return s;
}

Segment Segment::Stop(double duration, double deceleration) {
  Segment s;
  s.kind = Kind::kStop;
  s.duration = duration;
  s.rate = deceleration;
  return s;
}

Segment Segment::Accelerate(double speed, double acceleration) {
  Segment s;
  s.kind = Kind::kAccelerate;
  s.speed = speed;
  s.rate = acceleration;
  return s;
}

Segment Segment::Turn(double angle, double rate) {
  Segment s;
  s.kind = Kind::kTurn;
  s.angle = angle;
  s.rate = rate;
  return s;
}

Segment Segment::BankedTurn(double angle, double rate) {
  Segment s = Turn(angle, rate);
  s.banked = true;
  return s;
}

Segment Segment::Pitch(double angle, double rate) {
  Segment s = Turn(angle, rate);
  s.kind = Kind::kPitch;
  return s;
}

Eigen::Vector3d BodyMotion::Velocity() const {
  const double horizontal = speed * std::cos(pitch);
  return {horizontal * std::cos(heading), horizontal * std::sin(heading),
          -speed * std::sin(pitch)};
}

Eigen::Vector3d BodyMotion::Acceleration() const {
  const double cp = std::cos(pitch);
  const double sp = std::sin(pitch);
  const double ch = std::cos(heading);
  const double sh = std::sin(heading);
  const double along = speed_rate * cp - speed * sp * pitch_rate;
  const double across = speed * cp * heading_rate;
  return {along * ch - across * sh, along * sh + across * ch,
          -speed_rate * sp - speed * cp * pitch_rate};
}

Eigen::Quaterniond BodyMotion::Attitude() const {
  return QuaternionFromEuler(roll, pitch, heading);
}

Eigen::Vector3d BodyMotion::BodyRate() const {
  const double cr = std::cos(roll);
  const double sr = std::sin(roll);
  const double level = heading_rate * std::cos(pitch);
  return {roll_rate - heading_rate * std::sin(pitch),
          pitch_rate * cr + level * sr, level * cr - pitch_rate * sr};
}

MotionProfile::MotionProfile(const std::vector<Segment>& segments,
                             double start_speed, double start_heading) {
  if (segments.empty()) {
    throw InputError("the list of segments is empty, expected at least one");
  }
  if (!(start_speed >= 0.0)) {
    throw InputError("the speed at the start is negative");
  }
  end_.speed = start_speed;
  end_.heading = start_heading;
  knots_.push_back(0.0);
  for (std::size_t k = 0; k < segments.size(); ++k) Append(segments[k], k + 1);
  knots_.erase(std::unique(knots_.begin(), knots_.end()), knots_.end());
}

void MotionProfile::Append(const Segment& s, std::size_t number) {
  const auto require = [&](bool good, const char* message) {
    if (good) return;
    throw InputError("segment " + std::to_string(number) + ": " + message);
  };
  require(s.blend >= 0.0, "the blend time is negative");
  const bool holds = s.kind == Segment::Kind::kStraight;
  const bool stops = s.kind == Segment::Kind::kStop;
  require(holds || s.rate > 0.0, "the rate is not positive");
  require(!(holds || stops) || s.duration > 0.0,
          "the duration is not positive");
  switch (s.kind) {
    case Segment::Kind::kStraight:
      AppendHold(s.duration);
      break;
    case Segment::Kind::kStop:
      AppendRamp(s, -end_.speed, Segment::Kind::kAccelerate);
      AppendHold(s.duration);
      break;
    case Segment::Kind::kAccelerate:
      require(s.speed >= 0.0, "the speed to reach is negative");
      AppendRamp(s, s.speed - end_.speed, s.kind);
      break;
    case Segment::Kind::kTurn:
      require(!s.banked || s.blend > 0.0,
              "a banked turn needs a blend time, for roll cannot step");
      AppendRamp(s, s.angle, s.kind);
      break;
    case Segment::Kind::kPitch:
      AppendRamp(s, s.angle, s.kind);
      require(std::abs(end_.pitch) <= kMaxPitch, "the pitch passes 85 deg");
      break;
  }
}

void MotionProfile::AppendHold(double duration) {
  Piece piece;
  piece.t_begin = knots_.back();
  piece.t_end = piece.t_begin + duration;
  piece.speed = end_.speed;
  piece.heading = end_.heading;
  piece.pitch = end_.pitch;
  pieces_.push_back(piece);
  knots_.push_back(piece.t_end);
}

void MotionProfile::AppendRamp(const Segment& s, double change,
                               Segment::Kind kind) {
  if (change == 0.0) {
    // A stop while standing and a change to the same value take no time.
    if (pieces_.empty()) AppendHold(0.0);
    return;
  }
  const double plateau_time = std::abs(change) / s.rate;
  Piece piece;
  piece.kind = kind;
  piece.banked = s.banked;
  piece.t_begin = knots_.back();
  // A change too small to reach its rate within the blend blends faster.
  piece.blend = std::min(s.blend, plateau_time);
  piece.t_end = piece.t_begin + plateau_time + piece.blend;
  piece.speed = end_.speed;
  piece.heading = end_.heading;
  piece.pitch = end_.pitch;
  piece.rate = std::copysign(s.rate, change);
  pieces_.push_back(piece);
  if (piece.blend > 0.0) {
    knots_.push_back(piece.t_begin + piece.blend);
    knots_.push_back(piece.t_end - piece.blend);
  }
  knots_.push_back(piece.t_end);
  if (kind == Segment::Kind::kAccelerate) end_.speed += change;
  if (kind == Segment::Kind::kTurn) end_.heading += change;
  if (kind == Segment::Kind::kPitch) end_.pitch += change;
}

BodyMotion MotionProfile::At(double t) const {
  if (t >= pieces_.back().t_end) return end_;
  if (!(pieces_[hint_].t_begin <= t && t < pieces_[hint_].t_end)) {
    const auto it = std::upper_bound(
        pieces_.begin(), pieces_.end(), t,
        [](double value, const Piece& p) { return value < p.t_end; });
    hint_ = static_cast<std::size_t>(it - pieces_.begin());
  }
  const Piece& piece = pieces_[hint_];
  BodyMotion m;
  m.speed = piece.speed;
  m.heading = piece.heading;
  m.pitch = piece.pitch;
  if (piece.kind == Segment::Kind::kStraight) return m;
  const Ramp ramp = EvaluateRamp(
      piece.rate, piece.blend, piece.t_end - piece.t_begin, t - piece.t_begin);
  if (piece.kind == Segment::Kind::kAccelerate) {
    m.speed += ramp.change;
    m.speed_rate = ramp.rate;
  } else if (piece.kind == Segment::Kind::kPitch) {
    m.pitch += ramp.change;
    m.pitch_rate = ramp.rate;
  } else {
    m.heading += ramp.change;
    m.heading_rate = ramp.rate;
    if (piece.banked) {
      const double lateral = m.speed * std::cos(m.pitch) / kStandardGravity;
      const double tangent = lateral * ramp.rate;
      m.roll = std::atan(tangent);
      m.roll_rate = lateral * ramp.rate_rate / (1.0 + tangent * tangent);
    }
  }
  return m;
}

}  // namespace hindsight
