#include "receiver_errors/weighed_hypotheses.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "receiver_errors/regime_choice.h"

namespace hindsight {
namespace {
struct Kept {
  const Hypothesis* scored = nullptr;
  double weight = 0.0;  ///< not normalised
};

/// Hypotheses of the same modes in the same order.
struct OrderWeight {
  double weight = 0.0;  ///< of all of them
  std::size_t kept = 0;
  double kept_weight = 0.0;
};

/// Each kept one is smoothed over the whole tape: of long ones fewer are.
std::size_t MostOf(std::size_t nodes) {
  constexpr std::size_t kNodes = 200000;
  return std::clamp<std::size_t>(kNodes / std::max<std::size_t>(nodes, 1), 4,
                                 24);
}

std::vector<Kept> Keep(const ErrorRegimes& regimes, std::size_t most) {
  constexpr std::size_t kMostOfOne = 8;
  constexpr double kLeast = 1e-9;
  const double best = regimes.hypotheses.front().log_posterior;
  std::vector<Kept> all;
  std::map<std::vector<ErrorMode>, OrderWeight> orders;
  for (const Hypothesis& h : regimes.hypotheses) {
    const double weight = h.count * std::exp(h.log_posterior - best);
    if (weight < kLeast) continue;
    orders[ModeOrder(h.sequence)].weight += weight;
    all.push_back({&h, weight});
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return a.weight > b.weight;
  });
  std::vector<Kept> kept;
  for (const Kept& one : all) {
    if (kept.size() == most) break;
    OrderWeight& order = orders[ModeOrder(one.scored->sequence)];
    if (order.kept == kMostOfOne) continue;
    ++order.kept;
    order.kept_weight += one.weight;
    kept.push_back(one);
  }
  for (Kept& one : kept) {
    const OrderWeight& order = orders[ModeOrder(one.scored->sequence)];
    one.weight *= order.weight / order.kept_weight;
  }
  return kept;
}

}  // namespace

std::vector<WeighedHypothesis> WeighHypotheses(const SensorTape& tape,
                                               const ErrorRegimes& regimes) {
  std::vector<WeighedHypothesis> all;
  double sum = 0.0;
  for (const Kept& one : Keep(regimes, MostOf(tape.size()))) {
    const ModeSequence& sequence = one.scored->sequence;
    all.push_back({one.weight, one.scored->parameters,
                   StepsByNode(tape, sequence),
                   SmoothSequence(tape, one.scored->parameters, sequence)});
    sum += one.weight;
  }
  for (WeighedHypothesis& one : all) one.weight /= sum;
  return all;
}

std::size_t MostCentral(const std::vector<WeighedHypothesis>& all) {
  const double likely =
      std::exp(-kHardlyWorthMentioning) *
      std::ranges::max_element(all, {}, &WeighedHypothesis::weight)->weight;
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].weight < likely) continue;
    double sum = 0.0;
    for (const WeighedHypothesis& other : all) {
      sum += other.weight * MeanSquareDistance(all[i].smoothed, other.smoothed);
    }
    if (sum >= least) continue;
    least = sum;
    best = i;
  }
  return best;
}

ErrorVector MeanFrom(const std::vector<WeighedHypothesis>& all,
                     const WeighedHypothesis& center, std::size_t k) {
  ErrorVector sum = ErrorVector::Zero(center.smoothed[k].size());
  for (const WeighedHypothesis& one : all) {
    sum += one.weight * (one.smoothed[k] - center.smoothed[k]);
  }
  return sum;
}

ErrorMatrix Spread(const std::vector<WeighedHypothesis>& all,
                   const WeighedHypothesis& center, std::size_t k, int dim) {
  ErrorMatrix sum = ErrorMatrix::Zero(dim, dim);
  for (const WeighedHypothesis& one : all) {
    const ErrorVector d = (one.smoothed[k] - center.smoothed[k]).head(dim);
    sum.noalias() += (one.weight * d) * d.transpose();
  }
  return sum;
}

}  // namespace hindsight
