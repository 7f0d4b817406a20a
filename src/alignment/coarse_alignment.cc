#include "alignment/coarse_alignment.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "alignment/start_layout.h"
#include "earth/wgs84.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

constexpr double kSegment = 20.0;  // [s]
constexpr std::size_t kFewestVelocities = 4;
constexpr int kTurns = 6;
constexpr double kUnknownAttitude = kPi * kPi / 3.0;  // [rad^2], uniform

using Rows3 = Eigen::Matrix<double, Eigen::Dynamic, 3>;
using Rows24 = Eigen::Matrix<double, Eigen::Dynamic, 24>;

/// Whitened vectors without their free constants, a row each: a, b and the
/// columns of J one after another.
struct ProjectedMotion {
  Rows24 rows;
  double freedom = 0.0;  ///< rows less free constants

  auto a() const { return rows.leftCols<3>(); }
  auto b() const { return rows.middleCols<3>(3); }
};

/// Takes from one segment's rows what the constants explain.
void ProjectOut(const std::vector<MotionVector>& v, std::size_t begin,
                std::size_t end, bool of_velocity, ProjectedMotion* out) {
  const auto n = static_cast<Eigen::Index>(end - begin);
  const Eigen::Index constants = of_velocity ? 1 : 2;
  Rows24 rows(n, 24);
  Eigen::MatrixXd basis(n, constants);
  for (Eigen::Index i = 0; i < n; ++i) {
    const MotionVector& m = v[begin + static_cast<std::size_t>(i)];
    rows.block<1, 3>(i, 0) = m.a.transpose() / m.sigma;
    rows.block<1, 3>(i, 3) = m.b.transpose() / m.sigma;
    for (int column = 0; column < 6; ++column) {
      rows.block<1, 3>(i, 6 + 3 * column) =
          m.J.col(column).transpose() / m.sigma;
    }
    basis(i, 0) = 1.0 / m.sigma;
    if (!of_velocity) basis(i, 1) = (m.t - v[begin].t) / m.sigma;
  }
  // Positions of 6.4e6 m would otherwise leave their rounding.
  const Eigen::RowVectorXd first = rows.row(0) * v[begin].sigma;
  rows -= basis.col(0) * first;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(basis);
  const Eigen::MatrixXd Q =
      qr.householderQ() * Eigen::MatrixXd::Identity(n, constants);
  rows -= (Q * (Q.transpose() * rows)).eval();
  const Eigen::Index old = out->rows.rows();
  out->rows.conservativeResize(old + n, 24);
  out->rows.bottomRows(n) = rows;
  out->freedom += static_cast<double>(n - constants);
}

ProjectedMotion Project(const MotionVectors& motion) {
  ProjectedMotion out;
  out.rows.resize(0, 24);
  const std::vector<MotionVector>& v = motion.vectors;
  std::size_t begin = 0;
  while (begin < v.size()) {
    std::size_t end = begin;
    while (end < v.size() && v[end].t <= v[begin].t + kSegment) ++end;
    if (end - begin >= kFewestVelocities) {
      ProjectOut(v, begin, end, motion.of_velocity, &out);
    }
    begin = end;
  }
  return out;
}

/// Normal equations of attitude (axes of e) and both biases.
struct NormalEquations {
  Eigen::Matrix<double, 9, 9> N = Eigen::Matrix<double, 9, 9>::Zero();
  Eigen::Matrix<double, 9, 1> g = Eigen::Matrix<double, 9, 1>::Zero();
  double cost = 0.0;  ///< sum of squared residuals
};

NormalEquations Linearize(const ProjectedMotion& motion,
                          const Eigen::Matrix3d& C) {
  NormalEquations out;
  for (Eigen::Index i = 0; i < motion.rows.rows(); ++i) {
    const Eigen::Vector3d turned = C * motion.b().row(i).transpose();
    const Eigen::Vector3d r = motion.a().row(i).transpose() - turned;
    Eigen::Matrix<double, 3, 9> A;
    A.leftCols<3>() = -Skew(turned);
    for (int column = 0; column < 6; ++column) {
      A.col(3 + column) =
          C * motion.rows.block<1, 3>(i, 6 + 3 * column).transpose();
    }
    out.N.noalias() += A.transpose() * A;
    out.g.noalias() += A.transpose() * r;
    out.cost += r.squaredNorm();
  }
  return out;
}

}  // namespace

std::optional<CoarseAlignment> AlignCoarsely(const AlignmentInput& input,
                                             double t_end,
                                             const Eigen::Vector3d& b_g,
                                             const Eigen::Vector3d& b_a) {
  const InitialState& given = input.dataset.initial;
  Eigen::Matrix<double, 6, 1> mean, weight;
  const GyroBiasPrior gyro = GyroBiasBefore(input);
  mean << gyro.b_g, given.accel_bias;
  weight << gyro.sigma.cwiseAbs2().cwiseInverse(),
      AccelBiasSigma(given).cwiseAbs2().cwiseInverse();
  CoarseAlignment out;
  out.b_g = b_g;
  out.b_a = b_a;
  for (int turn = 0; turn < kTurns; ++turn) {
    const MotionVectors motion = CollectMotion(input, t_end, out.b_g, out.b_a);
    const ProjectedMotion projected = Project(motion);
    if (projected.freedom < static_cast<double>(kFewestVelocities))
      return std::nullopt;
    const VectorMatch match =
        MatchVectors(projected.a().transpose() * projected.b());
    out.q_eb = match.q;
    out.count = motion.vectors.size();

    NormalEquations normal = Linearize(projected, match.q.toRotationMatrix());
    const double scale = std::max(1.0, normal.cost / (3.0 * projected.freedom));
    normal.N /= scale;
    normal.g /= scale;
    Eigen::Matrix<double, 6, 1> bias;
    bias << out.b_g, out.b_a;
    normal.N.diagonal().head<3>().array() += 1.0 / kUnknownAttitude;
    normal.N.diagonal().tail<6>() += weight;
    normal.g.tail<6>() += weight.cwiseProduct(mean - bias);
    const Eigen::LDLT<Eigen::Matrix<double, 9, 9>> ldlt(normal.N);
    const Eigen::Matrix<double, 9, 1> step = ldlt.solve(normal.g);
    const Eigen::Matrix3d C_ne = NedAxes(input.p_e).transpose();
    const Eigen::Matrix<double, 9, 9> P =
        ldlt.solve(Eigen::Matrix<double, 9, 9>::Identity());
    out.P = C_ne * P.topLeftCorner<3, 3>() * C_ne.transpose();
    out.ambiguity = 2.0 * match.gaps(0) / scale;
    out.ambiguous_axis = C_ne * match.axes.col(0);
    const bool settled = step.tail<6>().cwiseAbs2().dot(weight) < 1e-6;
    out.b_g += step.segment<3>(3);
    out.b_a += step.tail<3>();
    if (settled) break;
  }
  return out;
}

}  // namespace hindsight
