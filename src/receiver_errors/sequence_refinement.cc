#include "receiver_errors/sequence_refinement.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "base/parallel.h"
#include "receiver_errors/hidden_changes.h"
#include "receiver_errors/sequence_splice.h"
#include "receiver_errors/sequence_trials.h"
#include "receiver_errors/sequence_variations.h"

namespace hindsight {
namespace {

/// Hypotheses less likely than the best by this are left out [ln].
constexpr double kLeastPosterior = 10.0;
/// Rounds of variations, if a climb does not rest before.
constexpr int kMostRounds = 20;
/// Variations of a round that together may be better still are so many fixes
/// apart.
constexpr std::size_t kApart = 10;

/// Fixes at which two hypotheses differ, first and past the last.
struct Stretch {
  std::size_t begin = 0;
  std::size_t end = 0;
};

Stretch WhereTheyDiffer(const ModeSequence& a, const ModeSequence& b) {
  Stretch out{a.size(), 0};
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i]) continue;
    out.begin = std::min(out.begin, i);
    out.end = i + 1;
  }
  return out;
}

/// Shown a trial; whether another is wanted.
using Visit = std::function<bool(SequenceTrial)>;
using Show = std::function<void(const Visit&)>;

class Refinement {
 public:
  Refinement(const SensorTape& tape, const ErrorParameters& parameters,
             SearchEffort* effort)
      : tape_(tape),
        parameters_(parameters),
        effort_(effort),
        behind_gaps_(FixesBehindGaps(tape)) {}

  /// Weights that a search gives have those of merged hypotheses in them: each
  /// is scored on its own.
  void Begin(const std::vector<Hypothesis>& found) {
    Splice(found.front().sequence);
    const auto all = [&found](const Visit& visit) {
      for (const Hypothesis& one : found) visit({one.sequence, one.count});
    };
    TryEach(all, Until::kDone);
  }

  void Climb() {
    for (int round = 0; round < kMostRounds && !IsSpent(); ++round) {
      const ModeSequence base = SpliceBest();
      const auto variations = [&base](const Visit& visit) {
        for (ModeSequence& h : Variations(base)) {
          if (!visit({std::move(h)})) return;
        }
      };
      const auto velocity_steps = [&base](const Visit& visit) {
        ForEachVelocityStep(
            base, [&visit](const ModeSequence& h) { return visit({h}); });
      };
      if (!TryAll(base, variations) && !TryAll(base, velocity_steps) &&
          !TryOutliers(base)) {
        break;
      }
    }
  }

  void ClimbOutliers() {
    for (int round = 0; round < kMostRounds && !IsSpent(); ++round) {
      if (!TryOutliers(SpliceBest())) break;
    }
  }

  /// Climbs again from what is better. What a fix is taken for hangs on the change, so
  /// that the likeliest get outliers of their own.
  void TryHiddenChanges() {
    constexpr int kMostTimes = 2;
    for (int i = 0; i < kMostTimes && !IsSpent(); ++i) {
      const std::size_t before = best_;
      for (const ModeSequence& one : LikeliestHiddenChanges()) {
        if (IsSpent()) break;
        Try({{hindsight::ClimbOutliers(tape_, parameters_, one, effort_)}},
            Until::kDone);
      }
      if (best_ == before) return;
      Climb();
    }
  }

  void TryEarlierErrors() {
    const ModeSequence base = SpliceBest();
    const auto earlier = [&base](const Visit& visit) {
      ForEachEarlierError(base, [&visit](const ModeSequence& h, double count) {
        return visit({h, count});
      });
    };
    TryEach(earlier, Until::kSpent);
  }

  ModeSequence Best() const { return met_[best_].sequence; }

