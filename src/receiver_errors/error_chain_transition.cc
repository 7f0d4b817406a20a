#include "receiver_errors/error_chain.h"

namespace hindsight {
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

void ErrorChain::AddVelocityStep(double variance, Onset onset,
                                 ErrorMatrix* P) const {
  if (velocity_ < 0) return;
  const GrowthMoments moved = tape_.unseen_step(k_).Grown(onset);
  for (int i = 0; i < 3; ++i) {
    const int p = position_ + i;
    const int v = velocity_ + i;
    (*P)(p, p) += variance * moved.square;
    (*P)(p, v) += variance * moved.by_rate;
    (*P)(v, p) += variance * moved.by_rate;
    (*P)(v, v) += variance;
  }
}

ErrorMatrix ErrorChain::Phi(ErrorStep step) const {
  const int n = navigation_dim_;
  ErrorMatrix Phi = ErrorMatrix::Zero(dim(), dim());
  Phi.topLeftCorner(n, n) = tape_.linear().Phi(k_);
  Phi.bottomRightCorner<6, 6>() =
      ErrorPhi(DynamicsOf(parameters_, step, dt_, unseen_));
  return Phi;
}

ErrorMatrix ErrorChain::PhiAtOnce(ErrorStep step) const {
  ErrorMatrix Phi = ErrorMatrix::Identity(dim(), dim());
  Phi.bottomRightCorner<6, 6>() =
      ErrorPhi(DynamicsOf(parameters_, step, 0.0, {}));
  return Phi;
}

ErrorMatrix ErrorChain::QAtOnce(ErrorStep step) const {
  ErrorMatrix Q = ErrorMatrix::Zero(dim(), dim());
  Q.bottomRightCorner<6, 6>() = ErrorQ(DynamicsOf(parameters_, step, 0.0, {}));
  return Q;
}

ErrorMatrix ErrorChain::Q(ErrorStep step) const {
  const ErrorDynamics d = DynamicsOf(parameters_, step, dt_, unseen_);
  ErrorMatrix Q = ErrorMatrix::Zero(dim(), dim());
  AddNavigationNoise(&Q);
  Q.bottomRightCorner<6, 6>() = ErrorQ(d);
  AddVelocityStep(d.q_vv, step.onset, &Q);
  return Q;
}

ErrorVector ErrorChain::Defect() const {
  ErrorVector c = ErrorVector::Zero(dim());
  c.head(navigation_dim_) = c_n_;
  return c;
}

}  // namespace hindsight
