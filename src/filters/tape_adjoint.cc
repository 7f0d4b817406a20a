#include "filters/tape_adjoint.h"

#include <Eigen/Cholesky>
#include <vector>

#include "filters/kalman.h"
#include "filters/tape_gains.h"
#include "linear/small_product.h"
#include "linear/sparse_product.h"

namespace hindsight {

void TapeAdjoint::BackOver(const ErrorMatrix& Phi) {
  lambda_ = (Phi.transpose() * lambda_).eval();
  const ErrorMatrix PhiLambda = Times(Lambda_, Phi).transpose();
  Lambda_ = Times(PhiLambda, Phi);
}

void TapeAdjoint::BackBefore(const TapeMeasurement& z) {
  lambda_ = LambdaBefore(z, z.innovation, lambda_);
  GainMatrix LK;
  Multiply(Lambda_, z.K, /*lower=*/false, &LK);
  AddProduct<-1>(LK, z.H, &Lambda_);
  RowJacobian direct = Eigen::LLT<RowMatrix>(z.S).solve(z.H);
  direct.noalias() -= z.K.transpose().lazyProduct(Lambda_);
  Lambda_.noalias() += z.H.transpose().lazyProduct(direct);
  Symmetrize(&Lambda_);  // what is not symmetric would grow
}

ErrorVector LambdaBefore(const TapeMeasurement& z, const RowVector& nu,
                         const ErrorVector& lambda) {
  const RowVector ahead =
      Eigen::LLT<RowMatrix>(z.S).solve(nu) - z.K.transpose() * lambda;
  return lambda + z.H.transpose() * ahead;
}

void ForEachLambda(
    const LinearTape& tape,
    const std::function<void(std::size_t k, const ErrorMatrix& Lambda)>&
        visit) {
  RequireFixedNominal(tape);
  TapeAdjoint adjoint(tape);
  for (std::size_t k = tape.size(); k-- > 0;) {
    if (k + 1 < tape.size()) adjoint.BackOver(tape.Phi(k + 1));
    const auto all = tape.measurements(k);
    for (std::size_t i = all.size(); i-- > 0;) {
      if (all[i].accepted) adjoint.BackBefore(all[i]);
    }
    visit(k, adjoint.Lambda());
  }
}

}  // namespace hindsight
