#include "receiver_errors/sequence_trials.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>

#include "base/error.h"
#include "base/parallel.h"

namespace hindsight {
namespace {

/// Of a sequence whose filter breaks down.
constexpr double kImpossible = -1e300;

void ScoreOne(const SequenceTrial& trial, const SequenceSplice& splice,
              TrialScore* score) {
  if (trial.outlier) {
    ++score->steps;
    if (!splice.MayBeBetter(trial.sequence, *trial.outlier)) return;
  }
  const SequenceSplice::Spliced spliced = splice.Score(trial.sequence);
  score->steps += spliced.steps;
  const double log_posterior = spliced.log_posterior();
  score->log_posterior =
      std::isfinite(log_posterior) ? log_posterior : kImpossible;
}

}  // namespace

std::size_t HashOf(const ModeSequence& sequence) {
  constexpr std::size_t kBytes = 5;
  static_assert(sizeof(ErrorStep) == kBytes);
  return std::hash<std::string_view>()(
      {reinterpret_cast<const char*>(sequence.data()),
       kBytes * sequence.size()});
}

std::vector<TrialScore> ScoresOf(const std::vector<SequenceTrial>& trials,
                                 const SequenceSplice& splice,
                                 const std::unordered_set<std::size_t>& tried) {
  std::vector<TrialScore> scores(trials.size());
  std::unordered_set<std::size_t> met;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    TrialScore& score = scores[i];
    score.hash = HashOf(trials[i].sequence);
    score.is_new = !tried.contains(score.hash) && met.insert(score.hash).second;
  }
  ForRanges(trials.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!scores[i].is_new) continue;
      try {
        ScoreOne(trials[i], splice, &scores[i]);
      } catch (const EstimationError&) {
        scores[i].failure = std::current_exception();
      }
    }
  });
  return scores;
}

std::vector<ModeSequence> LikeliestBehind(
    const std::vector<SequenceTrial>& trials,
    const std::vector<TrialScore>& scores, double level,
    const ScoresBehind& asked) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (!scores[i].log_posterior) continue;
    const double behind = level - *scores[i].log_posterior;
    if (behind > asked.nearest && behind < asked.farthest) order.push_back(i);
  }
  std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t i) {
    return *scores[i].log_posterior;
  });
  std::vector<ModeSequence> likeliest;
  for (const std::size_t i : order) {
    if (likeliest.size() == asked.most) break;
    likeliest.push_back(trials[i].sequence);
  }
  return likeliest;
}

}  // namespace hindsight