  std::vector<Hypothesis> Result() {
    std::sort(met_.begin(), met_.end(), [](const auto& a, const auto& b) {
      return a.log_posterior > b.log_posterior;
    });
    const double least = met_.front().log_posterior - kLeastPosterior;
    std::erase_if(met_, [&](const auto& h) { return h.log_posterior < least; });
    // The mixture of a fix has the outlier in it, and what begins as usual what begins in
    // a quarter: both would count it twice.
    std::unordered_set<std::size_t> seen;
    std::erase_if(met_, [&seen](const auto& h) {
      ModeSequence modes = h.sequence;
      for (ErrorStep& step : modes) {
        step.outlier = false;
        step.onset = Onset::kUsual;
      }
      return !seen.insert(HashOf(modes)).second;
    });
    return std::move(met_);
  }

 private:
  /// To where trials are scored: all, or as many as the effort suffices for.
  enum class Until { kDone, kSpent };

  /// Whether one of those that `show` shows, or several together, are better
  /// than the base, the best.
  bool TryAll(const ModeSequence& base, const Show& show) {
    const std::size_t before = best_;
    const double level = met_[best_].log_posterior;
    const std::size_t first = met_.size();
    TryEach(show, Until::kSpent);
    if (best_ == before) return false;
    Try({{Together(base, level, first)}}, Until::kDone);
    return true;
  }

  /// As if one were tried after the other; those that come in vain, behind the end of
  /// the effort, are few.
  void TryEach(const Show& show, Until until) {
    constexpr int kOfAThread = 8;
    const std::size_t most =
        ThreadCount() == 1
            ? 1
            : static_cast<std::size_t>(kOfAThread * ThreadCount());
    std::vector<SequenceTrial> trials;
    const auto try_those = [&] {
      Try(trials, until);
      trials.clear();
      return until == Until::kDone || !IsSpent();
    };
    if (until == Until::kSpent && IsSpent()) return;
    show([&](SequenceTrial one) {
      trials.push_back(std::move(one));
      return trials.size() < most || try_those();
    });
    try_those();
  }

  /// Each fix that may be an outlier by what is known before it, and each that is
  /// one by decision as none.
  bool TryOutliers(const ModeSequence& base) {
    return TryAll(base, [&](const Visit& visit) {
      for (std::size_t i = 0; i < base.size(); ++i) {
        if (!base[i].outlier && !splice_->MayBeAnOutlier(i)) continue;
        SequenceTrial one = {base};
        one.sequence[i].outlier = !base[i].outlier;
        one.outlier = i;
        if (!visit(std::move(one))) return;
      }
    });
  }

  /// Those of the best are tried with its outliers. The likeliest that are not kept with
  /// these.
  std::vector<ModeSequence> LikeliestHiddenChanges() {
    constexpr std::size_t kMost = 4;
    constexpr double kReach = 60.0;  // that outliers may gain [ln]
    const ModeSequence base = SpliceBest();
    std::vector<SequenceTrial> trials;
    for (ModeSequence& h : HiddenChanges(base, behind_gaps_)) {
      trials.push_back({std::move(h)});
    }
    const std::vector<TrialScore> scores = ScoresOf(trials, *splice_, tried_);
    Take(trials, scores, Until::kSpent);
    return LikeliestBehind(
        trials, scores, met_[best_].log_posterior,
        {.nearest = kLeastPosterior, .farthest = kReach, .most = kMost});
  }

  ModeSequence SpliceBest() {
    ModeSequence best = met_[best_].sequence;
    Splice(best);
    return best;
  }

  /// The base with the best of the variations met since `first` that leave each
  /// other alone.
  ModeSequence Together(const ModeSequence& base, double level,
                        std::size_t first) const {
    std::vector<const Hypothesis*> better;
    for (std::size_t i = first; i < met_.size(); ++i) {
      if (met_[i].log_posterior > level) better.push_back(&met_[i]);
    }
    std::sort(better.begin(), better.end(), [](const auto* a, const auto* b) {
      return a->log_posterior > b->log_posterior;
    });
    ModeSequence all = base;
    std::vector<Stretch> taken;
    for (const Hypothesis* one : better) {
      const Stretch at = WhereTheyDiffer(base, one->sequence);
      const bool free =
          std::none_of(taken.begin(), taken.end(), [&](const Stretch& other) {
            return at.begin < other.end + kApart &&
                   other.begin < at.end + kApart;
          });
      if (!free) continue;
      taken.push_back(at);
      for (std::size_t i = at.begin; i < at.end; ++i) all[i] = one->sequence[i];
    }
    return all;
  }

