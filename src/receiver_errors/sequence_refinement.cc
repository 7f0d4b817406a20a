#include "receiver_errors/sequence_refinement.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "receiver_errors/sequence_splice.h"
#include "receiver_errors/sequence_variations.h"

namespace hindsight {
namespace {

/// Hypotheses less likely than the best by this are left out [ln].
constexpr double kLeastPosterior = 10.0;
/// A sequence whose filter breaks down.
constexpr double kImpossible = -1e300;
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

class Refinement {
 public:
  Refinement(const SensorTape& tape, const ErrorParameters& parameters,
             SearchEffort* effort)
      : tape_(tape), parameters_(parameters), effort_(effort) {}

  /// Weights that a search gives have those of merged hypotheses in them: each
  /// is scored on its own.
  void Begin(const std::vector<Hypothesis>& found) {
    Splice(found.front().sequence);
    for (const Hypothesis& one : found) Try(one.sequence, one.count);
  }

  void Climb() {
    for (int round = 0; round < kMostRounds && !IsSpent(); ++round) {
      const ModeSequence base = SpliceBest();
      const auto variations = [&base](const Visit& visit) {
        for (const ModeSequence& h : Variations(base)) {
          if (!visit(h)) return;
        }
      };
      const auto velocity_steps = [&base](const Visit& visit) {
        ForEachVelocityStep(base, visit);
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

  void TryEarlierErrors() {
    ForEachEarlierError(SpliceBest(),
                        [this](const ModeSequence& h, double count) {
                          if (IsSpent()) return false;
                          Try(h, count);
                          return true;
                        });
  }

  ModeSequence Best() const { return met_[best_].sequence; }

  std::vector<Hypothesis> Result() {
    std::sort(met_.begin(), met_.end(), [](const auto& a, const auto& b) {
      return a.log_posterior > b.log_posterior;
    });
    const double least = met_.front().log_posterior - kLeastPosterior;
    std::erase_if(met_, [&](const auto& h) { return h.log_posterior < least; });
    // The mixture of a fix has the outlier in it: both would count it twice.
    std::unordered_set<std::size_t> seen;
    std::erase_if(met_, [&seen](const auto& h) {
      ModeSequence modes = h.sequence;
      for (ErrorStep& step : modes) step.outlier = false;
      return !seen.insert(HashOf(modes)).second;
    });
    return std::move(met_);
  }

 private:
  /// Shown a sequence; whether another is wanted.
  using Visit = std::function<bool(const ModeSequence&)>;

  /// Whether one of those that `show` shows, or several together, are better
  /// than the base, the best.
  bool TryAll(const ModeSequence& base,
              const std::function<void(const Visit&)>& show) {
    const std::size_t before = best_;
    const double level = met_[best_].log_posterior;
    const std::size_t first = met_.size();
    show([this](const ModeSequence& h) {
      if (IsSpent()) return false;
      Try(h);
      return true;
    });
    if (best_ == before) return false;
    Try(Together(base, level, first));
    return true;
  }

  /// Each fix that may be an outlier by what is known before it, and each that is
  /// one by decision as none.
  bool TryOutliers(const ModeSequence& base) {
    return TryAll(base, [&](const Visit& visit) {
      ModeSequence one = base;
      for (std::size_t i = 0; i < base.size(); ++i) {
        if (!base[i].outlier && !splice_->MayBeAnOutlier(i)) continue;
        one[i].outlier = !base[i].outlier;
        if (MayBeBetter(one, i) && !visit(one)) return;
        one[i].outlier = base[i].outlier;
      }
    });
  }

  bool MayBeBetter(const ModeSequence& sequence, std::size_t i) {
    const std::size_t before = splice_->steps();
    const bool may_be = splice_->MayBeBetter(sequence, i);
    if (effort_ != nullptr) effort_->Spend(splice_->steps() - before);
    return may_be;
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

  void Try(const ModeSequence& sequence, double count = 1.0) {
    const std::size_t hash = HashOf(sequence);
    const auto known = kept_.find(hash);
    if (known != kept_.end()) {
      Hypothesis& one = met_[known->second];
      one.count = std::max(one.count, count);
      return;
    }
    if (!tried_.insert(hash).second) return;
    const std::size_t before = splice_->steps();
    const SequenceScore score = splice_->Score(sequence);
    if (effort_ != nullptr) effort_->Spend(splice_->steps() - before);
    double log_posterior = score.log_posterior();
    if (!std::isfinite(log_posterior)) log_posterior = kImpossible;
    // What cannot come back into the result is not kept: there is one for every
    // fix.
    if (!met_.empty() &&
        (log_posterior < met_[best_].log_posterior - kLeastPosterior ||
         (log_posterior <= met_[best_].log_posterior && IsFull()))) {
      return;
    }
    kept_.emplace(hash, met_.size());
    met_.push_back({sequence, log_posterior, count, parameters_});
    if (met_.back().log_posterior > met_[best_].log_posterior) {
      best_ = met_.size() - 1;
    }
  }

  static std::size_t HashOf(const ModeSequence& sequence) {
    constexpr std::size_t kBytes = 4;
    static_assert(sizeof(ErrorStep) == kBytes);
    return std::hash<std::string_view>()(
        {reinterpret_cast<const char*>(sequence.data()),
         kBytes * sequence.size()});
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
  refinement.TryEarlierErrors();
  return refinement.Result();
}

}  // namespace hindsight
