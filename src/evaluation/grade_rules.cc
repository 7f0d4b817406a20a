#include "evaluation/grade_rules.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "evaluation/contradicted_sensor.h"
#include "evaluation/observability.h"
#include "evaluation/refusals.h"

namespace hindsight {

void FindFailure(const Judged& judged, std::vector<Evidence>* evidence) {
  const Solution& solution = judged.solution;
  const auto fail = [evidence](const std::string& what) -> Evidence& {
    return evidence->emplace_back(
        Evidence{.grade = Grade::kUnusable, .what = what});
  };
  if (!solution.converged) {
    Evidence& failure = fail("the iteration did not converge");
    failure.value = solution.iterations;
    if (!judged.hindrance.empty()) {
      failure.what += ": " + judged.hindrance;
      failure.causes = {judged.hindrance};
      failure.remedies = {
          "a run that ends before it (--to), and one that "
          "begins after it (--from)"};
    }
    return;
  }
  if (solution.states.empty()) {
    fail("no epoch was estimated");
    return;
  }
  for (std::size_t k = 0; k < solution.states.size(); ++k) {
    if (solution.states[k].p_e.allFinite() &&
        (solution.covariances.empty() || solution.covariances.IsFinite(k))) {
      continue;
    }
    const double t = solution.states[k].t;
    fail(
        fmt::format("states or covariances from {:.1f} s on are not finite", t))
        .t_begin = t;
    return;
  }
}

void FindUnsettledClock(const Judged& judged, std::vector<Evidence>* evidence) {
  if (judged.unsettled.empty()) return;
  evidence->push_back(
      {.grade = Grade::kUnusable,
       .what = "the time offset of " + judged.unsettled + " does not settle",
       .causes = {"a sigma of the offset that is too small",
                  "too little motion to tell the clocks apart"},
       .remedies = {"a larger estimate.time_offset, or a value nearer to the "
                    "true one"},
       .is_cause = true});
}

void FindLinearisedFarOff(const Judged& judged,
                          std::vector<Evidence>* evidence) {
  constexpr double kOnceInAThousand = 3.29;  // of a normal variable
  constexpr double kOnceInTwenty = 1.96;
  if (!judged.linearisation) return;
  const LinearisationError& e = *judged.linearisation;
  const double wrong = e.causal ? kOnceInAThousand : kUnusableError;
  const double odd = e.causal ? kOnceInTwenty : kDoubtfulError;
  const bool throughout = e.rms >= wrong;
  if (!throughout && !((e.causal ? e.rms : e.largest) >= odd)) return;
  const double value = throughout || e.causal ? e.rms : e.largest;
  const double limit = throughout ? wrong : odd;
  Evidence found{.grade = throughout ? Grade::kUnusable : Grade::kDoubtful,
                 .value = value,
                 .limit = limit,
                 .unit = "sigma",
                 .causes = {"a start so uncertain that the filter was "
                            "linearised far from the truth"},
                 .remedies = {"a better known start"}};
  if (!std::isfinite(value)) {
    found.what = "no linearisation about its own result holds";
  } else if (throughout || e.causal) {
    found.what = fmt::format(
        "linearised anew, the interval shows errors of {:.2g} sigma in {} "
        "throughout (limit {:.2g})",
        value, e.rms_component, limit);
  } else {
    found.what = fmt::format(
        "linearised anew, the interval shows an error of {:.2g} sigma in {} at "
        "{:.1f} s (limit {:.2g})",
        value, e.component, e.t, limit);
    found.t_begin = found.t_end = e.t;
  }
  if (e.settled) found.better_methods = {"iterated", "batch"};
  evidence->push_back(std::move(found));
}

void FindLikelyRival(const Judged& judged, std::vector<Evidence>* evidence) {
  constexpr double kOutsideOneSigma = 0.3173;
  const std::vector<RivalSolution>& rivals = judged.solution.rivals;
  const double all = std::accumulate(rivals.begin(), rivals.end(), 0.0,
                                     [](double sum, const RivalSolution& one) {
                                       return sum + one.probability;
                                     });
  if (all < kDoubtfulRival) return;
  const RivalSolution& likeliest =
      *std::max_element(rivals.begin(), rivals.end(),
                        [](const RivalSolution& a, const RivalSolution& b) {
                          return a.probability < b.probability;
                        });
  const bool coin = all >= kOutsideOneSigma;
  Evidence found{
      .grade = coin ? Grade::kUnusable : Grade::kDoubtful,
      .what = fmt::format("another solution is {:.3g} % likely: {}",
                          100.0 * likeliest.probability, likeliest.description),
      .value = 100.0 * all,
      .limit = 100.0 * (coin ? kOutsideOneSigma : kDoubtfulRival),
      .unit = "%",
      .causes = {"motion that looks the same both ways"},
      .remedies = {"a given value of what differs, or a recording with more "
                   "varied motion"}};
  if (!likeliest.remedy.empty()) {
    found.causes.clear();
    found.remedies = {likeliest.remedy};
  }
  if (rivals.size() > 1) {
    found.what += fmt::format("; with all others {:.3g} %", 100.0 * all);
  }
  evidence->push_back(std::move(found));
}

namespace {

Evidence HeightThatNothingTells(const UnobservedSpan& span) {
  return {.grade = Grade::kDoubtful,
          .what = fmt::format("nothing measures the height, which is known to "
                              "{:.2g} m alone",
                              span.sigma),
          .causes = {"fixes without a height"},
          .remedies = {"a sensor of heights, or initial.position with the "
                       "height and its sigma"}};
}

Evidence StateThatNothingTells(const UnobservedSpan& span) {
  return {.grade = Grade::kUnusable,
          .what = fmt::format("{} is not observed from {:.1f} s to {:.1f} s",
                              span.component, span.t_begin, span.t_end),
          .causes = {"nothing that measures it"},
          .remedies = {"a sensor of it, or a given start value"}};
}

}  // namespace

void FindUnobservedState(const Judged& judged,
                         std::vector<Evidence>* evidence) {
  const Solution& solution = judged.solution;
  for (const UnobservedSpan& span : solution.unobserved) {
    if (!IsMostOfTheTime(span, solution)) continue;
    Evidence found = span.component == kHeightComponent
                         ? HeightThatNothingTells(span)
                         : StateThatNothingTells(span);
    found.value = span.sigma;
    found.limit = span.limit;
    found.unit = "SI";
    found.t_begin = span.t_begin;
    found.t_end = span.t_end;
    evidence->push_back(std::move(found));
  }
}

void FindShutOut(const Judged& judged, std::vector<Evidence>* evidence) {
  if (judged.sensors.empty()) return;
  if (auto refusal = FindRefusal(judged.sensors, judged.solution)) {
    // What a solution without the sensor does not fit follows from it.
    refusal->is_cause = true;
    evidence->push_back(std::move(*refusal));
  }
}

void FindLargeResiduals(const Judged& judged, std::vector<Evidence>* evidence) {
  constexpr double kWorst = 5.0;
  if (judged.sensors.empty()) return;
  std::vector<double> sum(judged.sensors.size(), 0.0);
  std::vector<double> rows(judged.sensors.size(), 0.0);
  for (const ResidualRecord& record : judged.solution.residuals) {
    if (!record.accepted || record.withheld) continue;
    const auto i = static_cast<std::size_t>(record.sensor);
    sum[i] += record.weight * record.nis;
    rows[i] += record.weight * static_cast<double>(record.residual.size());
  }
  for (std::size_t i = 0; i < judged.sensors.size(); ++i) {
    const double rms = rows[i] > 0.0 ? std::sqrt(sum[i] / rows[i]) : 0.0;
    if (rms <= kWorst) continue;
    const std::string& name = judged.sensors[i].name;
    evidence->push_back(
        {.grade =
             IsOutvoted(judged, name) ? Grade::kDoubtful : Grade::kUnusable,
         .what = fmt::format(
             "residuals of {} are {:.1f} times what their sigma says "
             "(limit {:.0f})",
             name, rms, kWorst),
         .value = rms,
         .limit = kWorst,
         .unit = "sigma",
         .causes = {"a sign, unit, clock or lever arm of " + name +
                        " or of what contradicts it",
                    "noise that is stated too small"},
         .remedies = {"'check --noise', which finds by what factor"}});
  }
}

void FindValuesAtBounds(const Judged& judged, std::vector<Evidence>* evidence) {
  constexpr double kTouching = 1e-6;  // of the value
  for (const BoundedValue& v : judged.solution.bounded) {
    for (const double bound : {v.least, v.most}) {
      if (!(std::abs(v.value - bound) <= kTouching * std::abs(bound)) ||
          !std::isfinite(bound)) {
        continue;
      }
      evidence->push_back(
          {.grade = Grade::kDoubtful,
           .what = fmt::format("{} ends at the bound of its search, {:.4g} {}",
                               v.name, bound, v.unit),
           .value = v.value,
           .limit = bound,
           .unit = v.unit,
           .causes = {"errors of another kind than those that are modelled"},
           .remedies = {"a sigma that suits the data"}});
    }
  }
}

}  // namespace hindsight
