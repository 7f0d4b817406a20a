#include "filters/history_refinement.h"

#include <algorithm>
#include <cmath>

#include "filters/history_smoother.h"

namespace hindsight {
namespace {

/// Histories less likely than the best by this are left out [ln].
constexpr double kLeastPosterior = 10.0;
/// Fixes of the shortest earlier bias that is looked for, and the ratio of the
/// lengths that are.
constexpr std::size_t kShortest = 5;
constexpr double kLengthRatio = 1.25;
/// Of the search's histories, whose weights have those of merged ones in them,
/// so many are scored on their own.
constexpr std::size_t kMostRescored = 8;
/// Rounds of variations, if a climb does not rest before.
constexpr int kMostRounds = 6;

ErrorMode ModeBefore(const ErrorHistory& h, std::size_t i) {
  return i == 0 ? ErrorMode::kGood : h[i - 1].mode;
}

/// Fixes at which something changes, and the end.
std::vector<std::size_t> Changes(const ErrorHistory& h) {
  std::vector<std::size_t> at;
  for (std::size_t i = 0; i < h.size(); ++i) {
    if (h[i].anew || h[i].jolt || h[i].mode != ModeBefore(h, i))
      at.push_back(i);
  }
  at.push_back(h.size());
  return at;
}

/// Fills [begin, end) with what goes on in a mode.
void GoOn(ErrorMode mode, std::size_t begin, std::size_t end, ErrorHistory* h) {
  for (std::size_t i = begin; i < end; ++i) (*h)[i] = {mode};
}

/// The history with its change at `from`, between `first` and `end`, at `to`.
ErrorHistory Moved(ErrorHistory h, std::size_t from, std::size_t to) {
  const ErrorStep step = h[from];
  GoOn(ModeBefore(h, from), from, to, &h);
  GoOn(step.mode, to, from + 1, &h);
  h[to] = step;
  return h;
}

ErrorHistory WithSegment(ErrorHistory h, std::size_t begin, std::size_t end,
                         ErrorStep step) {
  GoOn(step.mode, begin, end, &h);
  h[begin] = step;
  return h;
}

/// From change c on the receiver is good and the IMU jolts instead.
ErrorHistory WithJolts(ErrorHistory h, const std::vector<std::size_t>& at,
                       std::size_t c) {
  const bool returns = ModeBefore(h, at[c]) != ErrorMode::kGood;
  GoOn(ErrorMode::kGood, at[c], h.size(), &h);
  for (std::size_t i = returns ? c + 1 : c; i + 1 < at.size(); ++i) {
    h[at[i]].jolt = true;
  }
  return h;
}

std::vector<ErrorHistory> Variations(const ErrorHistory& h) {
  std::vector<ErrorHistory> all;
  const std::vector<std::size_t> at = Changes(h);
  for (std::size_t c = 0; c + 1 < at.size(); ++c) {
    const std::size_t least = c == 0 ? 0 : at[c - 1] + 1;
    for (const std::size_t shift : {1u, 2u, 4u, 8u}) {
      if (at[c] >= least + shift) {
        all.push_back(Moved(h, at[c], at[c] - shift));
      }
      if (at[c] + shift < at[c + 1]) {
        all.push_back(Moved(h, at[c], at[c] + shift));
      }
    }
    for (const ErrorStep step : StepsAfter(ModeBefore(h, at[c]))) {
      all.push_back(WithSegment(h, at[c], at[c + 1], step));
    }
    all.push_back(WithJolts(h, at, c));
    // An error too small to be found alone may have come before a larger one.
    for (std::size_t length = kShortest; at[c] >= least + length; length *= 2) {
      all.push_back(
          WithSegment(h, at[c] - length, at[c], {ErrorMode::kBiased, true}));
    }
  }
  return all;
}

class Refinement {
 public:
  Refinement(const LinearTape& tape, int receiver,
             const ErrorParameters& parameters)
      : tape_(tape), receiver_(receiver), parameters_(parameters) {}

  void Try(const ErrorHistory& history, double count = 1.0) {
    for (ScoredHistory& one : met_) {
      if (one.history != history) continue;
      one.count = std::max(one.count, count);
      return;
    }
    const HistoryScore score =
        ScoreHistory(tape_, receiver_, parameters_, history);
    met_.push_back({history, score.log_likelihood + score.log_prior, count});
    if (met_.back().log_posterior > met_[best_].log_posterior) {
      best_ = met_.size() - 1;
    }
  }

  void Climb() {
    for (int round = 0; round < kMostRounds; ++round) {
      const std::size_t before = best_;
      for (const ErrorHistory& h : Variations(met_[best_].history)) Try(h);
      if (best_ == before) break;
    }
  }

  /// An error too small to be found alone may have begun at any time before a
  /// larger one: each time is unlikely, all together may not be.
  void TryEarlierBiases() {
    const ErrorHistory best = met_[best_].history;
    const std::vector<std::size_t> at = Changes(best);
    for (std::size_t c = 0; c + 1 < at.size(); ++c) {
      const std::size_t least = c == 0 ? 0 : at[c - 1] + 1;
      std::size_t next = 0;
      for (std::size_t length = kShortest; at[c] >= least + length;
           length = next) {
        next = static_cast<std::size_t>(
            std::ceil(kLengthRatio * static_cast<double>(length)));
        Try(WithSegment(best, at[c] - length, at[c],
                        {ErrorMode::kBiased, true}),
            static_cast<double>(next - length));
      }
    }
  }

  std::vector<ScoredHistory> Result() {
    std::sort(met_.begin(), met_.end(), [](const auto& a, const auto& b) {
      return a.log_posterior > b.log_posterior;
    });
    const double least = met_.front().log_posterior - kLeastPosterior;
    std::erase_if(met_, [&](const auto& h) { return h.log_posterior < least; });
    return std::move(met_);
  }

 private:
  const LinearTape& tape_;
  int receiver_;
  const ErrorParameters& parameters_;
  std::vector<ScoredHistory> met_;
  std::size_t best_ = 0;
};

}  // namespace

std::vector<ScoredHistory> RefineHistories(
    const LinearTape& tape, int receiver, const ErrorParameters& parameters,
    const std::vector<ScoredHistory>& found) {
  Refinement refinement(tape, receiver, parameters);
  for (std::size_t i = 0; i < std::min(kMostRescored, found.size()); ++i) {
    refinement.Try(found[i].history);
  }
  refinement.Climb();
  refinement.TryEarlierBiases();
  return refinement.Result();
}

}  // namespace hindsight
