#include "receiver_errors/history_splice.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/units.h"

namespace hindsight {
namespace {

/// Joined once so many fixes in a row are taken as in the base, to this [ln].
constexpr int kFixesAsInBase = 5;
constexpr double kExcessAsInBase = 1e-4;

/// ln L(x) = c - |U x - z|^2 / 2.
class LaterLikelihood {
 public:
  explicit LaterLikelihood(int n)
      : U_(ErrorMatrix::Zero(n, n)), z_(ErrorVector::Zero(n)) {}

  const ErrorMatrix& U() const { return U_; }
  const ErrorVector& z() const { return z_; }
  double c() const { return c_; }

  void AddConstant(double c) { c_ += c; }

  void Add(const LinearizedMeasurement& y) {
    const Eigen::LLT<RowMatrix> llt(y.R);
    if (llt.info() != Eigen::Success) {
      throw EstimationError("measurement noise is not positive definite");
    }
    const Eigen::Index n = z_.size();
    const Eigen::Index rows = y.residual.size();
    Rows stacked(n + rows, n + 1);
    stacked.topLeftCorner(n, n) = U_;
    stacked.topRightCorner(n, 1) = z_;
    stacked.bottomLeftCorner(rows, n) = llt.matrixL().solve(y.H);
    stacked.bottomRightCorner(rows, 1) = llt.matrixL().solve(y.residual);
    const Eigen::HouseholderQR<Rows> qr(stacked);
    const auto& R = qr.matrixQR();
    U_ = R.topLeftCorner(n, n).triangularView<Eigen::Upper>();
    z_ = R.col(n).head(n);
    c_ -= 0.5 * R(n, n) * R(n, n) +
          llt.matrixLLT().diagonal().array().log().sum() +
          0.5 * static_cast<double>(rows) * std::log(2.0 * kPi);
  }

