#include "attitude/accel_bias_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

namespace hindsight {

namespace {

/// A second's mean of (C_nb f_b)_z + g, by what it weighs.
struct VerticalForce {
  Eigen::Vector4d by_unknowns = Eigen::Vector4d::Zero();  ///< b, c
  double value = 0.0;                                     ///< [m/s^2]
  double variance = 0.0;
};

std::vector<VerticalForce> MeansOf(const ImuStream& imu,
                                   std::span<const Eigen::Quaterniond> q_nb,
                                   double gravity,
                                   const Eigen::Vector3d& known) {
  constexpr double kMean = 1.0;    // [s]
  constexpr double kLeast = 0.02;  // of a mean [m/s^2]
  std::vector<VerticalForce> means;
  VerticalForce sum;
  double squares = 0.0;
  std::size_t begin = 0;
  for (std::size_t k = 0; k < q_nb.size(); ++k) {
    const Eigen::Vector3d down_b =
        q_nb[k].conjugate() * Eigen::Vector3d::UnitZ();
    const double force = down_b.dot(imu.samples[k].accel - known) + gravity;
    sum.by_unknowns += Eigen::Vector4d(down_b.x(), down_b.y(), down_b.z(), 1.0);
    sum.value += force;
    squares += force * force;
    if (imu.samples[k].t - imu.samples[begin].t < kMean) continue;
    const auto count = static_cast<double>(k + 1 - begin);
    VerticalForce mean;
    mean.by_unknowns = sum.by_unknowns / count;
    mean.value = sum.value / count;
    mean.variance = squares / count - mean.value * mean.value + kLeast * kLeast;
    means.push_back(mean);
    sum = {};
    squares = 0.0;
    begin = std::min(k + 1, q_nb.size() - 1);
  }
  return means;
}

}  // namespace

AccelBiasFit FitAccelBias(const ImuStream& imu,
                          std::span<const Eigen::Quaterniond> q_nb,
                          double gravity, const Eigen::Vector3d& known) {
  constexpr double kSigmas = 3.0;
  constexpr std::size_t kLeast = 20;
  constexpr double kWidest = 10.0;  // [m/s^2]
  const std::vector<VerticalForce> means = MeansOf(imu, q_nb, gravity, known);
  AccelBiasFit fit;
  if (means.size() < kLeast) return fit;
  Eigen::Matrix4d N = Eigen::Matrix4d::Identity() / (kWidest * kWidest);
  Eigen::Vector4d y = Eigen::Vector4d::Zero();
  for (const VerticalForce& mean : means) {
    N += mean.by_unknowns * mean.by_unknowns.transpose() / mean.variance;
    y += mean.by_unknowns * mean.value / mean.variance;
  }
  const Eigen::LDLT<Eigen::Matrix4d> ldlt(N);
  const Eigen::Vector4d x = ldlt.solve(y);
  double squares = 0.0;
  for (const VerticalForce& mean : means) {
    const double residual = mean.value - mean.by_unknowns.dot(x);
    squares += residual * residual / mean.variance;
  }
  const double excess =
      std::max(1.0, squares / static_cast<double>(means.size() - 4));
  const Eigen::Matrix4d P = excess * ldlt.solve(Eigen::Matrix4d::Identity());
  const Eigen::Vector3d b_a = x.head<3>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(
      Eigen::Matrix3d(P.topLeftCorner<3, 3>()));
  const Eigen::Vector3d along = axes.eigenvectors().transpose() * b_a;
  for (int i = 0; i < 3; ++i) {
    const double sigmas = std::abs(along(i)) / std::sqrt(axes.eigenvalues()(i));
    fit.significance += sigmas * sigmas;
    if (sigmas > kSigmas) fit.b_a += along(i) * axes.eigenvectors().col(i);
  }
  return fit;
}

}  // namespace hindsight
