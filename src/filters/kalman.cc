#include "filters/kalman.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "linear/small_product.h"
#include "linear/sparse_product.h"

namespace hindsight {

Innovation Innovate(const LinearizedMeasurement& z, const ErrorVector& dx,
                    const ErrorMatrix& P) {
  Innovation out;
  out.residual = z.residual - z.H * dx;
  const GainMatrix PHt = TimesTransposed(P, z.H);
  out.S = z.R;
  out.S.noalias() += z.H.lazyProduct(PHt);
  const Eigen::LLT<RowMatrix> llt(out.S);
  if (llt.info() != Eigen::Success) {
    throw EstimationError(
        "innovation covariance of a measurement is not positive definite");
  }
  const RowVector whitened = llt.matrixL().solve(out.residual);
  out.nis = whitened.squaredNorm();
  const double log_determinant =
      2.0 * llt.matrixLLT().diagonal().array().log().sum();
  out.log_likelihood =
      -0.5 * (out.nis + log_determinant +
              static_cast<double>(out.residual.size()) * std::log(2.0 * kPi));
  return out;
}

GainMatrix Update(const LinearizedMeasurement& z, const Innovation& innovation,
                  ErrorVector* dx, ErrorMatrix* P) {
  const GainMatrix PHt = TimesTransposed(*P, z.H);
  const Eigen::LLT<RowMatrix> llt(innovation.S);
  const GainMatrix K = llt.solve(PHt.transpose()).transpose();
  *dx += K * innovation.residual;
  AddProduct<-1>(K, PHt.transpose(), P);  // (I - K H) P
  const GainMatrix APHt = TimesTransposed(*P, z.H);
  AddProduct<-1>(APHt, K.transpose(), P);
  const GainMatrix KR = K.lazyProduct(z.R);
  AddProduct<1>(KR, K.transpose(), P);
  Symmetrize(P);
  return K;
}

void PredictCovariance(const ErrorMatrix& Phi, const ErrorMatrix& Q,
                       ErrorMatrix* P) {
  if (P->rows() > kDense) {
    SparseCongruence(Phi).ApplyCongruence(P);
    *P += Q;
  } else {
    const ErrorMatrix PhiP = TimesTransposed(*P, Phi).transpose();
    *P = Q + TimesTransposed(PhiP, Phi);
  }
  Symmetrize(P);
}

void Symmetrize(ErrorMatrix* P) {
  const Eigen::Index n = P->rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = j + 1; i < n; ++i) {
      const double mean = 0.5 * ((*P)(i, j) + (*P)(j, i));
      (*P)(i, j) = mean;
      (*P)(j, i) = mean;
    }
  }
}

}  // namespace hindsight
