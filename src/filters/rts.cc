#include "filters/rts.h"

#include <Eigen/Cholesky>

#include "base/error.h"
#include "filters/transport.h"
#include "linear/sparse_product.h"

namespace hindsight {
namespace {

/// The pass over a tape of `Dim` components (Eigen::Dynamic: of any number).
/// Attitude alone is smoothed at every IMU sample: matrices of fixed size make
/// that several times as fast.
template <int Dim>
class RtsPass {
 public:
  static constexpr int kMax = Dim == Eigen::Dynamic ? kMaxErrorDim : Dim;
  using Vector = Eigen::Matrix<double, Dim, 1, 0, kMax, 1>;
  using Matrix = Eigen::Matrix<double, Dim, Dim, 0, kMax, kMax>;

  RtsPass(const LinearTape& tape, bool covariances)
      : tape_(tape),
        covariances_(covariances),
        count_(tape.size()),
        d_(Vector::Zero(tape.dim())),
        P_(Matrix::Zero(tape.dim(), tape.dim())) {
    out_.states.resize(count_);
    out_.d.resize(count_);
    if (covariances) out_.P = CovarianceSeries(tape.dim(), count_);
  }

  SmoothedTrajectory Run(LinearTape* consumed) {
    if (count_ == 0) return std::move(out_);
    if (!tape_.back().reset) d_ = tape_.back().dx_plus;
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
    const Matrix Phi = tape_.Phi(k + 1);
    const Matrix P_plus = tape_.P_plus(k);
    const Matrix P_minus = tape_.P_minus(k + 1);
    const Eigen::LLT<Matrix> llt(P_minus);
    if (llt.info() != Eigen::Success) {
      throw EstimationError(
          "predicted covariance is not positive definite at t = " +
          std::to_string(tape_.epoch(k + 1).t) + " s");
    }
    const Vector ahead = llt.solve(d_ - tape_.epoch(k + 1).dx_minus);
    d_ = P_plus * Vector(Phi.transpose() * ahead);
    if (!tape_.epoch(k).reset) d_ += tape_.epoch(k).dx_plus;
    if (covariances_) StepCovarianceBack(k, Phi, P_plus, llt);
  }

  /// The same of P; `llt` of P_minus of epoch k + 1.
  void StepCovarianceBack(std::size_t k, const Matrix& Phi,
                          const Matrix& P_plus, const Eigen::LLT<Matrix>& llt) {
    const Matrix PhiP = TimesTransposed(P_plus, Phi).transpose();
    const Matrix C = llt.solve(PhiP).transpose();
    Matrix A = Matrix::Identity(tape_.dim(), tape_.dim());
    A -= Times(C, Phi);
    P_ += tape_.Q(k + 1);
    const Matrix CP = C * P_;
    P_.template triangularView<Eigen::Lower>() = CP * C.transpose();
    const Matrix AP = A * P_plus;
    P_.template triangularView<Eigen::Lower>() += AP * A.transpose();
    P_ = Matrix(P_.template selfadjointView<Eigen::Lower>());
  }

  /// Writes epoch k from the smoothed error about x_plus, and carries that
  /// error and covariance into the tangent at x_minus, where the interval
  /// before ends.
  void WriteEpoch(std::size_t k) {
    const TapeEpoch& epoch = tape_.epoch(k);
    out_.states[k] = tape_.StateAt(k, d_);
    if (covariances_) out_.P.Set(k, P_);
    if (epoch.moves_nominal()) {
      if (tape_.transports()) {
        ErrorVector d = d_;
        ErrorMatrix P = P_;
        MoveBack(tape_.ResetTransport(k), &d, &P);
        d_ = d;
        P_ = P;
      }
      d_ += epoch.dx_plus;
    }
    out_.d[k] = d_;
  }

  const LinearTape& tape_;
  bool covariances_;
  std::size_t count_;
  Vector d_;
  Matrix P_;
  SmoothedTrajectory out_;
};

SmoothedTrajectory Smooth(const LinearTape& tape, bool covariances,
                          LinearTape* consumed) {
  RequireSmoothable(tape);
  constexpr int kAttitudeDim = 9;
  if (tape.dim() == kAttitudeDim) {
    return RtsPass<kAttitudeDim>(tape, covariances).Run(consumed);
  }
  return RtsPass<Eigen::Dynamic>(tape, covariances).Run(consumed);
}

}  // namespace

SmoothedTrajectory SmoothRts(const LinearTape& tape) {
  return Smooth(tape, /*covariances=*/true, nullptr);
}

SmoothedTrajectory SmoothRts(LinearTape&& tape) {
  return Smooth(tape, /*covariances=*/true, &tape);
}

SmoothedTrajectory SmoothMeans(const LinearTape& tape) {
  return Smooth(tape, /*covariances=*/false, nullptr);
}

}  // namespace hindsight
