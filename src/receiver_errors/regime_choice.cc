#include "receiver_errors/regime_choice.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "receiver_errors/error_tuning.h"
#include "receiver_errors/held_out_score.h"

namespace hindsight {
namespace {

using Kind = ErrorRegimes::Kind;

/// Name of a parameter at a bound; "" if there is none.
std::string AtBound(const Hypothesis& best) {
  constexpr double kTouching = 1e-6;  // of the bound
  for (const BoundedValue& v :
       BoundedParameters(best.sequence, best.parameters)) {
    if (v.value <= v.least * (1.0 + kTouching) ||
        v.value >= v.most * (1.0 - kTouching)) {
      return v.name;
    }
  }
  return "";
}

/// The clause for a loss on held-out stretches; "" if there is none.
std::string LossTo(const RegimeProblem& problem, const ErrorRegimes& one,
                   const ErrorRegimes& simpler) {
  for (const HeldOutDifference& d :
       CompareHeldOut(problem.tape, problem.sensor, one.hypotheses.front(),
                      simpler.hypotheses.front())) {
    if (!d.Loses()) continue;
    const MeanOfStretches& by =
        d.LosesDensity() ? d.log_density : d.log_distance;
    return fmt::format(
        "predict {} held-out stretches of {:.0f} s worse than {} errors, by "
        "{:.2g} +- {:.2g} a fix in ln of {}",
        d.stretches, d.length, RegimeName(simpler.kind), std::abs(by.mean),
        by.sigma, d.LosesDensity() ? "the density" : "the distance");
  }
  return "";
}

/// Why one of several does not stand; "" if it does.
std::string Objection(const RegimeProblem& problem,
                      const std::vector<ErrorRegimes>& all,
                      const ErrorRegimes& one) {
  const Hypothesis& best = one.hypotheses.front();
  const std::string bound = AtBound(best);
  if (!bound.empty()) return "have " + bound + " at its bound";
  if (one.kind == Kind::kWhite && !CanBeSolved(best.parameters)) {
    return fmt::format(
        "take the fixes for {:.2g}, the noise of the IMU for {:.2g} times as "
        "stated",
        best.parameters.scale, best.parameters.imu_scale);
  }
  for (const ErrorRegimes& simpler : all) {
    if (simpler.kind >= one.kind || simpler.kind > Kind::kWhite) continue;
    const double gain = one.log_evidence - simpler.log_evidence;
    if (gain < kLeastGain) {
      return fmt::format(
          "win by {:.2g} over {} errors (limit {:.2g}) [ln of the evidence]",
          gain, RegimeName(simpler.kind), kLeastGain);
    }
    std::string loss = LossTo(problem, one, simpler);
    if (!loss.empty()) return loss;
  }
  return "";
}

}  // namespace

RegimeChoice ChooseRegime(const RegimeProblem& problem,
                          const std::vector<ErrorRegimes>& all) {
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) {
                     return all[a].log_evidence > all[b].log_evidence;
                   });
  RegimeChoice choice;
  for (const std::size_t i : order) {
    if (all[i].kind == Kind::kStated) break;
    const std::string objection = Objection(problem, all, all[i]);
    if (objection.empty()) {
      choice.chosen = i;
      choice.gain = all[i].log_evidence - all.front().log_evidence;
      break;
    }
    if (all[i].log_evidence - all.front().log_evidence < kLeastGain) break;
    choice.refused.push_back(fmt::format("{} errors do not stand: they {}",
                                         RegimeName(all[i].kind), objection));
  }
  return choice;
}

}  // namespace hindsight
