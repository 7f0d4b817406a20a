#include "filters/imm_smoother.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace hindsight {
namespace {

Eigen::LLT<ErrorMatrix> Factor(const ErrorMatrix& P, double t) {
  Eigen::LLT<ErrorMatrix> llt(P);
  if (llt.info() != Eigen::Success) {
    throw EstimationError(
        "predicted covariance is not positive definite at t = " +
        std::to_string(t) + " s");
  }
  return llt;
}

/// l_j(x) as measurements: zeta = D u + v, v ~ (0, I), of the coordinates
/// u = V' L^-1 (x - x-_j), L L' = P-_j.
class FutureLikelihood {
 public:
  FutureLikelihood(const Gaussian& predicted, const Gaussian& smoothed,
                   double t)
      : mean_(predicted.mean) {
    const Eigen::LLT<ErrorMatrix> llt = Factor(predicted.P, t);
    ErrorMatrix M = llt.matrixL().solve(smoothed.P);
    M = llt.matrixL().solve(M.transpose()).eval();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
        Eigen::MatrixXd(0.5 * (M + M.transpose())));
    basis_ = llt.matrixL() * ErrorMatrix(eigen.eigenvectors());
    coordinates_ =
        eigen.eigenvectors().transpose() *
        llt.matrixL().solve(ErrorMatrix::Identity(M.rows(), M.rows()));
    const ErrorVector u = coordinates_ * (smoothed.mean - predicted.mean);
    // Merging may shift a mean along a direction in which the smoothed
    // covariance has gained nothing on the predicted one. Such a shift is no
    // measurement: directions without gain are left out, and a shift counts up
    // to kFarthest standard deviations of what the gain explains.
    constexpr double kLeastGain = 1e-9;
    constexpr double kLeastVariance = 1e-14;
    constexpr double kFarthest = 4.0;
    D_.setZero(u.size());
    zeta_.setZero(u.size());
    for (Eigen::Index i = 0; i < u.size(); ++i) {
      const double variance = std::max(eigen.eigenvalues()(i), kLeastVariance);
      const double gain = 1.0 - variance;
      if (gain < kLeastGain) continue;
      const double limit = kFarthest * std::sqrt(gain);
      D_(i) = std::sqrt(gain / variance);
      zeta_(i) = std::clamp(u(i), -limit, limit) / std::sqrt(variance * gain);
    }
  }

  /// Updates another prediction of x; returns the logarithm of its likelihood
  /// but for a constant.
  double Update(Gaussian* x) const {
    const ErrorVector m = coordinates_ * (x->mean - mean_);
    const ErrorMatrix P = coordinates_ * x->P * coordinates_.transpose();
    const auto D = D_.asDiagonal();
    ErrorMatrix W = D * P * D;
    W.diagonal().array() += 1.0;
    const Eigen::LLT<ErrorMatrix> llt(W);
    const ErrorVector innovation = zeta_ - D * m;
    const ErrorMatrix DP = D * P;
    const ErrorMatrix Kt = llt.solve(DP);
    ErrorMatrix A = ErrorMatrix::Identity(P.rows(), P.rows());
    A.noalias() -= Kt.transpose() * D;
    const ErrorMatrix AP = A * P;
    ErrorMatrix P_s = AP * A.transpose();
    P_s.noalias() += Kt.transpose() * Kt;
    x->mean = mean_ + basis_ * (m + Kt.transpose() * innovation);
    const ErrorMatrix BP = basis_ * P_s;
    x->P.noalias() = BP * basis_.transpose();
    const ErrorVector whitened = llt.matrixL().solve(innovation);
    return -0.5 * whitened.squaredNorm() -
           llt.matrixLLT().diagonal().array().log().sum();
  }

 private:
  ErrorVector mean_;
  ErrorMatrix basis_;        ///< x - x-_j = basis u
  ErrorMatrix coordinates_;  ///< its inverse
  ErrorVector D_;
  ErrorVector zeta_;
};

