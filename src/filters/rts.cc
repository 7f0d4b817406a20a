#include "filters/rts.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <atomic>
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

/// Steps back that are prepared at once.
constexpr std::size_t kStepsAtOnce = 64;

/// A P A', of which what lies above the diagonal is not said.
ErrorMatrix Sandwiched(const ErrorMatrix& A, const ErrorMatrix& P) {
  ErrorMatrix AP, APA;
  Multiply(A, P, /*lower=*/false, &AP);
  Multiply(AP, A.transpose(), /*lower=*/true, &APA);
  return APA;
}

/// A step back to an epoch: what it takes from the tape alone, whatever was smoothed
/// behind it, and what comes of it.
class StepBack {
 public:
  StepBack(const LinearTape& tape, std::size_t k, bool covariances)
      : epoch_(tape.epoch(k)),
        Phi_(tape.Phi(k + 1)),
        P_plus_(tape.P_plus(k)),
        P_minus_(tape.P_minus(k + 1)) {
    if (epoch_.moves_nominal()) reset_.emplace(tape.ResetTransport(epoch_));
    if (!covariances || !is_possible()) return;
    Q_ = tape.Q(k + 1);
    C_ = TimesTransposed(P_plus_, Phi_);
    DivideByCholesky(P_minus_.matrixLLT(), &C_);
    ErrorMatrix A = ErrorMatrix::Identity(tape.dim(), tape.dim());
    A -= Times(C_, Phi_);
    spread_ = Sandwiched(A, P_plus_);
  }

  /// False if the predicted covariance is not positive definite.
  bool is_possible() const { return P_minus_.info() == Eigen::Success; }
  const TapeEpoch& epoch() const { return epoch_; }

  /// Takes the smoothed error about x_plus and its covariance: from what the error
  /// about x_minus of the next is off dx_minus and, if there are covariances, that of
  /// the next.
  void Smooth(const ErrorVector& off, const ErrorMatrix& next) {
    const ErrorVector ahead = P_minus_.solve(off);
    d_ = P_plus_ * ErrorVector(Phi_.transpose() * ahead);
    if (!epoch_.reset) d_ += epoch_.dx_plus;
    if (spread_.size() == 0) return;
    P_ = Sandwiched(C_, next + Q_) + spread_;
    P_ = ErrorMatrix(P_.selfadjointView<Eigen::Lower>());
  }
  const ErrorVector& d() const { return d_; }
  const ErrorMatrix& P() const { return P_; }
  /// Carries error and covariance into the tangent at x_minus, where the interval
  /// before ends.
  void MoveBefore(ErrorVector* d, ErrorMatrix* P) const {
    if (!reset_) return;
    reset_->Move(d, P);
    *d += epoch_.dx_plus;
  }

 private:
  TapeEpoch epoch_;
  std::optional<WayBack> reset_;     ///< where it moved the nominal
  ErrorMatrix Phi_;                  ///< of the interval that follows
  ErrorMatrix Q_;                    ///< of the interval that follows
  ErrorMatrix P_plus_;               ///< of the epoch
  Eigen::LLT<ErrorMatrix> P_minus_;  ///< of the next
  ErrorMatrix C_;                    ///< P_plus Phi' P_minus^-1
  ErrorMatrix spread_;  ///< (I - C Phi) P_plus (I - C Phi)', lower half
  ErrorVector d_;       ///< smoothed, about x_plus
  ErrorMatrix P_;
};

/// The pass over a tape. Beside the steps that are gone another thread writes what
/// came of those behind them and prepares those before them, by both threads when
/// they are reached.
class RtsPass {
 public:
  RtsPass(const LinearTape& tape, bool covariances, const RtsOptions& options)
      : tape_(tape),
        covariances_(covariances),
        options_(options),
        d_(ErrorVector::Zero(tape.dim())),
        P_(ErrorMatrix::Zero(tape.dim(), tape.dim())) {
    out_.states.resize(tape.size());
    if (options.errors) out_.d.resize(tape.size());
    if (covariances) out_.P = CovarianceSeries(tape.dim(), tape.size());
  }

  SmoothedTrajectory Run(LinearTape* consumed) {
    if (tape_.size() == 0) return std::move(out_);
    BeginAtEnd();
    here_.first = tape_.size() - 1;
    for (std::size_t k = here_.first; k-- > 0;) {
      if (k < here_.first) TakeSteps(k, consumed);
      GoBack(k, &*here_.steps[k - here_.first]);
    }
    if (beside_.valid()) beside_.get();
    Write(here_);
    return std::move(out_);
  }

