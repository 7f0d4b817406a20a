#include "alignment/levelling.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "alignment/start_layout.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "imu/mean_reading.h"

namespace hindsight {
namespace {

constexpr double kAssumedLevelSigma = 5.0 * kDegree;
constexpr double kSway = 0.05 * kDegree;

}  // namespace

AlignedAttitude LevelAttitude(const AlignmentInput& input) {
  const ImuStream& imu = input.dataset.imu;
  const double end =
      input.rest ? input.rest->end : std::min(input.t + 1.0, input.to);
  const Eigen::Vector3d f = MeanReading(imu, input.t, end).f_b - input.b_a;
  AlignedAttitude out;
  out.q_nb =
      QuaternionFromEuler(std::atan2(-f.y(), -f.z()),
                          std::atan2(f.x(), std::hypot(f.y(), f.z())), 0.0);
  out.heading = "open";
  out.P(2, 2) = kUnknownHeadingSigma * kUnknownHeadingSigma;
  if (!input.rest) {
    out.attitude = "assumed near level, no rest at the start";
    out.P(0, 0) = out.P(1, 1) = kAssumedLevelSigma * kAssumedLevelSigma;
    return out;
  }
  const double rest = end - input.t;
  out.attitude = fmt::format("levelled at rest for {:.1f} s", rest);
  const double sway = std::hypot(kSway, imu.noise.accel_noise_density /
                                            std::sqrt(rest) / kStandardGravity);
  const Eigen::Matrix3d C_nb = out.q_nb.toRotationMatrix();
  Eigen::Matrix<double, 2, 3> M;
  M.row(0) = C_nb.row(1) / kStandardGravity;
  M.row(1) = -C_nb.row(0) / kStandardGravity;
  const Eigen::Matrix3d P_b = AccelBiasSigma(input.dataset.initial)
                                  .cwiseAbs2()
                                  .asDiagonal()
                                  .toDenseMatrix();
  out.P.topLeftCorner<2, 2>() = M * P_b * M.transpose();
  out.P(0, 0) += sway * sway;
  out.P(1, 1) += sway * sway;
  out.P_bias.block<2, 3>(0, 3) = M * P_b;
  return out;
}

void TurnToHeading(double heading, double sigma, AlignedAttitude* attitude) {
  const Eigen::Quaterniond turn = QuaternionFromEuler(0.0, 0.0, heading);
  const Eigen::Matrix3d C = turn.toRotationMatrix();
  attitude->q_nb = turn * attitude->q_nb;
  attitude->P(2, 2) = sigma * sigma;
  attitude->P = (C * attitude->P * C.transpose()).eval();
  attitude->P_bias = (C * attitude->P_bias).eval();
}

AlignmentOutcome AlignAtRest(const AlignmentInput& input) {
  if (!input.rest) return {std::nullopt, "no rest at the start"};
  AlignedAttitude attitude = LevelAttitude(input);
  attitude.heading = "unknown: levelling does not tell it";
  return {attitude, ""};
}

namespace {

double NoiseOfDrift(const ImuNoise& noise, double T) {
  return std::hypot(2.0 * noise.gyro_noise_density / std::sqrt(T),
                    noise.gyro_bias_walk * std::sqrt(T / 3.0));
}

/// GyroBiasAtRest of a reading whose bias drifts by `drift` over half the rest.
GyroBiasPrior CombineAtRest(const Dataset& dataset, const TimeInterval& rest,
                            double drift) {
  const double T = rest.length();
  const double reading = std::hypot(
      dataset.imu.noise.gyro_noise_density / std::sqrt(T), kEarthRate, drift);
  const Eigen::Array3d given =
      GyroBiasSigma(dataset.initial).array().square().inverse();
  const Eigen::Array3d information = given + 1.0 / (reading * reading);
  const Eigen::Vector3d& b_0 = dataset.initial.gyro_bias;
  const Eigen::Vector3d mean =
      MeanReading(dataset.imu, rest.begin, rest.end).w_ib_b;
  GyroBiasPrior out;
  out.b_g = mean + (given / information * (b_0 - mean).array()).matrix();
  out.sigma = information.rsqrt().matrix();
  return out;
}

}  // namespace

double DriftAtRest(const ImuStream& imu, const TimeInterval& rest) {
  constexpr double kThreeSigmas = 3.0;
  const double T = rest.length();
  const double middle = rest.begin + 0.5 * T;
  const double drift = (MeanReading(imu, middle, rest.end).w_ib_b -
                        MeanReading(imu, rest.begin, middle).w_ib_b)
                           .cwiseAbs()
                           .maxCoeff();
  return drift > kThreeSigmas * NoiseOfDrift(imu.noise, T) ? drift : 0.0;
}

GyroBiasPrior GyroBiasAtRest(const Dataset& dataset, const TimeInterval& rest) {
  return CombineAtRest(dataset, rest, DriftAtRest(dataset.imu, rest));
}

GyroBiasPrior GyroBiasAfterRest(const Dataset& dataset, TimeInterval rest) {
  constexpr double kShortest = 2.0;  // [s]
  double drift = DriftAtRest(dataset.imu, rest);
  const bool drifts = drift > 0.0;
  while (drift > 0.0 && rest.length() >= 2.0 * kShortest) {
    rest.begin += 0.5 * rest.length();
    drift = DriftAtRest(dataset.imu, rest);
  }
  if (drifts) {
    drift = std::max(drift, NoiseOfDrift(dataset.imu.noise, rest.length()));
  }
  return CombineAtRest(dataset, rest, drift);
}

}  // namespace hindsight
