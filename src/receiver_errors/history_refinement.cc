#include "receiver_errors/history_refinement.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "receiver_errors/history_splice.h"
#include "receiver_errors/history_variations.h"

namespace hindsight {
namespace {

/// Histories less likely than the best by this are left out [ln].
constexpr double kLeastPosterior = 10.0;
/// A history whose filter breaks down.
constexpr double kImpossible = -1e300;
/// Rounds of variations, if a climb does not rest before.
constexpr int kMostRounds = 20;
/// Variations of a round that together may be better still are so many fixes
/// apart.
constexpr std::size_t kApart = 10;

/// Fixes at which two histories differ, first and past the last.
struct Stretch {
  std::size_t begin = 0;
  std::size_t end = 0;
};

Stretch WhereTheyDiffer(const ErrorHistory& a, const ErrorHistory& b) {
  Stretch out{a.size(), 0};
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i]) continue;
    out.begin = std::min(out.begin, i);
    out.end = i + 1;
  }
  return out;
}

class Refinement {
 public:
  Refinement(const LinearTape& tape, int receiver,
             const ErrorParameters& parameters)
      : tape_(tape), receiver_(receiver), parameters_(parameters) {}

  /// Weights that a search gives have those of merged histories in them: each
  /// is scored on its own.
  void Begin(const std::vector<ScoredHistory>& found) {
    splice_.emplace(tape_, receiver_, parameters_, found.front().history);
    for (const ScoredHistory& one : found) Try(one.history, one.count);
  }

  void Climb() {
    for (int round = 0; round < kMostRounds; ++round) {
      const ErrorHistory base = SpliceBest();
      if (!TryAll(base, Variations(base)) && !TryAll(base, WithOneJolt(base))) {
        break;
      }
    }
  }

  void TryEarlierErrors() {
    const ErrorHistory base = SpliceBest();
    for (const ScoredHistory& one : EarlierErrors(base)) {
      Try(one.history, one.count);
    }
  }

  ErrorHistory Best() const { return met_[best_].history; }

  std::vector<ScoredHistory> Result() {
    std::sort(met_.begin(), met_.end(), [](const auto& a, const auto& b) {
      return a.log_posterior > b.log_posterior;
    });
    const double least = met_.front().log_posterior - kLeastPosterior;
    std::erase_if(met_, [&](const auto& h) { return h.log_posterior < least; });
    return std::move(met_);
  }

 private:
  /// Whether one, or several together, are better than the base, the best.
  bool TryAll(const ErrorHistory& base, const std::vector<ErrorHistory>& all) {
    const std::size_t before = best_;
    const double level = met_[best_].log_posterior;
    const std::size_t first = met_.size();
    for (const ErrorHistory& h : all) Try(h);
    if (best_ == before) return false;
    Try(Together(base, level, first));
    return true;
  }

  ErrorHistory SpliceBest() {
    ErrorHistory best = met_[best_].history;
    splice_.emplace(tape_, receiver_, parameters_, best);
    return best;
  }

  /// The base with the best of the variations met since `first` that leave each
  /// other alone.
  ErrorHistory Together(const ErrorHistory& base, double level,
                        std::size_t first) const {
    std::vector<const ScoredHistory*> better;
    for (std::size_t i = first; i < met_.size(); ++i) {
      if (met_[i].log_posterior > level) better.push_back(&met_[i]);
    }
    std::sort(better.begin(), better.end(), [](const auto* a, const auto* b) {
      return a->log_posterior > b->log_posterior;
    });
    ErrorHistory all = base;
    std::vector<Stretch> taken;
    for (const ScoredHistory* one : better) {
      const Stretch at = WhereTheyDiffer(base, one->history);
      const bool free =
          std::none_of(taken.begin(), taken.end(), [&](const Stretch& other) {
            return at.begin < other.end + kApart &&
                   other.begin < at.end + kApart;
          });
      if (!free) continue;
      taken.push_back(at);
      for (std::size_t i = at.begin; i < at.end; ++i) all[i] = one->history[i];
    }
    return all;
  }

  void Try(const ErrorHistory& history, double count = 1.0) {
    for (ScoredHistory& one : met_) {
      if (one.history != history) continue;
      one.count = std::max(one.count, count);
      return;
    }
    const HistoryScore score = splice_->Score(history);
    const double log_posterior = score.log_likelihood + score.log_prior;
    met_.push_back({history,
                    std::isfinite(log_posterior) ? log_posterior : kImpossible,
                    count, parameters_});
    if (met_.back().log_posterior > met_[best_].log_posterior) {
      best_ = met_.size() - 1;
    }
  }

  const LinearTape& tape_;
  int receiver_;
  const ErrorParameters& parameters_;
  std::optional<HistorySplice> splice_;
  std::vector<ScoredHistory> met_;
  std::size_t best_ = 0;
};

}  // namespace

ErrorHistory ClimbHistories(const LinearTape& tape, int receiver,
                            const ErrorParameters& parameters,
                            const std::vector<ScoredHistory>& found) {
  Refinement refinement(tape, receiver, parameters);
  refinement.Begin(found);
  refinement.Climb();
  return refinement.Best();
}

std::vector<ScoredHistory> RefineHistories(
    const LinearTape& tape, int receiver, const ErrorParameters& parameters,
    const std::vector<ScoredHistory>& found) {
  Refinement refinement(tape, receiver, parameters);
  refinement.Begin(found);
  refinement.Climb();
  refinement.TryEarlierErrors();
  return refinement.Result();
}

}  // namespace hindsight
