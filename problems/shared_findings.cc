#include "problems/shared_findings.h"

#include <utility>

#include "evaluation/grade.h"
#include "problems/method.h"

namespace hindsight {
namespace {

constexpr const char* kSearchRule = "search";

}  // namespace

void ShareFindings(std::vector<Solution>* solutions) {
  for (const Solution& found : *solutions) {
    if (!MethodOf(found.method).Has(MethodTrait::kSearches)) continue;
    for (Solution& taken : *solutions) {
      const bool is_asked = &taken != &found && !taken.forward &&
                            taken.usable() &&
                            taken.layout.Has(BlockKind::kPosition);
      if (!is_asked) continue;
      for (const Evidence& one : found.evidence) {
        if (one.rule != kSearchRule || one.is_always_told) continue;
        Evidence shared = one;
        shared.what = found.method + ": " + one.what;
        AddEvidence(std::move(shared), &taken);
      }
    }
  }
}

}  // namespace hindsight
