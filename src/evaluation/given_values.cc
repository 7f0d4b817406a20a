#include "evaluation/given_values.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "base/chi_square.h"
#include "evaluation/value_origin.h"

namespace hindsight {
namespace {

constexpr double kAtTheStart = 1e-6;  // [s]

/// How the program came by a start value of its own.
std::string OwnSource(const StartValues& start, BlockKind kind) {
  switch (kind) {
    case BlockKind::kPosition:
      return " (" + start.position + ")";
    case BlockKind::kAttitude:
      return " (alignment " + start.alignment + ")";
    default:
      return "";
  }
}

Evidence Strain(const Judged& judged, const ValueOrigin& origin,
                const Block& block, const std::string& component, double sigmas,
                double limit) {
  const bool constant = block.evolution.is_constant();
  Evidence e{.grade = Grade::kDoubtful,
             .what = component + (constant ? " is " : " at the start is "),
             .value = sigmas,
             .limit = limit,
             .unit = "sigma"};
  // What else does not fit may well come from a start that is not so.
  e.is_cause = origin.given && !constant;
  if (origin.given) {
    e.what += fmt::format(
        "{:.1f} sigma from {}", sigmas,
        origin.instead.empty() ? "its given value" : origin.instead);
    e.causes = {"a wrong value, sign, unit or clock of " + origin.key,
                "too small a sigma of it",
                "an error that is not modelled and ends up there"};
    e.remedies = {"another " + origin.key, "a larger " + origin.sigma_key};
  } else {
    e.what += fmt::format("{:.1f} sigma from the program's own start", sigmas) +
              OwnSource(*judged.start, block.key.kind);
    e.causes = {"too small a sigma of that start",
                "an error that is not modelled and ends up there"};
    e.remedies = {origin.key + " and " + origin.sigma_key +
                  " in the configuration"};
  }
  // Both are the same key where the value is zero by definition.
  if (origin.given && origin.key == origin.sigma_key) {
    e.remedies.erase(e.remedies.begin());
  }
  if (!constant) e.t_begin = e.t_end = judged.start->x.t;
  return e;
}

/// Of a gyro bias that was given with its sigma, which the start may have
/// combined with what the data say: how far the solution is from what was
/// given, in the given sigma. None of all else.
std::optional<double> StrainOfGiven(const Judged& judged, const Block& block,
                                    int axis, const State& x) {
  const InitialState& given = judged.start->given;
  if (block.key.kind != BlockKind::kGyroBias || !given.gyro_bias_sigma) {
    return std::nullopt;
  }
  return std::abs(x.b_g(axis) - given.gyro_bias(axis)) /
         (*given.gyro_bias_sigma)(axis);
}

/// A value that is held against what it started from.
struct Strained {
  const Block& block;
  ValueOrigin origin;
  std::string component;
  double sigmas = 0.0;
  double value = 0.0;  ///< away from the start
};

/// None of an observer, P of which weighs nothing against its start.
std::vector<Strained> AllStrained(const Judged& judged) {
  const Solution& solution = judged.solution;
  if (!judged.start || solution.observer ||
      solution.layout.dim() != judged.start->P.rows()) {
    return {};
  }
  const StartValues& start = *judged.start;
  const bool from_start =
      std::abs(solution.states.front().t - start.x.t) <= kAtTheStart;
  const std::size_t end = solution.states.size() - 1;
  const ErrorVector first =
      Local(solution.layout, start.x, solution.states.front());
  const ErrorVector last =
      Local(solution.layout, start.x, solution.states[end]);
  std::vector<Strained> all;
  for (const Block& block : solution.layout.blocks()) {
    const bool constant = block.evolution.is_constant();
    const bool start_value = IsNavigation(block.key.kind);
    if (!constant && !(start_value && from_start)) continue;
    int i = block.offset;
    for (int axis = 0; axis < FullDimension(block.key.kind); ++axis) {
      if (!block.active[static_cast<std::size_t>(axis)]) continue;
      const double off = constant ? last(i) : first(i);
      const std::string name = solution.layout.ComponentName(i);
      const ValueOrigin origin = OriginOf(judged, block, axis);
      all.push_back(
          {block, origin, name, std::abs(off) / std::sqrt(start.P(i, i)), off});
      const std::optional<double> of_given = StrainOfGiven(
          judged, block, axis, solution.states[constant ? end : 0]);
      if (of_given && !origin.given) {
        all.push_back(
            {block, OriginOfGivenGyroBias(start.given), name, *of_given, off});
      }
      ++i;
    }
  }
  return all;
}

/// Those that the method has beside its states.
std::vector<const ConstantEstimate*> ConstantsBeside(const Solution& solution) {
  std::set<std::string> states;
  for (int i = 0; i < solution.layout.dim(); ++i) {
    states.insert(solution.layout.ComponentName(i));
  }
  std::vector<const ConstantEstimate*> beside;
  for (const ConstantEstimate& one : solution.constants) {
    if (one.prior_sigma > 0.0 && !states.contains(one.name)) {
      beside.push_back(&one);
    }
  }
  return beside;
}

Evidence Strain(const ConstantEstimate& one, double sigmas, double limit) {
  const ValueOrigin origin = OriginOf(one);
  return {
      .grade = Grade::kDoubtful,
      .what = fmt::format("{} ends {:.2g} {} from its given value, {:.1f} "
                          "times what chance would",
                          one.name, std::abs(one.value - one.prior_value),
                          one.unit, sigmas),
      .value = sigmas,
      .limit = limit,
      .unit = "sigma",
      .causes = {origin.key, "an error that is not modelled and ends up there"},
      .remedies = {origin.key, "a larger " + origin.sigma_key}};
}

}  // namespace

double StrainLimit(int count) {
  return std::sqrt(
      ChiSquareQuantile(1.0 - kFalseAlarms / std::max(count, 1), 1.0));
}

double StrainOf(double off, double prior_variance, double variance) {
  constexpr double kLeast = 0.01;  // of the prior variance
  if (off * off <= prior_variance) return 0.0;
  return std::abs(off) / std::sqrt(std::max(prior_variance - variance,
                                            kLeast * prior_variance));
}

void FindStrainedValues(const Judged& judged, std::vector<Evidence>* evidence) {
  const std::vector<Strained> all = AllStrained(judged);
  const std::vector<const ConstantEstimate*> beside =
      ConstantsBeside(judged.solution);
  const auto given = std::ranges::count_if(
      all, [](const Strained& one) { return one.origin.given; });
  const double of_given =
      StrainLimit(static_cast<int>(given + std::ssize(beside)));
  const double of_own = StrainLimit(static_cast<int>(std::ssize(all) - given));
  for (const Strained& one : all) {
    const double limit = one.origin.given ? of_given : of_own;
    if (!(one.sigmas > limit)) continue;
    evidence->push_back(Strain(judged, one.origin, one.block, one.component,
                               one.sigmas, limit));
    // Measured = (1 + scale) true: below -1 it counts backwards.
    if (one.block.key.kind == BlockKind::kScale && one.value < -1.0) {
      evidence->back().causes = {"a speed of the wrong sign"};
      evidence->back().remedies = {
          "a leading \"-\" before its column under `columns`"};
    }
  }
  for (const ConstantEstimate* one : beside) {
    const double sigmas =
        StrainOf(one->value - one->prior_value,
                 one->prior_sigma * one->prior_sigma, one->sigma * one->sigma);
    if (sigmas > of_given) {
      evidence->push_back(Strain(*one, sigmas, of_given));
    }
  }
}

}  // namespace hindsight
