#include "receiver_errors/regime_choice.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "receiver_errors/error_tuning.h"
#include "receiver_errors/held_out_score.h"
#include "receiver_errors/uniform_regimes.h"

namespace hindsight {
namespace {

using Kind = ErrorRegimes::Kind;

std::string AsStatedTimes(const ErrorParameters& p) {
  return fmt::format(
      "take the fixes for {:.2g}, the noise of the IMU for {:.2g} times as "
      "stated",
      p.scale, p.imu_scale);
}

/// Whether fixes scatter by less than half of what is stated, beside an IMU of less than
/// half its noise: a stated sigma has slow errors in it, and whose they are nothing tells.
bool IsHeldByStated(const ErrorParameters& p) {
  constexpr double kHalf = 1.0 / kMisstatedImu;
  return p.scale < kHalf && p.imu_scale < kHalf;
}

/// The clause for a loss on held-out stretches; "" if there is none.
std::string LossTo(const RegimeProblem& problem, const ErrorRegimes& one,
                   const ErrorRegimes& simpler) {
  for (const HeldOutDifference& d : CompareHeldOut(
           problem.tape, one.hypotheses.front(), simpler.hypotheses.front())) {
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
  const std::string bound = AtBound(best, problem.is_tolerance);
  if (!bound.empty()) return "have " + bound + " at its bound";
  if (one.kind == Kind::kWhite && !CanBeSolved(best.parameters)) {
    return AsStatedTimes(best.parameters);
  }
  if (one.kind == Kind::kGaussMarkov && IsHeldByStated(best.parameters)) {
    return AsStatedTimes(best.parameters);
  }
  for (const ErrorRegimes& simpler : all) {
    if (simpler.kind >= one.kind || simpler.kind > Kind::kWhite) continue;
    const double gain = one.log_evidence - simpler.log_evidence;
    const double least = one.kind == Kind::kSwitching && !problem.has_clock
                             ? kLeastGainOfSwitching
                             : kLeastGain;
    if (gain < least) {
      return fmt::format(
          "win by {:.2g} over {} errors (limit {:.2g}) [ln of the evidence]",
          gain, RegimeName(simpler.kind), least);
    }
    std::string loss = LossTo(problem, one, simpler);
    if (!loss.empty()) return loss;
  }
  return "";
}

/// RegimeChoice::noise.
std::size_t LikeliestNoise(const std::vector<ErrorRegimes>& all) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    const bool is_noise = all[i].kind <= Kind::kWhite;
    if (is_noise && all[i].log_evidence > all[best].log_evidence) best = i;
  }
  return best;
}

/// White noise of which a Gauss-Markov error has all parameters, and so the prior of each:
/// the noise as stated has none, and wins over either by what they cost. `likeliest` where
/// it was not fitted.
const ErrorRegimes& NestedNoise(const std::vector<ErrorRegimes>& all,
                                std::size_t likeliest) {
  const auto white = std::ranges::find(all, Kind::kWhite, &ErrorRegimes::kind);
  return white != all.end() ? *white : all[likeliest];
}

/// The likeliest of a kind that noise does not rule out, nor it the likeliest noise, of
/// which the evidence is `best`; index 0 if there is none.
RegimeChoice::Undecided NotRuledOut(Kind kind, const ErrorRegimes& noise,
                                    const std::vector<ErrorRegimes>& all,
                                    double best) {
  RegimeChoice::Undecided likeliest = {0, -kLeastGain};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double gain = all[i].log_evidence - noise.log_evidence;
    const bool wins = all[i].log_evidence - best > kLeastGain;
    if (all[i].kind == kind && gain > likeliest.gain && !wins) {
      likeliest = {i, gain};
    }
  }
  return likeliest;
}

/// RegimeChoice::open.
std::optional<OpenBias> FindOpen(const std::vector<ErrorRegimes>& all,
                                 std::size_t likeliest_noise) {
  const double beside = NestedNoise(all, likeliest_noise).log_evidence;
  for (const ErrorRegimes& one : all) {
    if (one.slight) return LeftOpen(*one.slight, one.log_evidence - beside);
  }
  return std::nullopt;
}

/// RegimeChoice::undecided.
std::vector<RegimeChoice::Undecided> FindUndecided(
    const RegimeProblem& problem, const std::vector<ErrorRegimes>& all,
    const RegimeChoice& choice) {
  std::vector<RegimeChoice::Undecided> undecided;
  for (const Kind kind : {Kind::kGaussMarkov, Kind::kSwitching}) {
    const bool is_nested = kind == Kind::kGaussMarkov;
    const ErrorRegimes& noise =
        is_nested ? NestedNoise(all, choice.noise) : all[choice.noise];
    const RegimeChoice::Undecided one =
        NotRuledOut(kind, noise, all, all[choice.noise].log_evidence);
    const ErrorRegimes& held = is_nested ? noise : all[choice.chosen];
    if (one.index > 0 && LossTo(problem, all[one.index], held).empty()) {
      undecided.push_back(one);
    }
  }
  std::ranges::stable_sort(undecided, std::greater<>(),
                           &RegimeChoice::Undecided::gain);
  return undecided;
}

/// Adds hypotheses, `shift` making their posteriors comparable, or lets them
/// take the place of the same ones where they are likelier.
void AddAlternatives(std::vector<Hypothesis> more, double shift,
                     std::vector<Hypothesis>* all) {
  for (Hypothesis& h : more) {
    h.log_posterior += shift;
    const auto known =
        std::find_if(all->begin(), all->end(),
                     [&](const auto& b) { return b.sequence == h.sequence; });
    if (known == all->end()) {
      all->push_back(std::move(h));
    } else if (known->log_posterior < h.log_posterior) {
      *known = std::move(h);
    }
  }
}

}  // namespace

std::string AtBound(const Hypothesis& best, bool any_least_scale) {
  constexpr double kTouching = 1e-6;  // of the bound
  for (const BoundedValue& v :
       BoundedParameters(best.sequence, best.parameters, any_least_scale)) {
    if (v.value <= v.least * (1.0 + kTouching) ||
        v.value >= v.most * (1.0 - kTouching)) {
      return v.name;
    }
  }
  return "";
}

std::optional<OpenBias> LeftOpen(const SlightBias& slight, double log_gain) {
  const OpenBias open = {slight.expected,
                         log_gain + slight.log_gain + kLogOddsOfSlowErrors};
  if (open.log_odds <= -kLeastGain) return std::nullopt;
  return open;
}

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
  choice.noise = LikeliestNoise(all);
  if (all[choice.chosen].kind > Kind::kWhite) return choice;
  choice.undecided = FindUndecided(problem, all, choice);
  choice.open = FindOpen(all, choice.noise);
  return choice;
}

ErrorRegimes WithAlternatives(std::vector<ErrorRegimes> all,
                              std::size_t chosen) {
  ErrorRegimes best = std::move(all[chosen]);
  if (best.kind != ErrorRegimes::Kind::kSwitching) return best;
  const double level =
      best.hypotheses.front().log_posterior - best.log_evidence;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i == chosen || (all[i].kind != ErrorRegimes::Kind::kSwitching &&
                        all[i].kind != ErrorRegimes::Kind::kWhite)) {
      continue;
    }
    const double own =
        all[i].hypotheses.front().log_posterior - all[i].log_evidence;
    AddAlternatives(std::move(all[i].hypotheses), level - own,
                    &best.hypotheses);
  }
  std::stable_sort(best.hypotheses.begin(), best.hypotheses.end(),
                   [](const auto& a, const auto& b) {
                     return a.log_posterior > b.log_posterior;
                   });
  return best;
}

}  // namespace hindsight
