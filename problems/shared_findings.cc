#include "problems/shared_findings.h"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "evaluation/grade.h"
#include "problems/method.h"

namespace hindsight {
namespace {

constexpr const char* kSearchRule = "search";

bool IsPositionSolved(const Solution& solution) {
  const Block* position = solution.layout.Find(BlockKind::kPosition);
  return position != nullptr && position->dim == 3 &&
         !solution.covariances.empty();
}

bool AreAtTheSameTimes(const Solution& a, const Solution& b) {
  constexpr double kSameTime = 1e-9;
  return std::ranges::equal(a.states, b.states,
                            [](const State& one, const State& other) {
                              return std::abs(one.t - other.t) <= kSameTime;
                            });
}

Eigen::Matrix3d PositionCovariance(const Solution& solution, std::size_t k) {
  const int at = solution.layout.Find(BlockKind::kPosition)->offset;
  return solution.covariances.Get(k).block<3, 3>(at, at);
}

/// Of `taken`, an axis, as `found` has the truth; none if they do not compare.
std::optional<double> ExpectedNees(const Solution& taken,
                                   const Solution& found) {
  if (!IsPositionSolved(taken) || !IsPositionSolved(found) ||
      !AreAtTheSameTimes(taken, found)) {
    return std::nullopt;
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < taken.states.size(); ++k) {
    const State& x = taken.states[k];
    const Eigen::Vector3d d =
        x.C_en().transpose() * (found.states[k].p_e - x.p_e);
    const Eigen::Matrix3d expected =
        d * d.transpose() + PositionCovariance(found, k);
    sum += PositionCovariance(taken, k).llt().solve(expected).trace();
  }
  return sum / (3.0 * static_cast<double>(taken.states.size()));
}

Evidence TooSure(const std::string& by, double nees) {
  constexpr double kLimit = kUnusableBias * kUnusableBias;
  return {.rule = "disagreement",
          .grade = Grade::kDoubtful,
          .what = fmt::format(
              "{} finds errors of sensors by which positions are {:.2g} sigma "
              "off (limit {:.0f})",
              by, std::sqrt(nees), kUnusableBias),
          .value = nees,
          .limit = kLimit,
          .unit = "1",
          .causes = {"errors that last, which this method takes for noise"},
          .remedies = {},
          .better_methods = {by}};
}

}  // namespace

void ShareFindings(std::vector<Solution>* solutions) {
  for (const Solution& found : *solutions) {
    if (found.states.empty() ||
        !MethodOf(found.method).Has(MethodTrait::kSearches)) {
      continue;
    }
    for (Solution& taken : *solutions) {
      const bool is_asked = &taken != &found && !taken.forward &&
                            taken.layout.Has(BlockKind::kPosition);
      if (!is_asked) continue;
      for (const Evidence& one : found.evidence) {
        if (!taken.usable()) break;
        if (one.rule != kSearchRule || one.is_always_told) continue;
        Evidence shared = one;
        shared.what = found.method + ": " + one.what;
        AddEvidence(std::move(shared), &taken);
      }
      if (!taken.usable()) continue;
      const std::optional<double> nees = ExpectedNees(taken, found);
      if (nees && *nees > kUnusableBias * kUnusableBias) {
        AddEvidence(TooSure(found.method, *nees), &taken);
      }
    }
  }
}

}  // namespace hindsight