  void BackOver(const ErrorMatrix& Phi, const ErrorMatrix& Q,
                const ErrorVector& d) {
    ErrorMatrix S = ErrorMatrix::Identity(z_.size(), z_.size());
    const ErrorMatrix UQ = U_ * Q;
    S.noalias() += UQ * U_.transpose();
    const Eigen::LLT<ErrorMatrix> G(S);
    c_ -= G.matrixLLT().diagonal().array().log().sum();
    z_ -= U_ * d;
    G.matrixL().solveInPlace(z_);
    U_ = (U_ * Phi).eval();
    G.matrixL().solveInPlace(U_);
  }

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                             kMaxErrorDim + kMaxRows, kMaxErrorDim + 1>;
  ErrorMatrix U_;
  ErrorVector z_;
  double c_ = 0.0;
};

}  // namespace

HistorySplice::HistorySplice(const LinearTape& tape, int receiver,
                             const ErrorParameters& parameters,
                             const ErrorHistory& base)
    : chain_(tape, receiver, parameters),
      base_(base),
      fixes_(base.size()),
      P_(chain_.dim(), base.size()) {
  const Eigen::Index n = chain_.dim();
  const auto count = static_cast<Eigen::Index>(base.size());
  mean_.resize(n, count);
  U_.resize(n, n * count);
  z_.resize(n, count);
  RunForward();
  RunBackward();
}

bool HistorySplice::Pass(const ErrorHistory& history, Place* at, Taken* taken) {
  chain_.MoveTo(at->node++);
  at->x = chain_.PredictNavigation(at->x);
  if (!chain_.has_fix()) {
    chain_.PredictError({at->mode}, &at->x);
    at->score.log_likelihood += chain_.UpdateAll(false, &at->x);
    return false;
  }
  const ErrorStep step = history[at->fix++];
  chain_.PredictError(step, &at->x);
  const auto fix = chain_.LikelihoodOfFix(at->x);
  used_.clear();
  const double others = chain_.UpdateAll(fix.outlier, &at->x, &used_);
  at->score.log_likelihood += fix.log + others;
  at->score.log_prior += LogTransition(at->mode, step, chain_.fix_count());
  at->mode = step.mode;
  *taken = {fix.outlier, fix.log + others};
  for (const ErrorChain::Used& used : used_) {
    taken->excess -= used.innovation.log_likelihood;
  }
  return true;
}

void HistorySplice::RunForward() {
  Place at;
  at.x = chain_.Begin();
  while (at.node < chain_.size()) {
    const Place before = at;
    Taken taken;
    if (!Pass(base_, &at, &taken)) continue;
    const auto column = static_cast<Eigen::Index>(before.fix);
    mean_.col(column) = before.x.mean;
    P_.Set(before.fix, before.x.P);
    fixes_[before.fix] = {before.node, before.score, taken, at.score.log_prior,
                          0.0};
  }
  total_ = at.score;
}

void HistorySplice::RunBackward() {
  const Eigen::Index n = chain_.dim();
  LaterLikelihood later(chain_.dim());
  std::size_t i = fixes_.size();
  for (std::size_t k = chain_.size(); i > 0; --k) {
    chain_.MoveTo(k - 1);
    ErrorStep step = {base_[i - 1].mode};
    Taken taken;
    if (chain_.has_fix()) {
      --i;
      step = base_[i];
      taken = fixes_[i].taken;
      const auto column = static_cast<Eigen::Index>(i);
      U_.middleCols(n * column, n) = later.U();
      z_.col(column) = later.z();
      fixes_[i].c = later.c();
    }
    for (std::size_t m = 0; m < chain_.measurements().size(); ++m) {
      later.Add(chain_.MeasurementAs(m, taken.outlier));
    }
    later.AddConstant(taken.excess);
    if (i > 0)
      later.BackOver(chain_.Phi(step), chain_.Q(step), chain_.Defect());
  }
}

HistorySplice::Place HistorySplice::PlaceBefore(std::size_t i) const {
  Place place;
  place.node = fixes_[i].node;
  place.fix = i;
  if (i > 0) place.mode = base_[i - 1].mode;
  place.x = {mean_.col(static_cast<Eigen::Index>(i)), P_.Get(i)};
  place.score = fixes_[i].before;
  return place;
}

std::optional<HistoryScore> HistorySplice::Joined(std::size_t i,
                                                  const Place& after) const {
  const Eigen::Index n = chain_.dim();
  const auto column = static_cast<Eigen::Index>(i);
  const auto U = U_.middleCols(n * column, n);
  ErrorMatrix S = ErrorMatrix::Identity(n, n);
  const ErrorMatrix UP = U * after.x.P;
  S.noalias() += UP * U.transpose();
  const Eigen::LLT<ErrorMatrix> G(S);
  if (G.info() != Eigen::Success) return std::nullopt;
  ErrorVector whitened = z_.col(column) - U * after.x.mean;
  G.matrixL().solveInPlace(whitened);
  HistoryScore score = after.score;
  score.log_likelihood += fixes_[i].c - 0.5 * whitened.squaredNorm() -
                          G.matrixLLT().diagonal().array().log().sum();
  score.log_prior += total_.log_prior - fixes_[i].log_prior;
  return score;
}

HistoryScore HistorySplice::Score(const ErrorHistory& history) {
  const auto first = static_cast<std::size_t>(
      std::mismatch(base_.begin(), base_.end(), history.begin()).first -
      base_.begin());
  if (first == base_.size()) return total_;
  std::size_t last = base_.size() - 1;
  while (history[last] == base_[last]) --last;
  Place at = PlaceBefore(first);
  int as_in_base = 0;
  while (at.node < chain_.size()) {
    Taken taken;
    if (!Pass(history, &at, &taken)) continue;
    const std::size_t i = at.fix - 1;
    if (i <= last) continue;
    const Taken& base = fixes_[i].taken;
    const bool alike = taken.outlier == base.outlier &&
                       std::abs(taken.excess - base.excess) < kExcessAsInBase;
    as_in_base = alike ? as_in_base + 1 : 0;
    if (as_in_base < kFixesAsInBase) continue;
    const std::optional<HistoryScore> joined = Joined(i, at);
    if (joined) return *joined;
  }
  return at.score;
}

}  // namespace hindsight