class BackwardPass {
 public:
  BackwardPass(const ImmTape& tape, bool with_models)
      : tape_(tape),
        with_models_(with_models),
        count_(tape.tapes.size()),
        shared_(count_) {
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t j = 0; j < count_; ++j) {
        shared_[i].push_back(
            SharedComponents(tape.tapes[i].layout(), tape.tapes[j].layout()));
      }
    }
    out_.trajectory.P = CovarianceSeries(tape.tapes[0].dim(), tape.size());
    out_.trajectory.states.resize(tape.size());
    out_.trajectory.probabilities.resize(tape.size());
    if (with_models_) out_.models.resize(tape.size());
    out_.pairs.resize(tape.size());
  }

  ImmSmoothed Run() {
    if (tape_.size() == 0) return std::move(out_);
    const std::size_t last = tape_.size() - 1;
    for (std::size_t j = 0; j < count_; ++j)
      smoothed_.push_back(Filtered(last, j));
    mu_ = tape_.epochs[last].probability;
    Write(last);
    for (std::size_t k = last; k-- > 0;) {
      MoveBeforeUpdate(k + 1);
      if (tape_.epochs[k + 1].switched && count_ > 1) {
        StepPairs(k);
      } else {
        for (std::size_t j = 0; j < count_; ++j) {
          smoothed_[j] = StepBack(k, j, Filtered(k, j), smoothed_[j]);
        }
      }
      Write(k);
    }
    return std::move(out_);
  }

 private:
  /// The filter's density of model j at node k about x_plus.
  Gaussian Filtered(std::size_t k, std::size_t j) const {
    return {tape_.epochs[k].mean_plus[j], tape_.tapes[j].P_plus(k)};
  }

  void Write(std::size_t k) {
    const Gaussian combined = Combine(tape_.tapes, smoothed_, mu_);
    WriteCombined(tape_.tapes[0].layout(), tape_.tapes[0].epoch(k).x_plus,
                  combined, mu_, k, &out_.trajectory);
    if (with_models_) out_.models[k] = smoothed_;
  }

  /// Carries the smoothed densities from the nominal x_plus to x_minus.
  void MoveBeforeUpdate(std::size_t k) {
    for (std::size_t j = 0; j < count_; ++j) {
      const TapeEpoch& epoch = tape_.tapes[j].epoch(k);
      if (!epoch.reset) continue;
      const ErrorMatrix T =
          Transport(tape_.tapes[j].layout(), epoch.x_minus, epoch.x_plus);
      const Eigen::PartialPivLU<ErrorMatrix> lu(T);
      Gaussian& s = smoothed_[j];
      s.mean = epoch.dx_plus +
               ErrorVector(lu.solve(s.mean - tape_.epochs[k].mean_plus[j]));
      const ErrorMatrix half = lu.solve(s.P);
      s.P = lu.solve(half.transpose()).eval();
      Symmetrize(&s.P);
    }
  }

  /// Prediction of `from`, at node k over the layout of j, by model j.
  Gaussian PredictBy(std::size_t k, std::size_t j, const Gaussian& from) const {
    Gaussian out = from;
    const LinearTape& tape = tape_.tapes[j];
    out.mean = tape.Phi(k + 1) * from.mean + tape.c(k + 1);
    PredictCovariance(tape.Phi(k + 1), tape.Q(k + 1), &out.P);
    return out;
  }

  /// Rauch-Tung-Striebel step of model j from x_k+1 ~ `next` to x_k, which was
  /// filtered as `from`.
  Gaussian StepBack(std::size_t k, std::size_t j, const Gaussian& from,
                    const Gaussian& next) const {
    const LinearTape& tape = tape_.tapes[j];
    const Gaussian predicted = PredictBy(k, j, from);
    const ErrorMatrix Phi = tape.Phi(k + 1);
    const ErrorMatrix PhiP = Phi * from.P;
    const ErrorMatrix C =
        Factor(predicted.P, tape.t(k + 1)).solve(PhiP).transpose();
    ErrorMatrix A = ErrorMatrix::Identity(C.rows(), C.rows());
    A.noalias() -= C * Phi;
    Gaussian out;
    out.mean = from.mean + C * (next.mean - predicted.mean);
    const ErrorMatrix CP = C * (next.P + tape.Q(k + 1));
    out.P.noalias() = CP * C.transpose();
    const ErrorMatrix AP = A * from.P;
    out.P.noalias() += AP * A.transpose();
    Symmetrize(&out.P);
    return out;
  }

  void StepPairs(std::size_t k) {
    std::vector<Gaussian> filtered;
    for (std::size_t i = 0; i < count_; ++i) filtered.push_back(Filtered(k, i));
    std::vector<std::vector<Gaussian>> parts(count_);  // by i, over its layout
    const auto n = static_cast<Eigen::Index>(count_);
    Eigen::MatrixXd pairs(n, n);
    for (std::size_t j = 0; j < count_; ++j) {
      const TapeEpoch& epoch = tape_.tapes[j].epoch(k + 1);
      const FutureLikelihood future(
          {epoch.dx_minus, tape_.tapes[j].P_minus(k + 1)}, smoothed_[j],
          epoch.t);
      Eigen::VectorXd log_weight(n);
      for (std::size_t i = 0; i < count_; ++i) {
        const Gaussian from =
            i == j ? filtered[j]
                   : Transfer(filtered[i], filtered[j], shared_[j][i]);
        Gaussian next = PredictBy(k, j, from);
        const auto row = static_cast<Eigen::Index>(i);
        log_weight(row) =
            std::log(tape_.transition(row, static_cast<Eigen::Index>(j))) +
            std::log(tape_.epochs[k].probability(row)) + future.Update(&next);
        const Gaussian back = StepBack(k, j, from, next);
        parts[i].push_back(i == j ? back
                                  : Transfer(back, filtered[i], shared_[i][j]));
      }
      const Eigen::VectorXd weight =
          (log_weight.array() - log_weight.maxCoeff()).exp();
      const auto column = static_cast<Eigen::Index>(j);
      pairs.col(column) = weight * (mu_(column) / weight.sum());
    }
    mu_ = pairs.rowwise().sum();
    mu_ /= mu_.sum();
    for (std::size_t i = 0; i < count_; ++i) {
      Eigen::VectorXd weights = pairs.row(static_cast<Eigen::Index>(i));
      const double sum = weights.sum();
      // A mode of probability zero has no weights: it takes the density that
      // its own continuation gives.
      if (sum > 0.0) {
        weights /= sum;
      } else {
        weights.setZero();
        weights(static_cast<Eigen::Index>(i)) = 1.0;
      }
      smoothed_[i] = Merge(parts[i], weights);
    }
    out_.pairs[k + 1] = std::move(pairs);
  }

  const ImmTape& tape_;
  bool with_models_;
  std::size_t count_;
  std::vector<std::vector<ComponentMap>> shared_;  // [target][source]
  std::vector<Gaussian> smoothed_;
  Eigen::VectorXd mu_;
  ImmSmoothed out_;
};

}  // namespace

ImmSmoothed SmoothImm(const ImmTape& tape, bool with_models) {
  return BackwardPass(tape, with_models).Run();
}

}  // namespace hindsight
