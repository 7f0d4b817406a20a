#include "evaluation/grade.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "evaluation/accuracy_rule.h"
#include "evaluation/agreement.h"
#include "evaluation/contradicted_sensor.h"
#include "evaluation/curved_errors.h"
#include "evaluation/distrust.h"
#include "evaluation/explanation.h"
#include "evaluation/given_values.h"
#include "evaluation/grade_rules.h"
#include "evaluation/innovation_rule.h"
#include "evaluation/observability.h"
#include "evaluation/vehicle_posture.h"
#include "evaluation/withheld_rule.h"

namespace hindsight {
namespace {

void PassOnRecording(const Judged& judged, std::vector<Evidence>* evidence) {
  evidence->insert(evidence->end(), judged.recording.begin(),
                   judged.recording.end());
}

void PassOnDoubts(const Judged& judged, std::vector<Evidence>* evidence) {
  evidence->insert(evidence->end(), judged.doubts.begin(), judged.doubts.end());
}

void PassOnDisagreement(const Judged& judged, std::vector<Evidence>* evidence) {
  if (judged.disagreement) evidence->push_back(*judged.disagreement);
}

constexpr const char* kSearchRule = "search";
constexpr const char* kLinearisationRule = "linearisation";
/// Methods that end with a linearisation about their own result, best first.
constexpr const char* kRelinearising[] = {"batch", "iterated", "robust_batch"};

constexpr GradeRule kRules[] = {
    {"failure", FindFailure},
    {"clock", FindUnsettledClock},
    {"recording", PassOnRecording},
    {"rival", FindLikelyRival},
    {kSearchRule, PassOnDoubts},
    {kLinearisationRule, FindLinearisedFarOff},
    {"curvature", FindCurvedErrors},
    {"disagreement", PassOnDisagreement},
    {"unobserved", FindUnobservedState},
    {"posture", FindOddPosture},
    {"shut_out", FindShutOut},
    {"distrust", FindDistrusted},
    {"given_values", FindStrainedValues},
    {"residuals", FindLargeResiduals},
    {"innovations", FindOddInnovations},
    {"explanation", FindBetterExplanation},
    {"agreement", FindDisagreeingSides},
    {"contradiction", FindContradictedSensor},
    {"withheld", FindOddPredictions},
    {"bounds", FindValuesAtBounds},
    {"accuracy", DescribeAccuracy},
};

/// "; 2 constants are kept at their priors", or nothing.
std::string ConstantsAtPriors(const std::vector<ConstantEstimate>& constants) {
  const auto count = std::count_if(
      constants.begin(), constants.end(), [](const ConstantEstimate& constant) {
        return constant.verdict == ConstantEstimate::Verdict::kUnobserved;
      });
  if (count == 0) return "";
  return count == 1 ? "; 1 constant is kept at its prior"
                    : "; " + std::to_string(count) +
                          " constants are kept at their priors";
}

/// What is true of a usable solution.
std::string Praise(const Solution& solution) {
  std::string text;
  for (const Evidence& evidence : solution.evidence) {
    text += (text.empty() ? ": " : ", ") + evidence.what;
  }
  if (!solution.unobserved.empty()) text += "; but not everywhere";
  return text + ConstantsAtPriors(solution.constants);
}

/// Whether `a` says more of why a solution has the grade than `b`: faults of
/// the recording, which explain the rest, come first; then what makes the
/// grade; of that the farthest beyond its limit, and of equal ones the first.
bool WeighsMore(const Evidence& a, const Evidence& b) {
  return std::tuple(a.is_cause, a.grade, a.Severity()) >
         std::tuple(b.is_cause, b.grade, b.Severity());
}

/// As many words of a clause as a line has room for.
std::string Shortened(const std::string& clause) {
  constexpr std::size_t kMost = 104;
  if (clause.size() <= kMost) return clause;
  return clause.substr(0, clause.rfind(' ', kMost - 3)) + "...";
}

/// What speaks most against a solution that is not usable as it stands.
std::string Objection(const Solution& solution) {
  const Evidence* worst = nullptr;
  int others = -1;
  for (const Evidence& evidence : solution.evidence) {
    if (evidence.grade == Grade::kUsable) continue;
    ++others;
    if (worst == nullptr || WeighsMore(evidence, *worst)) worst = &evidence;
  }
  std::string text = ": " + Shortened(worst->what);
  for (const Evidence& evidence : solution.evidence) {
    if (!evidence.is_always_told || &evidence == worst) continue;
    --others;
    text += "; " + Shortened(evidence.what);
  }
  if (others > 0) {
    text += fmt::format(", and {} more reason{} (see summary.json)", others,
                        others == 1 ? "" : "s");
  }
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
  std::vector<ConstantEstimate> constants = EstimateConstants(
      *solution, judged.constants, judged.start ? &judged.start->x : nullptr);
  // Of what its states do not have a method tells itself.
  for (ConstantEstimate& own : solution->constants) {
    const bool known = std::any_of(
        constants.begin(), constants.end(),
        [&own](const ConstantEstimate& c) { return c.name == own.name; });
    if (!known) constants.push_back(std::move(own));
  }
  solution->constants = std::move(constants);
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

void AdviseBetterMethods(std::vector<Solution>* solutions) {
  const auto find = [&](const std::string& name) {
    return std::find_if(solutions->begin(), solutions->end(),
                        [&](const Solution& s) { return s.method == name; });
  };
  for (Solution& solution : *solutions) {
    for (Evidence& evidence : solution.evidence) {
      std::vector<std::string>& methods = evidence.better_methods;
      std::erase_if(methods, [&](const std::string& name) {
        const auto other = find(name);
        return other != solutions->end() && other->grade >= solution.grade;
      });
      if (evidence.rule != kLinearisationRule) continue;
      for (const char* name : kRelinearising) {
        const auto other = find(name);
        if (other != solutions->end() && other->grade < solution.grade &&
            std::find(methods.begin(), methods.end(), name) == methods.end()) {
          methods.emplace_back(name);
        }
      }
    }
  }
}

void AddEvidence(Evidence evidence, Solution* solution) {
  solution->evidence.push_back(std::move(evidence));
  solution->grade = GradeOf(solution->evidence);
  solution->verdict = VerdictOf(*solution);
}

void ShareDisagreements(std::vector<Solution>* solutions) {
  std::vector<std::pair<std::string, Evidence>> told;
  for (const Solution& solution : *solutions) {
    for (const Evidence& evidence : solution.evidence) {
      if (evidence.against.empty()) continue;
      told.emplace_back(evidence.against, evidence);
      told.back().second.against = solution.method;
    }
  }
  for (const auto& disagreement : told) {
    const std::string& method = disagreement.first;
    const Evidence& evidence = disagreement.second;
    for (Solution& solution : *solutions) {
      const bool knows = std::any_of(
          solution.evidence.begin(), solution.evidence.end(),
          [&](const Evidence& own) { return own.against == evidence.against; });
      if (solution.method != method || knows) continue;
      AddEvidence(evidence, &solution);
    }
  }
}

void ShareFindings(std::vector<Solution>* solutions) {
  std::vector<Evidence> found;
  for (const Solution& solution : *solutions) {
    for (const Evidence& one : solution.evidence) {
      if (one.rule != kSearchRule || one.is_always_told) continue;
      found.push_back(one);
      found.back().what = solution.method + ": " + one.what;
    }
  }
  std::multimap<std::string, Evidence> compared;
  for (const Solution& solution : *solutions) {
    compared.insert(solution.compared.begin(), solution.compared.end());
  }
  for (Solution& solution : *solutions) {
    const bool is_asked = !solution.forward && solution.usable() &&
                          solution.layout.Has(BlockKind::kPosition);
    if (!is_asked) continue;
    for (const Evidence& one : found) AddEvidence(one, &solution);
    const auto [begin, end] = compared.equal_range(solution.method);
    for (auto one = begin; one != end; ++one) {
      AddEvidence(one->second, &solution);
    }
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
