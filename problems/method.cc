#include "problems/method.h"

#include <utility>

#include "base/error.h"

namespace hindsight {
namespace {

constexpr std::pair<Method, const char*> kMethods[] = {
    {Method::kEkf, "ekf"},
    {Method::kTwoFilter, "two_filter"},
    {Method::kTwoFilterConventional, "two_filter_conventional"},
    {Method::kTwoFilterEuler, "two_filter_euler"},
    {Method::kHInfinity, "hinf"},
    {Method::kModifiedHInfinity, "modified_hinf"},
    {Method::kRts, "rts"},
    {Method::kIterated, "iterated"},
    {Method::kBatch, "batch"},
    {Method::kGatedEkf, "gated_ekf"},
    {Method::kImm, "imm"},
    {Method::kImmSmoother, "imm_smoother"},
    {Method::kRobustBatch, "robust_batch"}};

}  // namespace

const char* MethodName(Method method) {
  for (const auto& [value, name] : kMethods) {
    if (value == method) return name;
  }
  return "";
}

Method MethodFromName(const std::string& name) {
  std::string known;
  for (const auto& [value, text] : kMethods) {
    if (name == text) return value;
    known += (known.empty() ? "" : ", ") + std::string(text);
  }
  throw InputError("unknown method '" + name + "'; known are " + known);
}

std::span<const char* const> MethodPreference() {
  static constexpr const char* kPreference[] = {"batch",
                                                "iterated",
                                                "robust_batch",
                                                "rts",
                                                "two_filter",
                                                "two_filter_conventional",
                                                "two_filter_euler",
                                                "imm_smoother",
                                                "ekf",
                                                "gated_ekf",
                                                "imm",
                                                "hinf",
                                                "modified_hinf",
                                                "ahrs_batch",
                                                "ahrs_tilt_batch",
                                                "ahrs_smoother",
                                                "ahrs"};
  return kPreference;
}

bool IsForward(Method method) {
  return method == Method::kEkf || method == Method::kGatedEkf ||
         method == Method::kHInfinity || method == Method::kModifiedHInfinity ||
         method == Method::kImm;
}

bool DependsOnError(Method method) {
  return method != Method::kImm && method != Method::kImmSmoother &&
         method != Method::kRobustBatch;
}

}  // namespace hindsight
