#include "alignment/attitude_start.h"

#include <algorithm>
#include <cmath>

#include "alignment/alignment.h"
#include "alignment/given.h"
#include "alignment/levelling.h"
#include "alignment/velocity_alignment.h"
#include "base/units.h"
#include "dataset/bias_sigma.h"
#include "dataset/ground_motion.h"
#include "dataset/magnetic_check.h"
#include "dataset/rest.h"
#include "geometry/so3.h"
#include "measurements/sensor_kind.h"

namespace hindsight {

const AidingStream* MagnetometerOf(const Dataset& dataset) {
  for (const AidingStream& stream : dataset.streams) {
    if (stream.sensor.kind->magnetic && !stream.measurements.empty()) {
      return &stream;
    }
  }
  return nullptr;
}

AttitudeFilterOptions FilterOptionsOf(const Dataset& dataset) {
  constexpr double kLowPass = 1.5;   // [s]
  constexpr double kUpdates = 10.0;  // in one correlation time
  const AhrsSettings& ahrs = dataset.ahrs;
  AttitudeFilterOptions options;
  if (const auto p_e = RoughPosition(dataset))
    options.place = PlaceOnEarth(*p_e);
  options.rule.name = ahrs.rule;
  options.rule.sigma = ahrs.accel_sigma;
  options.rule.limit = ahrs.gate;
  options.rule.lambda = ahrs.lambda;
  options.rule.N = ahrs.seconds
                       ? SamplesIn(*ahrs.seconds, MedianInterval(dataset.imu))
                       : ahrs.samples;
  options.low_pass_tau =
      ahrs.low_pass.value_or(ahrs.rule == "fixed" ? kLowPass : 0.0);
  options.accel_correlation_time = ahrs.correlation_time;
  options.magnetic_correlation_time = ahrs.correlation_time;
  options.update_interval = ahrs.correlation_time / kUpdates;
  options.rest_sigma = ahrs.rest_sigma;
  options.reference.enabled = ahrs.reject_disturbances;
  if (const AidingStream* stream = MagnetometerOf(dataset)) {
    const auto first =
        std::get<MagneticField>(stream->measurements.front().model);
    options.magnetic_sigma = first.sigma;
    options.magnetic_form = first.form;
    options.magnetic = stream->sensor.magnetic;
    const double norm =
        std::hypot(options.magnetic.horizontal, options.magnetic.down);
    options.dip_sigma =
        ahrs.reject_disturbances
            ? kUnknownDipSigma
            : options.magnetic.disturbance_sigma.value_or(0.0) / norm;
  }
  return options;
}

std::vector<MagneticSample> MagneticSamples(const Dataset& dataset) {
  std::vector<MagneticSample> samples;
  const AidingStream* stream = MagnetometerOf(dataset);
  if (stream == nullptr) return samples;
  samples.reserve(stream->measurements.size());
  for (const Measurement& z : stream->measurements) {
    if (z.withheld) continue;
    samples.push_back({z.t + stream->sensor.time_offset,
                       std::get<MagneticField>(z.model).field_b -
                           stream->sensor.magnetic.hard_iron_b});
  }
  return samples;
}

std::vector<HeadingSample> HeadingSamples(const Dataset& dataset) {
  std::vector<HeadingSample> samples;
  for (const AidingStream& stream : dataset.streams) {
    if (!stream.sensor.kind->is_heading) continue;
    for (const Measurement& z : stream.measurements) {
      if (z.withheld) continue;
      samples.push_back({z.t + stream.sensor.time_offset,
                         std::get<GenericReading>(z.model), &stream.sensor});
    }
  }
  std::stable_sort(
      samples.begin(), samples.end(),
      [](const HeadingSample& a, const HeadingSample& b) { return a.t < b.t; });
  return samples;
}

std::vector<VelocitySample> VelocitySamples(const Dataset& dataset) {
  std::vector<VelocitySample> samples;
  for (const AidingStream& stream : dataset.streams) {
    for (const Measurement& z : stream.measurements) {
      const auto* velocity = std::get_if<VelocityFix>(&z.model);
      if (velocity == nullptr || z.withheld) continue;
      samples.push_back({z.t + stream.sensor.time_offset, velocity->v_n,
                         velocity->R_n, stream.sensor.lever_arm_b});
    }
  }
  std::stable_sort(samples.begin(), samples.end(),
                   [](const VelocitySample& a, const VelocitySample& b) {
                     return a.t < b.t;
                   });
  return samples;
}

bool HeadingIsTold(const Dataset& dataset, const AlignedAttitude* found) {
  return found != nullptr || MagnetometerOf(dataset) != nullptr ||
         !HeadingSamples(dataset).empty() || dataset.initial.euler ||
         dataset.initial.heading;
}

std::optional<AlignedAttitude> AttitudeByVelocity(const Dataset& dataset,
                                                  const ImuStream& imu,
                                                  double to) {
  constexpr double kKnown = 20.0 * kDegree;
  if (VelocitySamples(dataset).empty()) return std::nullopt;
  AlignmentInput input{.dataset = dataset,
                       .t = std::max(imu.t_begin(), dataset.imu.t_begin()),
                       .to = std::min(to, imu.t_end()),
                       .p_e = FilterOptionsOf(dataset).place.p_e};
  input.velocities = GroundVelocities(dataset, input.t, input.to);
  input.b_g = dataset.initial.gyro_bias;
  input.b_a = dataset.initial.accel_bias;
  input.gyro_sigma = GyroBiasSigma(dataset.initial).maxCoeff();
  input.rest = RestFrom(input.t, FindRest(dataset).at_rest);
  if (input.rest) {
    const GyroBiasPrior resting = GyroBiasAtRest(dataset, *input.rest);
    input.b_g = resting.b_g;
    input.gyro_sigma = resting.sigma.maxCoeff();
  }
  const AlignmentOutcome outcome = AlignByVelocity(input);
  if (!outcome.found || !(outcome.found->P(2, 2) < kKnown * kKnown)) {
    return std::nullopt;
  }
  return outcome.found;
}

AttitudeState StartOfAttitude(const Dataset& dataset, const ImuStream& imu,
                              std::span<const MagneticSample> magnetic,
                              const AlignedAttitude* found) {
  constexpr double kSpan = 0.5;    // [s]
  constexpr double kExact = 1e-5;  // [rad]
  AttitudeState start;
  start.t = imu.t_begin();
  start.b_g = dataset.initial.gyro_bias;
  start.b_a = dataset.initial.accel_bias;
  Eigen::Vector3d f = Eigen::Vector3d::Zero();
  for (const ImuSample& sample : imu.samples) {
    if (sample.t > start.t + kSpan) break;
    f += sample.accel - start.b_a;
  }
  Eigen::Vector3d m = Eigen::Vector3d::Zero();
  double declination = 0.0;
  for (const MagneticSample& sample : magnetic) {
    if (sample.t > start.t + kSpan && !m.isZero(0.0)) break;
    m += sample.field_b;
  }
  if (const AidingStream* stream = MagnetometerOf(dataset)) {
    declination = stream->sensor.magnetic.declination;
  }
  const double roll = std::atan2(-f.y(), -f.z());
  const double pitch = std::atan2(f.x(), f.tail<2>().norm());
  const Eigen::Vector3d level = QuaternionFromEuler(roll, pitch, 0.0) * m;
  double heading = std::atan2(-level.y(), level.x()) + declination;
  if (m.isZero(0.0)) heading = dataset.initial.heading.value_or(0.0);
  start.q_nb = QuaternionFromEuler(roll, pitch, heading);
  const auto& euler = dataset.initial.euler;
  if (euler) {
    const double since = start.t - dataset.initial.t.value_or(start.t);
    start.q_nb = QuaternionFromEuler(euler->x(), euler->y(), euler->z()) *
                 Exp(since * (imu.samples.front().gyro - start.b_g));
  }
  Eigen::Vector3d sigma = dataset.initial.attitude_sigma.value_or(
      Eigen::Vector3d(5.0, 5.0, 10.0) * kDegree);
  if (m.isZero(0.0) && !dataset.initial.attitude_sigma) {
    // Counted from the start it is exact there.
    sigma.z() = HeadingSamples(dataset).empty() ? kExact : kUnknownHeadingSigma;
  }
  const Eigen::Vector3d bias_sigma = dataset.initial.gyro_bias_sigma.value_or(
      Eigen::Vector3d::Constant(0.5 * kDegree));
  // What is known exactly would leave the covariance singular.
  constexpr double kKnown = 1e-6;
  const Eigen::Vector3d scale_sigma =
      dataset.gyro_scale_sigma
          .value_or(Eigen::Vector3d::Constant(kGyroScaleSigma))
          .cwiseMax(kKnown);
  const Eigen::Vector3d accel_sigma =
      AccelBiasSigma(dataset.initial).cwiseMax(kKnown);
  start.P.diagonal() << sigma.cwiseAbs2(), bias_sigma.cwiseAbs2(),
      scale_sigma.cwiseAbs2(), accel_sigma.cwiseAbs2(), 0.0;
  if (euler) {
    start.P.topLeftCorner<3, 3>() = AttitudeCovariance(*euler, sigma);
  }
  const bool given = dataset.initial.euler || dataset.initial.attitude_sigma;
  if (found != nullptr && !given) {
    start.q_nb = found->q_nb;
    start.P.topLeftCorner<3, 3>() = found->reuse * found->reuse * found->P;
  }
  return start;
}

}  // namespace hindsight
