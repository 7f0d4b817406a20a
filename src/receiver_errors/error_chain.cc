#include "receiver_errors/error_chain.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "linear/small_product.h"
#include "linear/sparse_product.h"
#include "measurements/magnetic_field.h"

namespace hindsight {
namespace {

/// Smallest standard deviation of a fix, in its unit: less is beneath what
/// double precision resolves beside an error of kilometres.
constexpr double kLeastSigma = 1e-5;

/// H P of a symmetric P, from its columns: most elements of H are zero.
RowJacobian ProductWith(const RowJacobian& H, const ErrorMatrix& P) {
  return TimesTransposed(P, H.leftCols(P.cols())).transpose();
}

/// Kalman update of x by z, HP before it. P - W' W in place of Joseph's form,
/// at a third of the cost: the least sigma of a fix keeps it far from what
/// rounding ruins.
Innovation UpdateWith(const LinearizedMeasurement& z, const RowJacobian& HP,
                      Gaussian* x) {
  const auto H = z.H.leftCols(x->mean.size());
  Innovation innovation;
  innovation.residual = z.residual - H * x->mean;
  innovation.S = z.R + HP.lazyProduct(H.transpose());
  const Eigen::LLT<RowMatrix> llt(innovation.S);
  if (llt.info() != Eigen::Success) {
    throw EstimationError(
        "innovation covariance of a measurement is not positive definite");
  }
  const RowVector whitened = llt.matrixL().solve(innovation.residual);
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor,
                      kMaxRows, kMaxErrorDim>
      W = llt.matrixL().solve(HP);
  x->mean.noalias() += W.transpose() * whitened;
  SubtractSquare(W, &x->P);
  innovation.nis = whitened.squaredNorm();
  innovation.log_likelihood =
      -0.5 * innovation.nis - llt.matrixLLT().diagonal().array().log().sum() -
      0.5 * static_cast<double>(z.residual.size()) * std::log(2.0 * kPi);
  return innovation;
}

}  // namespace

ErrorChain::ErrorChain(const SensorTape& tape,
                       const ErrorParameters& parameters)
    : tape_(tape), parameters_(parameters), navigation_dim_(tape.dim()) {
  const ErrorLayout& layout = tape.linear().layout();
  const Block* position = layout.Find(BlockKind::kPosition);
  const Block* velocity = layout.Find(BlockKind::kVelocity);
  const Block* own = OwnFieldOf(layout, tape.sensor());
  if (own != nullptr) own_field_ = own->offset;
  for (const Eigen::Index i : tape.noisy()) {
    const bool is_navigation =
        std::ranges::any_of(layout.blocks(), [i](const Block& block) {
          return IsNavigation(block.key.kind) && i >= block.offset &&
                 i < block.offset + block.dim;
        });
    noise_scale_.push_back(is_navigation ? parameters.imu_scale : 1.0);
  }
  if (position == nullptr || velocity == nullptr) return;
  if (position->dim == 3 && velocity->dim == 3) {
    position_ = position->offset;
    velocity_ = velocity->offset;
  }
}

int ErrorChain::DimOf(ErrorMode mode) const {
  if (mode == ErrorMode::kGood) return navigation_dim_;
  return navigation_dim_ + (mode == ErrorMode::kDrifting ? 6 : 3);
}

Gaussian ErrorChain::Resized(const Gaussian& x, int dim) {
  const auto kept = std::min<Eigen::Index>(dim, x.mean.size());
  Gaussian out{ErrorVector::Zero(dim), ErrorMatrix::Zero(dim, dim)};
  out.mean.head(kept) = x.mean.head(kept);
  out.P.topLeftCorner(kept, kept) = x.P.topLeftCorner(kept, kept);
  return out;
}

Gaussian ErrorChain::Begin() const {
  return {tape_.linear().epoch(0).dx_minus, tape_.linear().P_minus(0)};
}

void ErrorChain::MoveTo(std::size_t k) {
  k_ = k;
  dt_ = k > 0 ? tape_.t(k) - tape_.t(k - 1) : 0.0;
  unseen_ = tape_.unseen_drift(k);
  c_n_ = tape_.linear().c(k);
  z_.clear();
  const auto all = tape_.linear().measurements(k);
  // The fix comes first: its likelihood is taken before any update.
  const auto fix = std::ranges::find_if(all, [this](const auto& z) {
    return z.accepted && !z.withheld && z.sensor == tape_.sensor();
  });
  fix_ = fix == all.end() ? -1 : 0;
  if (fix_ == 0) Take(*fix);
  for (auto z = all.begin(); z != all.end(); ++z) {
    if (z != fix && z->accepted && !z->withheld) Take(*z);
  }
  if (fix_ < 0) return;
  constexpr double kAddsNothing = 0.5 / kPi;
  const RowMatrix& R = z_[static_cast<std::size_t>(fix_)].R;
  rows_ = static_cast<int>(R.rows());
  R_in_ = R_out_ = kAddsNothing * Eigen::Matrix3d::Identity();
  const double ratio = parameters_.outlier_ratio;
  by_error_.setZero();
  by_error_.topRows(rows_) =
      z_[static_cast<std::size_t>(fix_)].H.middleCols(navigation_dim_, 3);
  R_in_.topLeftCorner(rows_, rows_) = R;
  R_out_.topLeftCorner(rows_, rows_) = ratio * ratio * R;
}

void ErrorChain::Take(const TapeMeasurement& z) {
  LinearizedMeasurement& wide = z_.emplace_back();
  wide.residual = z.residual;
  wide.R = z.R;
  wide.H.resize(z.H.rows(), dim());
  wide.H.leftCols(navigation_dim_) = z.H;
  wide.H.rightCols(dim() - navigation_dim_).setZero();
  if (z.sensor != tape_.sensor()) return;
  auto by_error = wide.H.middleCols(navigation_dim_, 3);
  if (own_field_ < 0) {
    by_error.setIdentity();
  } else {
    by_error = z.H.middleCols(own_field_, 3);
  }
  wide.R.diagonal().array() += kLeastSigma * kLeastSigma;
  wide.R *= parameters_.scale * parameters_.scale;
}

void ErrorChain::PredictNavigation(Gaussian* x) const {
  if (k_ == 0) return;
  const SparseCongruence& over_interval = tape_.OverInterval(k_);
  over_interval.ApplyTo(&x->mean);
  x->mean.head(navigation_dim_) += c_n_;
  over_interval.ApplyCongruence(&x->P);
  AddNavigationNoise(&x->P);
}

template <int kOwn>
void ErrorChain::PredictErrorBy(const ErrorDynamics& d, Gaussian* x) const {
  using OwnMatrix = Eigen::Matrix<double, kOwn, kOwn>;
  const int n = navigation_dim_;
  const OwnMatrix F = ErrorPhi(d).topLeftCorner<kOwn, kOwn>();
  x->mean.segment<kOwn>(n) = F * x->mean.segment<kOwn>(n).eval();
  auto P_ne = x->P.block<Eigen::Dynamic, kOwn>(0, n, n, kOwn);
  P_ne = (P_ne * F.transpose()).eval();
  x->P.block<kOwn, Eigen::Dynamic>(n, 0, kOwn, n) = P_ne.transpose();
  const OwnMatrix P = x->P.block<kOwn, kOwn>(n, n);
  x->P.block<kOwn, kOwn>(n, n) =
      F * P * F.transpose() + ErrorQ(d).topLeftCorner<kOwn, kOwn>();
}

void ErrorChain::PredictError(ErrorStep step, Gaussian* x) const {
  const ErrorDynamics d = DynamicsOf(parameters_, step, dt_, unseen_);
  const int dim = DimOf(step.mode);
  if (x->mean.size() != dim) *x = Resized(*x, dim);
  if (dim == navigation_dim_ + 6) {
    PredictErrorBy<6>(d, x);
  } else if (dim == navigation_dim_ + 3) {
    PredictErrorBy<3>(d, x);
  }
  if (d.q_vv > 0.0) AddVelocityStep(d.q_vv, step.onset, &x->P);
}

ErrorChain::FixLikelihood ErrorChain::LikelihoodOfFix(ErrorStep step,
                                                      const Gaussian& x) const {
  const LinearizedMeasurement& fix = z_[static_cast<std::size_t>(fix_)];
  return LikelihoodBy(ProductWith(fix.H, x.P), x, step.outlier);
}

ErrorChain::FixLikelihood ErrorChain::LikelihoodBy(const RowJacobian& HP,
                                                   const Gaussian& x,
                                                   bool outlier) const {
  const LinearizedMeasurement& fix = z_[static_cast<std::size_t>(fix_)];
  Eigen::Vector3d innovation = Eigen::Vector3d::Zero();
  Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
  const auto H = fix.H.leftCols(x.mean.size());
  innovation.head(rows_) = fix.residual - H * x.mean;
  S.topLeftCorner(rows_, rows_) = HP.lazyProduct(H.transpose());
  return Weigh(innovation, S, outlier);
}

LinearizedMeasurement ErrorChain::MeasurementAs(std::size_t i,
                                                bool outlier) const {
  LinearizedMeasurement z = z_[i];
  if (outlier && static_cast<int>(i) == fix_) {
    z.R *= parameters_.outlier_ratio * parameters_.outlier_ratio;
  }
  return z;
}

double ErrorChain::UpdateAll(bool outlier, Gaussian* x) const {
  return UpdateAll(outlier, x, nullptr, nullptr).others;
}

ErrorChain::NodeLikelihood ErrorChain::UpdateWithFix(
    ErrorStep step, Gaussian* x, std::vector<Used>* used) const {
  if (!has_fix()) return UpdateAll(false, x, used, nullptr);
  const LinearizedMeasurement& fix = z_[static_cast<std::size_t>(fix_)];
  const RowJacobian HP = ProductWith(fix.H, x->P);
  const FixLikelihood of_fix = LikelihoodBy(HP, *x, step.outlier);
  NodeLikelihood out = UpdateAll(of_fix.outlier, x, used, &HP);
  out.fix = of_fix;
  return out;
}

ErrorChain::NodeLikelihood ErrorChain::UpdateAll(
    bool outlier, Gaussian* x, std::vector<Used>* used,
    const RowJacobian* HP_of_fix) const {
  NodeLikelihood out;
  for (std::size_t i = 0; i < z_.size(); ++i) {
    LinearizedMeasurement wider;
    const bool is_outlier = outlier && IsFix(i);
    if (is_outlier) wider = MeasurementAs(i, outlier);
    const LinearizedMeasurement& z = is_outlier ? wider : z_[i];
    const bool is_known = HP_of_fix != nullptr && IsFix(i);
    const RowJacobian HP = is_known ? *HP_of_fix : ProductWith(z.H, x->P);
    const Innovation innovation = UpdateWith(z, HP, x);
    (IsFix(i) ? out.as_used : out.others) += innovation.log_likelihood;
    if (used != nullptr) used->push_back({z, innovation, HP});
  }
  return out;
}

void ErrorChain::UpdateOthers(Gaussian* x) const {
  for (std::size_t i = 0; i < z_.size(); ++i) {
    if (!IsFix(i)) UpdateWith(z_[i], ProductWith(z_[i].H, x->P), x);
  }
}

}  // namespace hindsight
