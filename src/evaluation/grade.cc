#include "evaluation/grade.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "evaluation/given_values.h"
#include "evaluation/grade_rules.h"
#include "evaluation/observability.h"

namespace hindsight {
namespace {

void PassOnRecording(const Judged& judged, std::vector<Evidence>* evidence) {
  evidence->insert(evidence->end(), judged.recording.begin(),
                   judged.recording.end());
}

constexpr GradeRule kRules[] = {
    {"failure", FindFailure},
    {"clock", FindUnsettledClock},
    {"recording", PassOnRecording},
    {"rival", FindLikelyRival},
    {"linearisation", FindLinearisedFarOff},
    {"unobserved", FindUnobservedState},
    {"shut_out", FindShutOut},
    {"residuals", FindLargeResiduals},
    {"given_values", FindStrainedValues},
    {"bounds", FindValuesAtBounds},
    {"accuracy", DescribeAccuracy},
};

/// "; 2 constants are kept at their priors: a, b", or nothing.
std::string ConstantsAtPriors(const std::vector<ConstantEstimate>& constants) {
  constexpr int kMostNames = 6;
  std::string names;
  int count = 0;
  for (const ConstantEstimate& constant : constants) {
    if (constant.verdict != ConstantEstimate::Verdict::kUnobserved) continue;
    if (++count > kMostNames) continue;
    names += (count == 1 ? "" : ", ") + constant.name;
  }
  if (count == 0) return "";
  const std::string more =
      count > kMostNames
          ? " and " + std::to_string(count - kMostNames) + " more"
          : "";
  return (count == 1 ? "; 1 constant is kept at its prior: "
                     : "; " + std::to_string(count) +
                           " constants are kept at their priors: ") +
         names + more;
}

/// What is true of a usable solution.
std::string Praise(const Solution& solution) {
  std::string text;
  for (const Evidence& evidence : solution.evidence) {
    text += (text.empty() ? ": " : ", ") + evidence.what;
  }
  if (!solution.unobserved.empty()) {
    text += "; but not everywhere: see the unobserved spans";
  }
  return text + ConstantsAtPriors(solution.constants);
}

/// What speaks most against a solution that is not usable as it stands.
std::string Objection(const Solution& solution) {
  const Evidence* first = nullptr;
  int others = 0;
  for (const Evidence& evidence : solution.evidence) {
    if (evidence.grade == Grade::kUsable) continue;
    ++others;
    if (first == nullptr && evidence.grade == solution.grade) first = &evidence;
  }
  std::string text = ": " + first->what;
  if (!first->better_methods.empty()) {
    text += ": take " + AsAlternatives(first->better_methods);
  } else if (!first->remedies.empty()) {
    text += ": try " + first->remedies.front();
  }
  if (--others > 0) text += "; and " + std::to_string(others) + " more reasons";
  return text;
}

std::string VerdictOf(const Solution& solution) {
  return GradeName(solution.grade) + (solution.grade == Grade::kUsable
                                          ? Praise(solution)
                                          : Objection(solution));
}

long CountAgainst(const Solution& solution) {
  return std::count_if(
      solution.evidence.begin(), solution.evidence.end(),
      [](const Evidence& e) { return e.grade != Grade::kUsable; });
}

}  // namespace

std::span<const GradeRule> GradeRules() { return kRules; }

void Conclude(const Judged& judged, const std::vector<UnobservedSpan>& known,
              Solution* solution) {
  solution->constants = EstimateConstants(*solution);
  solution->unobserved = FindUnobserved(*solution);
  if (judged.relative_heading) {
    std::erase_if(solution->unobserved, [](const UnobservedSpan& span) {
      return span.component == "attitude[down]";
    });
  }
  for (const UnobservedSpan& span : known) {
    const bool named =
        std::any_of(solution->unobserved.begin(), solution->unobserved.end(),
                    [&span](const UnobservedSpan& own) {
                      return own.component == span.component;
                    });
    if (!named) solution->unobserved.push_back(span);
  }
  solution->evidence.clear();
  for (const GradeRule& rule : kRules) {
    const std::size_t before = solution->evidence.size();
    rule.find(judged, &solution->evidence);
    for (std::size_t i = before; i < solution->evidence.size(); ++i) {
      std::string& name = solution->evidence[i].rule;
      if (name.empty()) name = rule.name;
    }
    // Of what is no solution nothing else is to be said.
    if (GradeOf(solution->evidence) == Grade::kUnusable &&
        rule.find == FindFailure) {
      break;
    }
  }
  solution->grade = GradeOf(solution->evidence);
  solution->verdict = VerdictOf(*solution);
}

Solution FailedSolution(const std::string& method, const std::string& reason) {
  Solution failed;
  failed.method = method;
  failed.converged = false;
  failed.evidence = {
      {.rule = "failure", .grade = Grade::kUnusable, .what = reason}};
  failed.grade = Grade::kUnusable;
  failed.verdict = VerdictOf(failed);
  return failed;
}

void KeepBetterMethods(std::vector<Solution>* solutions) {
  for (Solution& solution : *solutions) {
    bool changed = false;
    for (Evidence& evidence : solution.evidence) {
      changed |=
          std::erase_if(evidence.better_methods, [&](const std::string& name) {
            return std::any_of(solutions->begin(), solutions->end(),
                               [&](const Solution& other) {
                                 return other.method == name &&
                                        other.grade >= solution.grade;
                               });
          }) > 0;
    }
    if (changed) solution.verdict = VerdictOf(solution);
  }
}

int BestOf(const std::vector<Solution>& solutions,
           std::span<const char* const> preference) {
  const auto rank = [&](const Solution& solution) {
    const auto place =
        std::find(preference.begin(), preference.end(), solution.method) -
        preference.begin();
    return std::tuple(solution.grade, CountAgainst(solution), place);
  };
  int best = -1;
  for (std::size_t i = 0; i < solutions.size(); ++i) {
    if (best < 0 ||
        rank(solutions[i]) < rank(solutions[static_cast<std::size_t>(best)])) {
      best = static_cast<int>(i);
    }
  }
  return best;
}

}  // namespace hindsight
