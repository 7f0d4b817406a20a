#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "linear/sparse_product.h"
#include "receiver_errors/error_chain.h"

namespace hindsight {
namespace {

/// ln of the density under a covariance that rounding has made indefinite.
constexpr double kIndefinite = -1e9;

double LogDensity(const Eigen::Vector3d& r, const Eigen::Matrix3d& S) {
  const Eigen::LLT<Eigen::Matrix3d> llt(S);
  if (llt.info() != Eigen::Success) return kIndefinite;
  const Eigen::Vector3d whitened = llt.matrixL().solve(r);
  return -0.5 * whitened.squaredNorm() -
         llt.matrixLLT().diagonal().array().log().sum() -
         1.5 * std::log(2.0 * kPi);
}

}  // namespace

ErrorChain::FixView ErrorChain::ViewOf(const Gaussian& x) const {
  const int n = navigation_dim_;
  const LinearizedMeasurement& z = z_[static_cast<std::size_t>(fix_)];
  const auto H = z.H.leftCols(n);
  const RowJacobian HP_n =
      TimesTransposed(x.P.topLeftCorner(n, n), H).transpose();
  FixView view;
  view.innovation.head(rows_) = z.residual - H * x.mean.head(n);
  view.S.topLeftCorner(rows_, rows_) = HP_n * H.transpose();
  if (x.mean.size() == n) return view;
  view.P_ze.topRows(rows_) = H.lazyProduct(x.P.block(0, n, n, 3));
  view.e = x.mean.segment<3>(n);
  view.P_ee = x.P.block<3, 3>(n, n);
  if (x.mean.size() == n + 3) return view;
  view.P_zr.topRows(rows_) = H.lazyProduct(x.P.block(0, n + 3, n, 3));
  view.r = x.mean.segment<3>(n + 3);
  view.P_er = x.P.block<3, 3>(n, n + 3);
  view.P_rr = x.P.block<3, 3>(n + 3, n + 3);
  return view;
}

ErrorChain::FixLikelihood ErrorChain::LikelihoodAfter(
    ErrorStep step, const FixView& view) const {
  return Likelihood(DynamicsOf(parameters_, step, dt_, unseen_), step, view);
}

ErrorChain::FixLikelihood ErrorChain::Likelihood(const ErrorDynamics& d,
                                                 ErrorStep step,
                                                 const FixView& view) const {
  const LinearizedMeasurement& z = z_[static_cast<std::size_t>(fix_)];
  const Eigen::Matrix3d& E = by_error_;
  const Eigen::Vector3d innovation =
      view.innovation - E * (d.ee * view.e + d.er * view.r);
  const Eigen::Matrix3d cross =
      (d.ee * view.P_ze + d.er * view.P_zr) * E.transpose();
  Eigen::Matrix3d P_ee = d.ee * d.ee * view.P_ee + d.er * d.er * view.P_rr +
                         d.ee * d.er * (view.P_er + view.P_er.transpose());
  P_ee.diagonal() += ErrorVariances(d);
  Eigen::Matrix3d S =
      view.S + cross + cross.transpose() + E * P_ee * E.transpose();
  if (velocity_ >= 0 && d.q_vv > 0.0) {
    const GrowthMoments moved = tape_.unseen_step(k_).Grown(step.onset);
    const auto H_p = z.H.middleCols(position_, 3);
    const auto H_v = z.H.middleCols(velocity_, 3);
    const RowJacobian H_pv = H_p * H_v.transpose();
    S.topLeftCorner(rows_, rows_) +=
        d.q_vv *
        (moved.square * H_p * H_p.transpose() +
         moved.by_rate * (H_pv + H_pv.transpose()) + H_v * H_v.transpose());
  }
  return Weigh(innovation, S, step.outlier);
}

ErrorChain::FixLikelihood ErrorChain::Weigh(const Eigen::Vector3d& innovation,
                                            const Eigen::Matrix3d& S,
                                            bool outlier) const {
  const double a = parameters_.outlier_share;
  const double in = std::log1p(-a) + LogDensity(innovation, S + R_in_);
  if (a == 0.0) return {in, false, std::numeric_limits<double>::infinity()};
  const double out = std::log(a) + LogDensity(innovation, S + R_out_);
  if (outlier) return {out, true, in - out};
  const double largest = std::max(in, out);
  return {largest + std::log1p(std::exp(-std::abs(in - out))), out > in,
          in - out};
}

}  // namespace hindsight
