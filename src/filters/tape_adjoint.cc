#include "filters/tape_adjoint.h"

#include <Eigen/Cholesky>
#include <vector>

#include "filters/kalman.h"
#include "filters/tape_gains.h"
#include "linear/sparse_product.h"

namespace hindsight {

void TapeAdjoint::BackOver(std::size_t k) {
  const auto Phi = tape_.Phi(k);
  lambda_ = (Phi.transpose() * lambda_).eval();
  const ErrorMatrix PhiLambda = Times(Lambda_, Phi).transpose();
  Lambda_ = Times(PhiLambda, Phi);
}

void TapeAdjoint::BackBefore(const TapeMeasurement& z,
                             const Eigen::MatrixXd& K) {
  const Eigen::LLT<RowMatrix> S(z.S);
  lambda_ = LambdaBefore(z, z.innovation, K, lambda_);
  const Eigen::MatrixXd LK = Lambda_ * K;
  Lambda_ -= LK * z.H;
  const Eigen::MatrixXd direct = S.solve(z.H) - K.transpose() * Lambda_;
  Lambda_ += z.H.transpose() * direct;
  Symmetrize(&Lambda_);  // what is not symmetric would grow
}

ErrorVector LambdaBefore(const TapeMeasurement& z, const RowVector& nu,
                         const Eigen::MatrixXd& K, const ErrorVector& lambda) {
  const RowVector ahead =
      Eigen::LLT<RowMatrix>(z.S).solve(nu) - K.transpose() * lambda;
  return lambda + z.H.transpose() * ahead;
}

void ForEachLambda(
    const LinearTape& tape,
    const std::function<void(std::size_t k, const ErrorMatrix& Lambda)>&
        visit) {
  RequireFixedNominal(tape);
  TapeAdjoint adjoint(tape);
  for (std::size_t k = tape.size(); k-- > 0;) {
    if (k + 1 < tape.size()) adjoint.BackOver(k + 1);
    const std::vector<Eigen::MatrixXd> gains = GainsAt(tape, k);
    const auto all = tape.measurements(k);
    for (std::size_t i = all.size(); i-- > 0;) {
      if (all[i].accepted) adjoint.BackBefore(all[i], gains[i]);
    }
    visit(k, adjoint.Lambda());
  }
}

}  // namespace hindsight
