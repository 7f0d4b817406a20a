#include "problems/rival_data.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "evaluation/explanation.h"
#include "evaluation/grade.h"
#include "problems/linearisation.h"

namespace hindsight {
namespace {

/// The largest root mean square, over the nodes of both, of a component's
/// difference in standard deviations of `chosen`; infinite where no node is of
/// both, as then nothing says that they are the same.
double DistanceBetween(const ErrorLayout& layout, const Relinearised& chosen,
                       const std::vector<State>& rival) {
  constexpr double kSameTime = 1e-6;
  NavigationVariances sum = NavigationVariances::Zero();
  int count = 0;
  std::size_t j = 0;
  for (std::size_t k = 0; k < chosen.states.size(); ++k) {
    const State& x = chosen.states[k];
    while (j < rival.size() && rival[j].t < x.t - kSameTime) ++j;
    if (j == rival.size() || rival[j].t > x.t + kSameTime) continue;
    const ErrorVector d = Local(layout, x, rival[j]);
    sum += d.head<9>().cwiseAbs2().cwiseQuotient(chosen.variances[k]);
    ++count;
  }
  return count > 0 ? std::sqrt(sum.maxCoeff() / count)
                   : std::numeric_limits<double>::infinity();
}

}  // namespace

RivalComparison::RivalComparison(ForwardStage* chosen)
    : own_(chosen->relinearised()),
      layout_(chosen->start().layout),
      chosen_(chosen->dataset(), {chosen->problem(), own_.states}) {}

bool RivalComparison::IsNear(const std::vector<State>& rival) const {
  return DistanceBetween(layout_, own_, rival) < kDoubtfulShift;
}

std::optional<RivalSolution> RivalComparison::Solve(double log_odds,
                                                    RivalReadings readings,
                                                    RivalSolution words,
                                                    ForwardStage* rival) {
  constexpr double kMostEvidence = 30.0;
  constexpr double kHopeless = 200.0;
  if (own_.states.empty()) return std::nullopt;
  const auto log_evidence = [&](const std::vector<State>& states) {
    const Explained of_rival = {rival->problem(), states};
    return log_odds + (readings == RivalReadings::kTheSame
                           ? chosen_.LogLikelihoodRatio(of_rival)
                           : chosen_.LogEvidenceRatio(of_rival));
  };
  const std::vector<State> first = rival->SmoothedStates();
  // Linearising anew costs more than the stage and seldom moves so far.
  if (IsNear(first) || log_evidence(first) < -kHopeless) return std::nullopt;
  const std::vector<State> other = rival->RestedStates(first);
  if (other.empty() || IsNear(other)) return std::nullopt;
  words.log_evidence = std::min(kMostEvidence, log_evidence(other));
  words.final_state = other.back();
  return words;
}

std::vector<RivalSolution> RareRivals(
    std::size_t count,
    const std::function<std::optional<RivalSolution>(std::size_t i,
                                                     double log_odds)>& solve) {
  const double log_odds =
      std::log(kDoubtfulRival * kFalseAlarms / static_cast<double>(count));
  std::vector<std::optional<RivalSolution>> solved(count);
  ForRanges(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      try {
        solved[i] = solve(i, log_odds);
      } catch (const EstimationError&) {
        continue;
      }
    }
  });
  std::vector<RivalSolution> rivals;
  for (std::optional<RivalSolution>& rival : solved) {
    if (rival && rival->log_evidence >= std::log(kDoubtfulRival)) {
      rivals.push_back(*std::move(rival));
    }
  }
  return rivals;
}

}  // namespace hindsight
