#include "receiver_errors/history_alternatives.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "receiver_errors/history_smoother.h"

namespace hindsight {
namespace {
struct Kept {
  const ScoredHistory* scored = nullptr;
  double weight = 0.0;  ///< not normalised
};

/// Histories of the same modes in the same order.
struct Story {
  double weight = 0.0;  ///< of all of them
  std::size_t kept = 0;
  double kept_weight = 0.0;
};

std::vector<Kept> Keep(const ErrorRegimes& regimes) {
  constexpr std::size_t kMost = 24;
  constexpr std::size_t kMostOfOne = 8;
  constexpr double kLeast = 1e-9;
  const double best = regimes.histories.front().log_posterior;
  std::vector<Kept> all;
  std::map<std::vector<ErrorMode>, Story> stories;
  for (const ScoredHistory& h : regimes.histories) {
    const double weight = h.count * std::exp(h.log_posterior - best);
    if (weight < kLeast) continue;
    stories[StoryOf(h.history)].weight += weight;
    all.push_back({&h, weight});
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return a.weight > b.weight;
  });
  std::vector<Kept> kept;
  for (const Kept& one : all) {
    if (kept.size() == kMost) break;
    Story& story = stories[StoryOf(one.scored->history)];
    if (story.kept == kMostOfOne) continue;
    ++story.kept;
    story.kept_weight += one.weight;
    kept.push_back(one);
  }
  for (Kept& one : kept) {
    const Story& story = stories[StoryOf(one.scored->history)];
    one.weight *= story.weight / story.kept_weight;
  }
  return kept;
}

}  // namespace

std::vector<HistoryAlternative> WeighHistories(const LinearTape& tape,
                                               int receiver,
                                               const ErrorRegimes& regimes) {
  std::vector<HistoryAlternative> all;
  double sum = 0.0;
  for (const Kept& one : Keep(regimes)) {
    const ErrorHistory& history = one.scored->history;
    all.push_back(
        {one.weight, one.scored->parameters,
         StepsByNode(tape, receiver, history),
         SmoothHistory(tape, receiver, one.scored->parameters, history)});
    sum += one.weight;
  }
  for (HistoryAlternative& one : all) one.weight /= sum;
  return all;
}

const HistoryAlternative& MostCentral(
    const std::vector<HistoryAlternative>& all) {
  const HistoryAlternative* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const HistoryAlternative& one : all) {
    double sum = 0.0;
    for (const HistoryAlternative& other : all) {
      sum += other.weight * MeanSquareDistance(one.smoothed, other.smoothed);
    }
    if (sum >= least) continue;
    least = sum;
    best = &one;
  }
  return *best;
}

ErrorMatrix Spread(const std::vector<HistoryAlternative>& all,
                   const HistoryAlternative& center, std::size_t k, int dim) {
  ErrorMatrix sum = ErrorMatrix::Zero(dim, dim);
  for (const HistoryAlternative& one : all) {
    const ErrorVector d = (one.smoothed[k] - center.smoothed[k]).head(dim);
    sum.noalias() += (one.weight * d) * d.transpose();
  }
  return sum;
}

}  // namespace hindsight
