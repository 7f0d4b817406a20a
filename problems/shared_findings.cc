#include "problems/shared_findings.h"

#include <utility>

#include "evaluation/grade.h"
#include "problems/method.h"

namespace hindsight {
namespace {

constexpr const char* kSearchRule = "search";

/// What of it holds for another.
std::vector<Evidence> HoldsFor(const Solution& taken, const Solution& found) {
  std::vector<Evidence> all;
  for (const Evidence& one : found.evidence) {
    if (one.rule != kSearchRule || one.is_always_told) continue;
    all.push_back(one);
    all.back().what = found.method + ": " + one.what;
  }
  for (const auto& [method, evidence] : found.of_others) {
    if (method == taken.method) all.push_back(evidence);
  }
  return all;
}

}  // namespace

void ShareFindings(std::vector<Solution>* solutions) {
  for (const Solution& found : *solutions) {
    if (!MethodOf(found.method).Has(MethodTrait::kSearches)) continue;
    for (Solution& taken : *solutions) {
      const bool is_asked = &taken != &found && !taken.forward &&
                            taken.usable() &&
                            taken.layout.Has(BlockKind::kPosition);
      if (!is_asked) continue;
      for (Evidence& one : HoldsFor(taken, found)) {
        AddEvidence(std::move(one), &taken);
      }
    }
  }
}

}  // namespace hindsight
