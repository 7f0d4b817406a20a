#include "simulation/hand_motion.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

constexpr double kRest = 10.0;  // at each end [s]
constexpr double kRise = 3.0;   // from rest to the whole motion [s]

/// Waves of one quantity: how many, their frequencies [Hz], and the sum of their
/// amplitudes.
struct Band {
  int count = 0;
  double low = 0.0;
  double high = 0.0;
  double amplitude = 0.0;
};

}  // namespace

HandTrajectory::HandTrajectory(const Geodetic& start, double heading,
                               const HandMotion& hand)
    : duration_(hand.duration),
      heading_(heading),
      p_e_(EcefFromGeodetic(start)),
      C_en_(NedAxes(p_e_)) {
  Random random(hand.seed);
  const auto draw = [&](double low, double high) {
    return low + (high - low) * random.Uniform();
  };
  const auto add = [&](const Band& band, Waves* waves) {
    for (int i = 0; i < band.count; ++i) {
      Wave wave;
      wave.omega = 2.0 * kPi * draw(band.low, band.high);
      wave.phase = 2.0 * kPi * random.Uniform();
      wave.amplitude = band.amplitude / band.count;
      waves->push_back(wave);
    }
  };
  for (Waves& waves : position_) {
    add({.count = 1, .low = 0.03, .high = 0.08, .amplitude = 0.8}, &waves);
    add({.count = 3, .low = 0.4, .high = 1.2, .amplitude = 0.15}, &waves);
  }
  for (Waves& waves : euler_) {
    const bool heads = &waves == &euler_.back();
    add({.count = heads ? 1 : 0, .low = 0.02, .high = 0.06, .amplitude = 2.5},
        &waves);
    add({.count = 3, .low = 0.1, .high = 1.0, .amplitude = 60.0 * kDegree},
        &waves);
  }
}

HandTrajectory::Course HandTrajectory::EnvelopeAt(double t) const {
  const double middle = 0.5 * duration_;
  const double side = t < middle ? 1.0 : -1.0;
  const double u =
      std::clamp((std::min(t, duration_ - t) - kRest) / kRise, 0.0, 1.0);
  // 6 u^5 - 15 u^4 + 10 u^3
  return {u * u * u * (10.0 + u * (6.0 * u - 15.0)),
          side * 30.0 * u * u * (1.0 - u) * (1.0 - u) / kRise,
          60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) / (kRise * kRise)};
}

HandTrajectory::Course HandTrajectory::SumOf(const Waves& waves,
                                             const Course& envelope, double t) {
  Course sum;
  for (const Wave& wave : waves) {
    const double angle = wave.omega * t + wave.phase;
    const double s = wave.amplitude * std::sin(angle);
    const double c = wave.amplitude * wave.omega * std::cos(angle);
    sum.value += s;
    sum.rate += c;
    sum.acceleration -= wave.omega * wave.omega * s;
  }
  return {envelope.value * sum.value,
          envelope.rate * sum.value + envelope.value * sum.rate,
          envelope.acceleration * sum.value + 2.0 * envelope.rate * sum.rate +
              envelope.value * sum.acceleration};
}

Motion HandTrajectory::At(double t) {
  const Course envelope = EnvelopeAt(t);
  Eigen::Vector3d p_n, v_n, a_n, euler, euler_rate;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto row = static_cast<Eigen::Index>(axis);
    const Course position = SumOf(position_[axis], envelope, t);
    p_n(row) = position.value;
    v_n(row) = position.rate;
    a_n(row) = position.acceleration;
    const Course angle = SumOf(euler_[axis], envelope, t);
    euler(row) = angle.value;
    euler_rate(row) = angle.rate;
  }
  euler.z() += heading_;
  Motion m;
  m.t = t;
  m.p_e = p_e_ + C_en_ * p_n;
  m.v_e = C_en_ * v_n;
  m.a_e = C_en_ * a_n;
  m.q_eb = (Eigen::Quaterniond(C_en_) *
            QuaternionFromEuler(euler.x(), euler.y(), euler.z()))
               .normalized();
  const double sr = std::sin(euler.x()), cr = std::cos(euler.x());
  const double sp = std::sin(euler.y()), cp = std::cos(euler.y());
  m.w_eb_b = {euler_rate.x() - sp * euler_rate.z(),
              cr * euler_rate.y() + sr * cp * euler_rate.z(),
              -sr * euler_rate.y() + cr * cp * euler_rate.z()};
  return m;
}

}  // namespace hindsight
