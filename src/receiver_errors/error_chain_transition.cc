#include "receiver_errors/error_chain.h"

namespace hindsight {
namespace {

void FillErrorPhi(const ErrorDynamics& d, int n, ErrorMatrix* Phi) {
  Phi->block<3, 3>(n, n).diagonal().setConstant(d.ee);
  Phi->block<3, 3>(n, n + 3).diagonal().setConstant(d.er);
  Phi->block<3, 3>(n + 3, n + 3).diagonal().setConstant(d.rr);
}

void FillErrorQ(const ErrorDynamics& d, int n, ErrorMatrix* Q) {
  for (int e = n; e < n + 3; ++e) {
    const int r = e + 3;
    (*Q)(e, e) = d.q_ee;
    (*Q)(e, r) = (*Q)(r, e) = d.q_er;
    (*Q)(r, r) = d.q_rr;
  }
}

}  // namespace

void ErrorChain::AddNavigationNoise(ErrorMatrix* P) const {
  const std::vector<Eigen::Index>& noisy = tape_.noisy();
  const PackedSymmetric Q = tape_.linear().PackedQ(k_);
  for (std::size_t a = 0; a < noisy.size(); ++a) {
    const Eigen::Index j = noisy[a];
    const double* column = Q.Column(j);
    for (std::size_t b = a; b < noisy.size(); ++b) {
      const Eigen::Index i = noisy[b];
      const double q = noise_scale_[b] * column[i - j] * noise_scale_[a];
      (*P)(i, j) += q;
      if (i != j) (*P)(j, i) += q;
    }
  }
}

void ErrorChain::AddVelocityStep(double variance, ErrorMatrix* P) const {
  if (velocity_ < 0) return;
  const double reach = tape_.reach(k_);
  for (int i = 0; i < 3; ++i) {
    const int p = position_ + i;
    const int v = velocity_ + i;
    (*P)(p, p) += variance * reach * reach;
    (*P)(p, v) += variance * reach;
    (*P)(v, p) += variance * reach;
    (*P)(v, v) += variance;
  }
}

ErrorMatrix ErrorChain::Phi(ErrorStep step) const {
  const int n = navigation_dim_;
  ErrorMatrix Phi = ErrorMatrix::Zero(dim(), dim());
  Phi.topLeftCorner(n, n) = tape_.linear().Phi(k_);
  FillErrorPhi(DynamicsOf(parameters_, step, dt_), n, &Phi);
  return Phi;
}

ErrorMatrix ErrorChain::PhiAtOnce(ErrorStep step) const {
  ErrorMatrix Phi = ErrorMatrix::Identity(dim(), dim());
  FillErrorPhi(DynamicsOf(parameters_, step, 0.0), navigation_dim_, &Phi);
  return Phi;
}

ErrorMatrix ErrorChain::QAtOnce(ErrorStep step) const {
  ErrorMatrix Q = ErrorMatrix::Zero(dim(), dim());
  FillErrorQ(DynamicsOf(parameters_, step, 0.0), navigation_dim_, &Q);
  return Q;
}

ErrorMatrix ErrorChain::Q(ErrorStep step) const {
  const int n = navigation_dim_;
  const ErrorDynamics d = DynamicsOf(parameters_, step, dt_);
  ErrorMatrix Q = ErrorMatrix::Zero(dim(), dim());
  AddNavigationNoise(&Q);
  FillErrorQ(d, n, &Q);
  AddVelocityStep(d.q_vv, &Q);
  return Q;
}

ErrorVector ErrorChain::Defect() const {
  ErrorVector c = ErrorVector::Zero(dim());
  c.head(navigation_dim_) = c_n_;
  return c;
}

}  // namespace hindsight
