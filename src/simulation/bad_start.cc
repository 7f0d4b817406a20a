#include "simulation/bad_start.h"

#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "geometry/so3.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

/// Random streams, clear of those of sensors and initial values.
constexpr std::uint64_t kBadStartStream = 200;
constexpr std::uint64_t kMountStream = 201;

}  // namespace

void GiveBadStart(const BadStart& start, std::uint64_t seed, Dataset* dataset) {
  Random random(seed, kBadStartStream);
  const double direction = 2.0 * kPi * random.Uniform();
  const double side = random.Uniform() < 0.5 ? -1.0 : 1.0;
  const Eigen::Vector3d tilt(start.tilt * std::cos(direction),
                             start.tilt * std::sin(direction), 0.0);
  const Eigen::Vector3d heading(0.0, 0.0, side * start.heading);
  const TruthPoint truth = dataset->truth.front();
  InitialState& initial = dataset->initial;
  initial.euler =
      EulerFromQuaternion(Exp(-tilt) * Exp(-heading) * truth.q_nb.value());
  initial.attitude_sigma =
      Eigen::Vector3d(start.tilt, start.tilt, start.heading);
  for (const AidingStream& stream : dataset->streams) {
    if (stream.measurements.empty()) continue;
    const Measurement z = stream.measurements.front();
    if (!std::holds_alternative<VelocityFix>(z.model)) continue;
    const auto first = std::get<VelocityFix>(z.model);
    initial.v_n = first.v_n;
    initial.velocity_sigma = first.R_n.diagonal().cwiseSqrt();
    return;
  }
  throw InputError("a start with a bad attitude needs a sensor of velocity");
}

void MountAnywhere(std::uint64_t seed, Dataset* dataset) {
  Random random(seed, kMountStream);
  Eigen::Vector4d v;
  for (int i = 0; i < 4; ++i) v(i) = random.Normal();
  const Eigen::Quaterniond q_bm = Eigen::Quaterniond(v).normalized();
  for (ImuSample& sample : dataset->imu.samples) {
    sample.gyro = q_bm * sample.gyro;
    sample.accel = q_bm * sample.accel;
  }
  for (TruthPoint& truth : dataset->truth.Edited()) {
    truth.q_nb = *truth.q_nb * q_bm.conjugate();
    truth.b_g = q_bm * *truth.b_g;
    truth.b_a = q_bm * *truth.b_a;
  }
}

}  // namespace hindsight
