#include "alignment/magnetic_heading.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "alignment/levelling.h"
#include "dataset/magnetic_check.h"
#include "geometry/so3.h"
#include "imu/preintegration.h"
#include "measurements/sensor_kind.h"

namespace hindsight {
namespace {

constexpr double kSurroundings = 2.0 * kDegree;

/// Mean field in the body axes of input.t.
struct MeanField {
  Eigen::Vector3d m_b = Eigen::Vector3d::Zero();  ///< [uT]
  double sigma = 0.0;                             ///< of one reading [uT]
  int count = 0;
};

MeanField MeanFieldOf(const AlignmentInput& input, const AidingStream& stream,
                      double t_end) {
  ImuIntegrator integrator(input.dataset.imu);
  ImuCalibration calibration;
  calibration.b_g = input.b_g;
  MeanField mean;
  for (const Measurement& z : stream.measurements) {
    const double t = z.t + stream.sensor.time_offset;
    const auto* field = std::get_if<MagneticField>(&z.model);
    if (field == nullptr || z.withheld || t < input.t || t > t_end) continue;
    Eigen::Quaterniond dR = Eigen::Quaterniond::Identity();
    if (t > input.t) {
      dR = integrator.Summarize(input.t, t, calibration).dR;
    }
    mean.m_b += dR * (field->field_b - stream.sensor.magnetic.hard_iron_b);
    mean.sigma = field->sigma;
    ++mean.count;
  }
  if (mean.count > 0) mean.m_b /= mean.count;
  return mean;
}

double SigmaOf(const MagneticSurroundings& magnetic, double reading,
               double tilt) {
  const double dip = std::abs(magnetic.down) / magnetic.horizontal;
  return std::min(
      kUnknownHeadingSigma,
      std::hypot(std::hypot(kSurroundings, tilt * dip),
                 reading / magnetic.horizontal, SharedHeadingSigma(magnetic)));
}

}  // namespace

double SharedHeadingSigma(const MagneticSurroundings& magnetic) {
  const double hard_iron =
      magnetic.hard_iron_sigma ? magnetic.hard_iron_sigma->maxCoeff() : 0.0;
  return std::hypot(
      hard_iron / magnetic.horizontal,
      magnetic.disturbance_sigma.value_or(0.0) / magnetic.horizontal,
      magnetic.declination_sigma.value_or(0.0));
}

AlignmentOutcome AlignByMagnetometer(const AlignmentInput& input) {
  constexpr double kWithoutRest = 1.0;  // [s]
  const double t_end =
      std::min(input.to, input.rest ? input.rest->end : input.t + kWithoutRest);
  for (const AidingStream& stream : input.dataset.streams) {
    if (!stream.sensor.kind->magnetic) continue;
    const MeanField mean = MeanFieldOf(input, stream, t_end);
    if (mean.count == 0) continue;
    AlignedAttitude out = LevelAttitude(input);
    const Eigen::Vector3d level = out.q_nb * mean.m_b;
    const std::string wrong = FieldContradiction(level, input.p_e);
    if (!wrong.empty()) {
      return {std::nullopt, stream.sensor.name + ": " + wrong};
    }
    const double heading =
        stream.sensor.magnetic.declination - std::atan2(level.y(), level.x());
    const double tilt = std::sqrt(out.P(0, 0));
    TurnToHeading(WrapAngle(heading),
                  SigmaOf(stream.sensor.magnetic, mean.sigma, tilt), &out);
    out.heading = fmt::format("magnetic field, {} readings of {}", mean.count,
                              stream.sensor.name);
    return {out, ""};
  }
  return {std::nullopt, "no magnetometer readings at the start"};
}

}  // namespace hindsight
