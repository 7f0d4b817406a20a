#include "alignment/measured_heading.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "alignment/levelling.h"
#include "geometry/so3.h"
#include "imu/preintegration.h"
#include "measurements/heading.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

/// The baseline of one reading, in the body axes of the epoch.
struct CarriedReading {
  double heading = 0.0;  ///< [rad]
  double sigma = 0.0;    ///< [rad]
  Eigen::Vector3d b = Eigen::Vector3d::UnitX();
};

struct CarriedReadings {
  std::vector<CarriedReading> readings;
  double t_first = 0.0;
};

CarriedReadings Carry(const AlignmentInput& input, const AidingStream& stream) {
  constexpr double kWithoutRest = 1.0;  // [s]
  ImuIntegrator integrator(input.dataset.imu);
  ImuCalibration calibration;
  calibration.b_g = input.b_g;
  const Eigen::Vector3d b = stream.sensor.own_vector.normalized();
  CarriedReadings out;
  Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();
  double turned_to = input.t;
  for (const Measurement& z : stream.measurements) {
    const double t = z.t + stream.sensor.time_offset;
    if (z.withheld || t < input.t || t > input.to) continue;
    if (out.readings.empty()) {
      out.t_first = t;
    } else if (t > out.t_first + kWithoutRest &&
               !(input.rest && t <= input.rest->end)) {
      break;
    }
    if (t > turned_to) {
      turned = turned * integrator.Summarize(turned_to, t, calibration).dR;
      turned_to = t;
    }
    const auto& reading = std::get<GenericReading>(z.model);
    out.readings.push_back({reading.value(0), reading.sigma(0), turned * b});
  }
  return out;
}

/// Mean on the circle and how far single ones lie from it.
struct MeanHeading {
  double heading = 0.0;  ///< [rad]
  double scatter = 0.0;  ///< root mean square [rad]
  double sigma = 0.0;    ///< stated for one, the largest [rad]
};

MeanHeading MeanOf(const CarriedReadings& carried,
                   const Eigen::Quaterniond& q_level) {
  MeanHeading mean;
  std::vector<double> headings;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const CarriedReading& reading : carried.readings) {
    const double azimuth = DirectionOf(q_level * reading.b)(0);
    headings.push_back(reading.heading - azimuth);
    sum +=
        Eigen::Vector2d(std::cos(headings.back()), std::sin(headings.back()));
    mean.sigma = std::max(mean.sigma, reading.sigma);
  }
  mean.heading = std::atan2(sum.y(), sum.x());
  double squares = 0.0;
  for (const double heading : headings) {
    const double d = WrapAngle(heading - mean.heading);
    squares += d * d;
  }
  mean.scatter = std::sqrt(squares / static_cast<double>(headings.size()));
  return mean;
}

}  // namespace

AlignmentOutcome AlignByHeading(const AlignmentInput& input) {
  constexpr double kUpright = 0.1;  // horizontal part of the baseline
  constexpr double kBaseline = 1.0 * kDegree;
  for (const AidingStream& stream : input.dataset.streams) {
    if (!stream.sensor.kind->is_heading) continue;
    const CarriedReadings carried = Carry(input, stream);
    if (carried.readings.empty()) continue;
    AlignedAttitude out = LevelAttitude(input);
    const Eigen::Vector3d u = out.q_nb * carried.readings.front().b;
    const double horizontal = u.head<2>().norm();
    if (horizontal < kUpright) {
      return {std::nullopt,
              stream.sensor.name + ": its baseline stands upright"};
    }
    const MeanHeading mean = MeanOf(carried, out.q_nb);
    const double tilt =
        std::sqrt(out.P.topLeftCorner<2, 2>().diagonal().maxCoeff());
    const double elapsed = carried.t_first - input.t;
    const double drift = std::hypot(
        input.gyro_sigma * elapsed,
        input.dataset.imu.noise.gyro_noise_density * std::sqrt(elapsed));
    const double reading =
        std::hypot(std::max(mean.sigma, mean.scatter), kBaseline);
    const double sigma = std::hypot(reading, tilt * u.z() / horizontal, drift);
    TurnToHeading(mean.heading, std::min(sigma, kUnknownHeadingSigma), &out);
    out.heading = std::to_string(carried.readings.size()) + " readings of " +
                  stream.sensor.name;
    return {out, ""};
  }
  return {std::nullopt, "no readings of a heading at the start"};
}

}  // namespace hindsight
