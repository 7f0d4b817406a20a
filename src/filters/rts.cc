#include "filters/rts.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <future>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "filters/transport.h"
#include "linear/small_product.h"
#include "linear/sparse_product.h"

namespace hindsight {
namespace {

/// Steps back that are prepared at once, beside those that are gone.
constexpr std::size_t kStepsAtOnce = 64;

/// A P A', of which what lies above the diagonal is not said.
ErrorMatrix Sandwiched(const ErrorMatrix& A, const ErrorMatrix& P) {
  ErrorMatrix AP, APA;
  Multiply(A, P, /*lower=*/false, &AP);
  Multiply(AP, A.transpose(), /*lower=*/true, &APA);
  return APA;
}

/// What a step back to an epoch takes from the tape alone, whatever was smoothed
/// behind it.
class StepBack {
 public:
  StepBack(const LinearTape& tape, std::size_t k, bool covariances)
      : Phi_(tape.Phi(k + 1)),
        P_plus_(tape.P_plus(k)),
        P_minus_(tape.P_minus(k + 1)) {
    if (!covariances || !is_possible()) return;
    C_ = TimesTransposed(P_plus_, Phi_);
    DivideByCholesky(P_minus_.matrixLLT(), &C_);
    ErrorMatrix A = ErrorMatrix::Identity(tape.dim(), tape.dim());
    A -= Times(C_, Phi_);
    spread_ = Sandwiched(A, P_plus_);
  }

  /// False if the predicted covariance is not positive definite.
  bool is_possible() const { return P_minus_.info() == Eigen::Success; }
  /// The error about x_plus of the epoch, but for its dx_plus, from what the error
  /// about x_minus of the next is off dx_minus.
  ErrorVector Error(const ErrorVector& off) const {
    const ErrorVector ahead = P_minus_.solve(off);
    return P_plus_ * ErrorVector(Phi_.transpose() * ahead);
  }
  /// Its covariance, from that of the next plus the noise in between.
  ErrorMatrix Covariance(const ErrorMatrix& next) const {
    const ErrorMatrix P = Sandwiched(C_, next) + spread_;
    return P.selfadjointView<Eigen::Lower>();
  }

 private:
  ErrorMatrix Phi_;                  ///< of the interval that follows
  ErrorMatrix P_plus_;               ///< of the epoch
  Eigen::LLT<ErrorMatrix> P_minus_;  ///< of the next
  ErrorMatrix C_;                    ///< P_plus Phi' P_minus^-1
  ErrorMatrix spread_;  ///< (I - C Phi) P_plus (I - C Phi)', lower half
};

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
    first_ = count_ - 1;
    for (std::size_t k = count_ - 1; k-- > 0;) {
      if (k < first_) TakeSteps(k, consumed);
      GoBack(k, *steps_[k - first_]);
      WriteEpoch(k);
    }
    return std::move(out_);
  }

 private:
  using Steps = std::vector<std::optional<StepBack>>;

  /// Steps to epochs before `end`; returns the first of them.
  std::size_t Prepare(std::size_t end, Steps* steps) const {
    steps->resize(std::min(end, kStepsAtOnce));
    const std::size_t first = end - steps->size();
    for (std::size_t i = 0; i < steps->size(); ++i) {
      (*steps)[i].emplace(tape_, first + i, covariances_);
    }
    return first;
  }

  /// The step to epoch k and some before it; has those before them prepared. Of
  /// `consumed` goes what no step needs any more.
  void TakeSteps(std::size_t k, LinearTape* consumed) {
    first_ = next_first_.valid() ? next_first_.get() : Prepare(k + 1, &next_);
    steps_.swap(next_);
    while (consumed != nullptr && consumed->size() > k + 2) consumed->PopBack();
    if (first_ == 0) return;
    next_first_ =
        InBackground([this, end = first_] { return Prepare(end, &next_); });
  }

  /// From the tangent at x_minus of epoch k + 1 to that at x_plus of k.
  void GoBack(std::size_t k, const StepBack& step) {
    if (!step.is_possible()) {
      throw EstimationError(
          "predicted covariance is not positive definite at t = " +
          std::to_string(epoch_.t) + " s");
    }
    d_ = step.Error(d_ - epoch_.dx_minus);
    epoch_ = tape_.epoch(k);
    if (!epoch_.reset) d_ += epoch_.dx_plus;
    if (covariances_) P_ = step.Covariance(P_ + tape_.Q(k + 1));
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
  Steps steps_;  ///< to epochs from first_ on
  std::size_t first_ = 0;
  SmoothedTrajectory out_;
  Steps next_;  ///< to those before
  /// The first of those, once they are prepared. The last member: it waits.
  std::future<std::size_t> next_first_;
};

SmoothedTrajectory Smooth(const LinearTape& tape, bool covariances, bool errors,
                          LinearTape* consumed) {
  RequireSmoothable(tape);
  return RtsPass(tape, covariances, errors).Run(consumed);
}

}  // namespace

SmoothedTrajectory SmoothRts(const LinearTape& tape, bool errors) {
  return Smooth(tape, /*covariances=*/true, errors, nullptr);
}

SmoothedTrajectory SmoothRts(LinearTape&& tape, bool errors) {
  return Smooth(tape, /*covariances=*/true, errors, &tape);
}

SmoothedTrajectory SmoothMeans(const LinearTape& tape) {
  return Smooth(tape, /*covariances=*/false, /*errors=*/true, nullptr);
}

}  // namespace hindsight
