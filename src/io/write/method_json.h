#ifndef HINDSIGHT_IO_WRITE_METHOD_JSON_H_
#define HINDSIGHT_IO_WRITE_METHOD_JSON_H_

#include <nlohmann/json.hpp>
#include <vector>

#include "io/write/summary.h"

namespace hindsight {

/// What summary.json says of a method (SummaryJson).
nlohmann::ordered_json MethodJson(const MethodSummary& m);

/// `unobserved` of a method or of the recording; not there without spans.
void PutUnobserved(const std::vector<UnobservedSpan>& spans,
                   nlohmann::ordered_json* json);

/// "observed", "weak" or "unobserved".
const char* VerdictName(ConstantEstimate::Verdict verdict);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_METHOD_JSON_H_
