#include "receiver_errors/sequence_splice.h"

#include <algorithm>
#include <cmath>

namespace hindsight {
namespace {

/// Joined once so many fixes in a row are taken as in the base, to this [ln].
constexpr std::size_t kFixesAsInBase = 5;
constexpr double kExcessAsInBase = 1e-4;

std::size_t SquareOf(int n) {
  return static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
}

}  // namespace

SequenceSplice::SequenceSplice(const SensorTape& tape,
                               const ErrorParameters& parameters,
                               const ModeSequence& base)
    : tape_(tape),
      parameters_(parameters),
      chain_(tape, parameters),
      base_(base),
      fixes_(base.size()),
      P_(chain_.dim(), base.size()),
      U_(base.size(), SquareOf(chain_.dim())) {
  const Eigen::Index n = chain_.dim();
  const auto count = static_cast<Eigen::Index>(base.size());
  mean_.resize(n, count);
  z_.resize(n, count);
  RunForward();
  RunBackward();
}

bool SequenceSplice::Pass(const ModeSequence& sequence, ErrorChain* chain,
                          Place* at, Taken* taken) {
  chain->MoveTo(at->node++);
  ++at->score.steps;
  chain->PredictNavigation(&at->x);
  if (!chain->has_fix()) {
    chain->PredictError({at->mode}, &at->x);
    at->score.log_likelihood += chain->UpdateAll(false, &at->x);
    return false;
  }
  const ErrorStep step = sequence[at->fix++];
  chain->PredictError(step, &at->x);
  const auto [fix, others, as_used] = chain->UpdateWithFix(step, &at->x);
  at->score.log_likelihood += fix.log + others;
  at->score.log_prior += at->fix == 1
                             ? LogFirst(step, chain->share())
                             : LogTransition(at->mode, step, chain->share());
  at->mode = step.mode;
  *taken = {fix.outlier, fix.log - as_used, fix.log_odds};
  return true;
}

void SequenceSplice::RunForward() {
  Place at;
  at.x = chain_.Begin();
  while (at.node < chain_.size()) {
    const Place before = at;
    Taken taken;
    if (!Pass(base_, &chain_, &at, &taken)) continue;
    const auto column = static_cast<Eigen::Index>(before.fix);
    const Gaussian x = ErrorChain::Resized(before.x, chain_.dim());
    mean_.col(column) = x.mean;
    P_.Set(before.fix, x.P);
    fixes_[before.fix] = {before.node, before.score, taken, at.score.log_prior,
                          0.0};
  }
  total_ = at.score;
}

void SequenceSplice::RunBackward() {
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
      Eigen::Map<Eigen::MatrixXd>(U_.Row(i), n, n) = later.U();
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

SequenceSplice::Place SequenceSplice::PlaceBefore(std::size_t i) const {
  Place place;
  place.node = fixes_[i].node;
  place.fix = i;
  if (i > 0) place.mode = base_[i - 1].mode;
  place.x =
      ErrorChain::Resized({mean_.col(static_cast<Eigen::Index>(i)), P_.Get(i)},
                          chain_.DimOf(place.mode));
  place.score = {fixes_[i].before, 0};
  return place;
}

LaterLikelihood SequenceSplice::After(std::size_t i) const {
  const Eigen::Index n = chain_.dim();
  const auto column = static_cast<Eigen::Index>(i);
  return {Eigen::Map<const Eigen::MatrixXd>(U_.Row(i), n, n), z_.col(column),
          fixes_[i].c};
}

bool SequenceSplice::MayBeAnOutlier(std::size_t i) const {
  const Taken& taken = fixes_[i].taken;
  return !taken.outlier && taken.log_odds < ErrorChain::kSureLogOdds;
}

SequenceSplice::Before SequenceSplice::BeforeFix(std::size_t i) const {
  const Place place = PlaceBefore(i);
  return {place.node, place.mode, place.x};
}

std::optional<SequenceSplice::Spliced> SequenceSplice::Joined(
    std::size_t i, const Place& after) const {
  const double joined = After(i).LogMean(after.x);
  if (!std::isfinite(joined)) return std::nullopt;
  Spliced score = after.score;
  score.log_likelihood += joined;
  score.log_prior += total_.log_prior - fixes_[i].log_prior;
  return score;
}

SequenceSplice::Spliced SequenceSplice::Score(
    const ModeSequence& sequence) const {
  Spliced score = ScoreWithoutPrice(sequence);
  score.log_prior += LogOfVelocitySteps(CountVelocitySteps(sequence));
  return score;
}

bool SequenceSplice::MayBeBetter(const ModeSequence& sequence,
                                 std::size_t i) const {
  constexpr double kLaterExcesses = 1.0;
  if (base_[i].outlier || IsInDoubtBehind(i)) return true;
  ErrorChain chain(tape_, parameters_);
  Place at = PlaceBefore(i);
  Taken taken;
  Pass(sequence, &chain, &at, &taken);
  const std::optional<Spliced> joined = Joined(i, at);
  // Also true where the base's score is not a number.
  return !joined ||
         !(joined->log_posterior() <= total_.log_posterior() - kLaterExcesses);
}

bool SequenceSplice::IsInDoubtBehind(std::size_t i) const {
  constexpr std::size_t kFixes = 30;
  constexpr double kLogOdds = 2.0;
  const std::size_t end = std::min(i + 1 + kFixes, fixes_.size());
  for (std::size_t later = i + 1; later < end; ++later) {
    const Taken& taken = fixes_[later].taken;
    if (taken.outlier || taken.log_odds < kLogOdds) return true;
  }
  return false;
}

SequenceSplice::Spliced SequenceSplice::ScoreWithoutPrice(
    const ModeSequence& sequence) const {
  const auto first = static_cast<std::size_t>(
      std::mismatch(base_.begin(), base_.end(), sequence.begin()).first -
      base_.begin());
  if (first == base_.size()) return {total_, 0};
  std::size_t last = base_.size() - 1;
  while (sequence[last] == base_[last]) --last;
  ErrorChain chain(tape_, parameters_);
  Place at = PlaceBefore(first);
  std::size_t as_in_base = 0;
  while (at.node < chain_.size()) {
    Taken taken;
    if (!Pass(sequence, &chain, &at, &taken)) continue;
    const std::size_t i = at.fix - 1;
    if (i <= last) continue;
    const Taken& base = fixes_[i].taken;
    const bool alike = taken.outlier == base.outlier &&
                       std::abs(taken.excess - base.excess) < kExcessAsInBase;
    as_in_base = alike ? as_in_base + 1 : 0;
    if (as_in_base < kFixesAsInBase) continue;
    const std::optional<Spliced> joined = Joined(i, at);
    if (joined) return *joined;
  }
  return at.score;
}

}  // namespace hindsight
