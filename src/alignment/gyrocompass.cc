#include "alignment/gyrocompass.h"

#include <fmt/core.h>

#include <cmath>

#include "alignment/levelling.h"
#include "alignment/start_layout.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"
#include "imu/mean_reading.h"

namespace hindsight {
namespace {

constexpr double kLargestSigma = 20.0 * kDegree;

}  // namespace

AlignmentOutcome AlignByGyrocompass(const AlignmentInput& input) {
  if (!input.rest) return {std::nullopt, "no rest at the start"};
  const Dataset& dataset = input.dataset;
  AlignedAttitude out = LevelAttitude(input);
  const double T = input.rest->end - input.t;
  const Eigen::Vector3d rate =
      out.q_nb * (MeanReading(dataset.imu, input.t, input.rest->end).w_ib_b -
                  dataset.initial.gyro_bias);
  const Eigen::Vector3d W_n = NedAxes(input.p_e).transpose() * EarthRate_e();
  TurnToHeading(std::atan2(-rate.y(), rate.x()), 0.0, &out);

  const Eigen::Matrix3d C_nb = out.q_nb.toRotationMatrix();
  const Eigen::RowVector3d by_gyro_bias = C_nb.row(1) / W_n.x();
  const double by_tilt = W_n.z() / W_n.x();
  const Eigen::Matrix3d P_g =
      GyroBiasSigma(dataset.initial).cwiseAbs2().asDiagonal().toDenseMatrix();
  const double noise =
      dataset.imu.noise.gyro_noise_density / std::sqrt(T) / W_n.x();
  const Eigen::Matrix2d P_tilt = out.P.topLeftCorner<2, 2>();
  out.P.row(2).head<2>() = by_tilt * P_tilt.row(0);
  out.P.col(2).head<2>() = out.P.row(2).head<2>().transpose();
  out.P(2, 2) = by_tilt * by_tilt * P_tilt(0, 0) + noise * noise +
                by_gyro_bias * P_g * by_gyro_bias.transpose();
  out.P_bias.block<1, 3>(2, 0) = by_gyro_bias * P_g;
  out.P_bias.block<1, 3>(2, 3) = by_tilt * out.P_bias.block<1, 3>(0, 3);

  const double sigma = std::sqrt(out.P(2, 2));
  if (!(sigma < kLargestSigma)) {
    return {
        std::nullopt,
        sigma > kPi
            ? fmt::format("the gyros are too noisy to find north within "
                          "{:.1f} s of rest; give initial.attitude, or a "
                          "stream of velocities or headings",
                          T)
            : fmt::format("the gyros would give the heading to {:.3g} deg only",
                          sigma / kDegree)};
  }
  out.heading = fmt::format("the Earth's rate over {:.1f} s", T);
  return {out, ""};
}

}  // namespace hindsight
