#include <algorithm>

#include "geometry/so3.h"
#include "imu/imu_link.h"
#include "problems/reconstruction.h"

namespace hindsight {
namespace {

/// Rate of the body over the Earth, body axes: the mean over 20 ms, since a
/// single reading of a cheap gyro is mostly noise.
Eigen::Vector3d BodyRate(const ErrorLayout& layout, const ImuStream& imu,
                         const State& x, ImuIntegrator* integrator) {
  constexpr double kHalf = 0.01;
  const double begin = std::max(x.t - kHalf, imu.t_begin());
  const double end = std::min(x.t + kHalf, imu.t_end());
  const Eigen::Vector3d w_ib_b =
      Log(integrator->Turn(begin, end, x.b_g)) / (end - begin);
  const Eigen::Array3d scale = CalibrationOf(layout, x).s_g;
  return (w_ib_b.array() / (1.0 + scale)).matrix() -
         x.q_eb.conjugate() * EarthRate_e();
}

}  // namespace

Solution MoveToPoint(const Solution& solution, const ImuStream& imu,
                     const Eigen::Vector3d& l_b) {
  Solution out = solution;
  ImuIntegrator integrator(imu);
  const ErrorLayout& layout = solution.layout;
  for (std::size_t k = 0; k < solution.states.size(); ++k) {
    const State& x = solution.states[k];
    const Eigen::Matrix3d C_en = x.C_en();
    const Eigen::Matrix3d C_eb = x.q_eb.toRotationMatrix();
    const Eigen::Vector3d w_eb_b = BodyRate(layout, imu, x, &integrator);
    const Eigen::Vector3d arm_e = C_eb * l_b;
    const Eigen::Vector3d velocity_e = C_eb * w_eb_b.cross(l_b);
    out.states[k].p_e += arm_e;
    out.states[k].v_e += velocity_e;
    if (solution.covariances.empty()) continue;
    ErrorMatrix J = ErrorMatrix::Identity(layout.dim(), layout.dim());
    const Block* position = layout.Find(BlockKind::kPosition);
    const Block* velocity = layout.Find(BlockKind::kVelocity);
    const Block* attitude = layout.Find(BlockKind::kAttitude);
    const Block* gyro_bias = layout.Find(BlockKind::kGyroBias);
    if (attitude != nullptr && attitude->dim == 3) {
      if (position != nullptr && position->dim == 3) {
        J.block<3, 3>(position->offset, attitude->offset) =
            -C_en.transpose() * Skew(arm_e) * C_en;
      }
      if (velocity != nullptr && velocity->dim == 3) {
        J.block<3, 3>(velocity->offset, attitude->offset) =
            -C_en.transpose() * Skew(velocity_e) * C_en;
      }
    }
    if (velocity != nullptr && velocity->dim == 3 && gyro_bias != nullptr) {
      J.block<3, 3>(velocity->offset, gyro_bias->offset) =
          C_en.transpose() * C_eb * Skew(l_b);
    }
    out.covariances.Set(
        k, ErrorMatrix(J * solution.covariances.Get(k) * J.transpose()));
  }
  return out;
}

Solution WithMountingSigma(Solution solution, const Eigen::Vector3d& sigma_b) {
  const Block* attitude = solution.layout.Find(BlockKind::kAttitude);
  if (sigma_b.isZero(0.0) || attitude == nullptr || attitude->dim != 3) {
    return solution;
  }
  for (std::size_t k = 0; k < solution.covariances.size(); ++k) {
    const State& x = solution.states[k];
    const Eigen::Matrix3d C_nb =
        x.C_en().transpose() * x.q_eb.toRotationMatrix();
    ErrorMatrix P = solution.covariances.Get(k);
    P.block<3, 3>(attitude->offset, attitude->offset) +=
        C_nb * sigma_b.cwiseAbs2().asDiagonal() * C_nb.transpose();
    solution.covariances.Set(k, P);
  }
  return solution;
}

}  // namespace hindsight
