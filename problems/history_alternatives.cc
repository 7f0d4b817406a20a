#include "problems/history_alternatives.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "filters/history_smoother.h"

namespace hindsight {
namespace {

/// Histories of the same modes in the same order.
struct Story {
  double weight = 0.0;  ///< of all of them
  std::size_t kept = 0;
  double kept_weight = 0.0;
};

double HorizontalSquares(const HistoryAlternative& a,
                         const HistoryAlternative& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.smoothed.size(); ++k) {
    sum += (a.smoothed[k] - b.smoothed[k]).head<2>().squaredNorm();
  }
  return sum;
}

}  // namespace

std::vector<HistoryAlternative> WeighHistories(const LinearTape& tape,
                                               int receiver,
                                               const ErrorRegimes& regimes) {
  constexpr std::size_t kMost = 24;
  constexpr std::size_t kMostOfOne = 8;
  constexpr double kLeast = 1e-9;
  const double best = regimes.histories.front().log_posterior;
  const auto weight = [&](const ScoredHistory& h) {
    return h.count * std::exp(h.log_posterior - best);
  };
  std::map<std::vector<ErrorMode>, Story> stories;
  std::vector<const ScoredHistory*> sorted;
  for (const ScoredHistory& h : regimes.histories) {
    if (weight(h) < kLeast) continue;
    stories[StoryOf(h.history)].weight += weight(h);
    sorted.push_back(&h);
  }
  std::stable_sort(
      sorted.begin(), sorted.end(),
      [&](const auto* a, const auto* b) { return weight(*a) > weight(*b); });
  std::vector<std::pair<const ScoredHistory*, Story*>> kept;
  for (const ScoredHistory* h : sorted) {
    if (kept.size() == kMost) break;
    Story& story = stories[StoryOf(h->history)];
    if (story.kept == kMostOfOne) continue;
    ++story.kept;
    story.kept_weight += weight(*h);
    kept.emplace_back(h, &story);
  }
  std::vector<HistoryAlternative> all;
  double sum = 0.0;
  for (const auto& [h, story] : kept) {
    all.push_back(
        {weight(*h) * story->weight / story->kept_weight,
         StepsByNode(tape, receiver, h->history),
         SmoothHistory(tape, receiver, regimes.parameters, h->history)});
    sum += all.back().weight;
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
      sum += other.weight * HorizontalSquares(one, other);
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
