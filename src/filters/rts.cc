#include "filters/rts.h"

#include <Eigen/Cholesky>

#include "base/error.h"
#include "filters/transport.h"
#include "linear/small_product.h"
#include "linear/sparse_product.h"

namespace hindsight {
namespace {

/// The pass over a tape.
class RtsPass {
 public:
  RtsPass(const LinearTape& tape, bool covariances, bool errors)
      : tape_(tape),
        covariances_(covariances),
        errors_(errors),
        count_(tape.size()),
        d_(ErrorVector::Zero(tape.dim())),
        P_(ErrorMatrix::Zero(tape.dim(), tape.dim())) {
    out_.states.resize(count_);
    if (errors) out_.d.resize(count_);
    if (covariances) out_.P = CovarianceSeries(tape.dim(), count_);
  }

  SmoothedTrajectory Run(LinearTape* consumed) {
    if (count_ == 0) return std::move(out_);
    epoch_ = tape_.back();
    if (!epoch_.reset) d_ = epoch_.dx_plus;
    if (covariances_) P_ = tape_.P_plus(count_ - 1);
    WriteEpoch(count_ - 1);
    for (std::size_t k = count_ - 1; k-- > 0;) {
      StepBack(k);
      if (consumed != nullptr) consumed->PopBack();
      WriteEpoch(k);
    }
    return std::move(out_);
  }

 private:
  /// From the tangent at x_minus of epoch k + 1 to that at x_plus of k.
  void StepBack(std::size_t k) {
    const ErrorMatrix Phi = tape_.Phi(k + 1);
    const ErrorMatrix P_plus = tape_.P_plus(k);
    const Eigen::LLT<ErrorMatrix> llt(tape_.P_minus(k + 1));
    if (llt.info() != Eigen::Success) {
      throw EstimationError(
          "predicted covariance is not positive definite at t = " +
          std::to_string(epoch_.t) + " s");
    }
    const ErrorVector ahead = llt.solve(d_ - epoch_.dx_minus);
    d_ = P_plus * ErrorVector(Phi.transpose() * ahead);
    epoch_ = tape_.epoch(k);
    if (!epoch_.reset) d_ += epoch_.dx_plus;
    if (covariances_) StepCovarianceBack(k, Phi, P_plus, llt);
  }

  /// The same of P; `llt` of P_minus of epoch k + 1.
  void StepCovarianceBack(std::size_t k, const ErrorMatrix& Phi,
                          const ErrorMatrix& P_plus,
                          const Eigen::LLT<ErrorMatrix>& llt) {
    ErrorMatrix C = TimesTransposed(P_plus, Phi);
    DivideByCholesky(llt.matrixLLT(), &C);
    ErrorMatrix A = ErrorMatrix::Identity(tape_.dim(), tape_.dim());
    A -= Times(C, Phi);
    P_ += tape_.Q(k + 1);
    P_ = Sandwiched(C, P_) + Sandwiched(A, P_plus);
    P_ = ErrorMatrix(P_.selfadjointView<Eigen::Lower>());
  }

  /// A P A', of which what lies above the diagonal is not said.
  static ErrorMatrix Sandwiched(const ErrorMatrix& A, const ErrorMatrix& P) {
    ErrorMatrix AP, APA;
    Multiply(A, P, /*lower=*/false, &AP);
    Multiply(AP, A.transpose(), /*lower=*/true, &APA);
    return APA;
  }

  /// Writes epoch k from the smoothed error about x_plus, and carries that
  /// error and covariance into the tangent at x_minus, where the interval
  /// before ends.
  void WriteEpoch(std::size_t k) {
    out_.states[k] = tape_.StateAt(epoch_, d_);
    if (covariances_) out_.P.Set(k, P_);
    if (epoch_.moves_nominal()) {
      MoveBack(tape_.ResetTransport(epoch_), &d_, &P_);
      d_ += epoch_.dx_plus;
    }
    if (errors_) out_.d[k] = d_;
  }

  const LinearTape& tape_;
  bool covariances_;
  bool errors_;
  std::size_t count_;
  TapeEpoch epoch_;  ///< that is being smoothed
  ErrorVector d_;
  ErrorMatrix P_;
  SmoothedTrajectory out_;
};

SmoothedTrajectory Smooth(const LinearTape& tape, bool covariances, bool errors,
                          LinearTape* consumed) {
  RequireSmoothable(tape);
  return RtsPass(tape, covariances, errors).Run(consumed);
}

}  // namespace

SmoothedTrajectory SmoothRts(const LinearTape& tape) {
  return Smooth(tape, /*covariances=*/true, /*errors=*/true, nullptr);
}

SmoothedTrajectory SmoothRts(LinearTape&& tape, bool errors) {
  return Smooth(tape, /*covariances=*/true, errors, &tape);
}

SmoothedTrajectory SmoothMeans(const LinearTape& tape) {
  return Smooth(tape, /*covariances=*/false, /*errors=*/true, nullptr);
}

}  // namespace hindsight