  void Try(const std::vector<SequenceTrial>& trials, Until until) {
    if (until == Until::kSpent && IsSpent()) return;
    Take(trials, ScoresOf(trials, *splice_, tried_), until);
  }

  void Take(const std::vector<SequenceTrial>& trials,
            const std::vector<TrialScore>& scores, Until until) {
    for (std::size_t i = 0; i < trials.size(); ++i) {
      if (until == Until::kSpent && IsSpent()) return;
      const auto known = kept_.find(scores[i].hash);
      if (known != kept_.end()) {
        Hypothesis& one = met_[known->second];
        one.count = std::max(one.count, trials[i].count);
      } else if (scores[i].is_new) {
        tried_.insert(scores[i].hash);
        if (scores[i].failure) std::rethrow_exception(scores[i].failure);
        if (effort_ != nullptr) effort_->Spend(scores[i].steps);
        if (scores[i].log_posterior) Keep(trials[i], scores[i]);
      }
    }
  }

  /// What cannot come back into the result is not kept: there is one for every
  /// fix.
  void Keep(const SequenceTrial& trial, const TrialScore& score) {
    const double log_posterior = *score.log_posterior;
    if (!met_.empty() &&
        (log_posterior < met_[best_].log_posterior - kLeastPosterior ||
         (log_posterior <= met_[best_].log_posterior && IsFull()))) {
      return;
    }
    kept_.emplace(score.hash, met_.size());
    met_.push_back({trial.sequence, log_posterior, trial.count, parameters_});
    if (met_.back().log_posterior > met_[best_].log_posterior) {
      best_ = met_.size() - 1;
    }
  }

  bool IsFull() const {
    return met_.size() * met_.front().sequence.size() > kMostKeptSteps;
  }

  bool IsSpent() const { return effort_ != nullptr && effort_->IsSpent(); }

  void Splice(const ModeSequence& base) {
    splice_.emplace(tape_, parameters_, base);
    if (effort_ != nullptr) effort_->Spend(2 * tape_.size());
  }

  const SensorTape& tape_;
  const ErrorParameters& parameters_;
  SearchEffort* effort_;
  std::vector<std::size_t> behind_gaps_;  ///< fixes
  std::optional<SequenceSplice> splice_;
  std::vector<Hypothesis> met_;
  std::unordered_set<std::size_t> tried_;              ///< by hash
  std::unordered_map<std::size_t, std::size_t> kept_;  ///< place in met_
  std::size_t best_ = 0;
};

}  // namespace

ModeSequence ClimbSequences(const SensorTape& tape,
                            const ErrorParameters& parameters,
                            const std::vector<Hypothesis>& found,
                            SearchEffort* effort) {
  Refinement refinement(tape, parameters, effort);
  refinement.Begin(found);
  refinement.Climb();
  return refinement.Best();
}

ModeSequence ClimbOutliers(const SensorTape& tape,
                           const ErrorParameters& parameters,
                           const ModeSequence& sequence, SearchEffort* effort) {
  Refinement refinement(tape, parameters, effort);
  refinement.Begin({{sequence}});
  refinement.ClimbOutliers();
  return refinement.Best();
}

std::vector<Hypothesis> RefineHypotheses(const SensorTape& tape,
                                         const ErrorParameters& parameters,
                                         const std::vector<Hypothesis>& found,
                                         SearchEffort* effort) {
  Refinement refinement(tape, parameters, effort);
  refinement.Begin(found);
  refinement.Climb();
  refinement.TryHiddenChanges();
  refinement.TryEarlierErrors();
  return refinement.Result();
}

}  // namespace hindsight
