#include "simulation/wandering_drive.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/units.h"

namespace hindsight {
namespace {

/// Seconds that a segment takes at least, blending aside.
double LeastDuration(const Segment& s, double speed) {
  switch (s.kind) {
    case Segment::Kind::kStraight:
      return s.duration;
    case Segment::Kind::kStop:
      return s.duration + speed / s.rate;
    case Segment::Kind::kAccelerate:
      return std::abs(s.speed - speed) / s.rate;
    case Segment::Kind::kTurn:
    case Segment::Kind::kPitch:
      return std::abs(s.angle) / s.rate;
  }
  return 0.0;
}

}  // namespace

std::vector<Segment> WanderingDrive(double duration, std::uint64_t seed) {
  constexpr double kLateralAcceleration = 2.7;
  Random random(seed);
  const auto draw = [&](double low, double high) {
    return low + (high - low) * random.Uniform();
  };
  // One draw a statement: compilers differ in the order within one.
  const auto either_way = [&](double low, double high) {
    const double sign = random.Uniform() < 0.5 ? -1.0 : 1.0;
    return sign * draw(low, high);
  };
  std::vector<Segment> segments;
  double total = 0.0;
  double speed = 0.0;
  const auto add = [&](const Segment& s) {
    total += LeastDuration(s, speed);
    if (s.kind == Segment::Kind::kAccelerate) speed = s.speed;
    if (s.kind == Segment::Kind::kStop) speed = 0.0;
    segments.push_back(s);
  };
  const auto turn = [&](double angle) {
    const double fastest = kLateralAcceleration / speed;
    add(Segment::Turn(angle, std::min(fastest, draw(10.0, 20.0) * kDegree)));
  };
  const auto accelerate = [&](double slowest, double fastest, double rate) {
    add(Segment::Accelerate(draw(slowest, fastest), rate));
  };
  add(Segment::Stop(5.0));
  while (total < duration) {
    accelerate(9.0, 20.0, draw(1.0, 2.2));
    add(Segment::Straight(draw(4.0, 15.0)));
    const double bend = either_way(5.0, 35.0) * kDegree;
    turn(bend);
    add(Segment::Straight(draw(2.0, 12.0)));
    if (random.Uniform() < 0.5) {
      const double slope = either_way(1.0, 4.0) * kDegree;
      add(Segment::Pitch(slope, 2.0 * kDegree));
      add(Segment::Straight(draw(3.0, 10.0)));
      add(Segment::Pitch(-slope, 2.0 * kDegree));
    }
    accelerate(6.0, 9.0, draw(1.2, 2.5));
    turn(either_way(45.0, 110.0) * kDegree);
    if (random.Uniform() < 0.25) add(Segment::Stop(draw(5.0, 15.0)));
  }
  return segments;
}

}  // namespace hindsight