 private:
  /// Steps to some epochs from `first` on.
  struct Steps {
    std::size_t first = 0;
    std::vector<std::optional<StepBack>> steps;
  };

  /// Begins with steps to epochs before `end`.
  void BeginToPrepare(std::size_t end) {
    there_.steps.resize(std::min(end, kStepsAtOnce));
    there_.first = end - there_.steps.size();
    prepared_ = 0;
  }
  /// Prepares those that nobody has begun with, on any thread.
  void Prepare() {
    for (std::size_t i; (i = prepared_++) < there_.steps.size();) {
      there_.steps[i].emplace(tape_, there_.first + i, covariances_);
    }
  }

  void Write(const Steps& gone) {
    for (std::size_t i = gone.steps.size(); i-- > 0;) {
      const StepBack& step = *gone.steps[i];
      WriteEpoch(gone.first + i, step.epoch(), step.d(), step.P());
    }
  }

  void WriteEpoch(std::size_t k, const TapeEpoch& epoch, const ErrorVector& d,
                  ErrorMatrix P) {
    State& x = out_.states[k];
    x = tape_.StateAt(epoch, d);
    if (!covariances_) return;
    if (options_.covariances == RtsOptions::Tangent::kSmoothed) {
      MoveCovariance(Transport(tape_.layout(), epoch.x_plus, x), &P);
    }
    out_.P.Set(k, P);
  }

  /// The last epoch is smoothed already.
  void BeginAtEnd() {
    const std::size_t last = tape_.size() - 1;
    const TapeEpoch epoch = tape_.back();
    if (!epoch.reset) d_ = epoch.dx_plus;
    if (covariances_) P_ = tape_.P_plus(last);
    WriteEpoch(last, epoch, d_, P_);
    if (epoch.moves_nominal()) {
      WayBack(tape_.ResetTransport(epoch)).Move(&d_, &P_);
      d_ += epoch.dx_plus;
    }
    Leave(last, epoch);
  }

  /// The step to epoch k and some before it. Of `consumed` goes what no step needs
  /// any more.
  void TakeSteps(std::size_t k, LinearTape* consumed) {
    if (!beside_.valid()) BeginToPrepare(k + 1);
    Prepare();
    if (beside_.valid()) beside_.get();
    std::swap(behind_, here_);
    std::swap(here_, there_);
    while (consumed != nullptr && consumed->size() > k + 2) consumed->PopBack();
    BeginToPrepare(here_.first);
    beside_ = InBackground([this] {
      Write(behind_);
      Prepare();
    });
  }

  /// From the tangent at x_minus of epoch k + 1 to that at x_minus of k.
  void GoBack(std::size_t k, StepBack* step) {
    if (!step->is_possible()) {
      throw EstimationError(
          "predicted covariance is not positive definite at t = " +
          std::to_string(t_) + " s");
    }
    step->Smooth(d_ - dx_minus_, P_);
    d_ = step->d();
    if (covariances_) P_ = step->P();
    step->MoveBefore(&d_, &P_);
    Leave(k, step->epoch());
  }

  void Leave(std::size_t k, const TapeEpoch& epoch) {
    if (options_.errors) out_.d[k] = d_;
    t_ = epoch.t;
    dx_minus_ = epoch.dx_minus;
  }

  const LinearTape& tape_;
  bool covariances_;
  RtsOptions options_;
  ErrorVector d_;  ///< about x_minus of the epoch that was smoothed last
  ErrorMatrix P_;
  double t_ = 0.0;        ///< of that epoch
  ErrorVector dx_minus_;  ///< of that epoch
  SmoothedTrajectory out_;
  Steps behind_;                           ///< that are written
  Steps here_;                             ///< that are gone
  Steps there_;                            ///< that are prepared
  std::atomic<std::size_t> prepared_ = 0;  ///< of these, or begun with
  std::future<void> beside_;               ///< the last member: it waits
};

SmoothedTrajectory Smooth(const LinearTape& tape, bool covariances,
                          const RtsOptions& options, LinearTape* consumed) {
  RequireSmoothable(tape);
  return RtsPass(tape, covariances, options).Run(consumed);
}

}  // namespace

SmoothedTrajectory SmoothRts(const LinearTape& tape,
                             const RtsOptions& options) {
  return Smooth(tape, /*covariances=*/true, options, nullptr);
}

SmoothedTrajectory SmoothRts(LinearTape&& tape, const RtsOptions& options) {
  return Smooth(tape, /*covariances=*/true, options, &tape);
}

SmoothedTrajectory SmoothMeans(const LinearTape& tape) {
  return Smooth(tape, /*covariances=*/false, {}, nullptr);
}

}  // namespace hindsight
