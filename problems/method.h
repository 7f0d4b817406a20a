#ifndef HINDSIGHT_PROBLEMS_METHOD_H_
#define HINDSIGHT_PROBLEMS_METHOD_H_

#include <span>
#include <string>

namespace hindsight {

enum class Method {
  kEkf,
  kTwoFilter,              ///< error form
  kTwoFilterConventional,  ///< full state in the additive chart
  kTwoFilterEuler,         ///< full state in the Euler-angle chart
  kHInfinity,              ///< forward observer
  kModifiedHInfinity,      ///< forward observer
  kRts,
  kIterated,
  kBatch,
  kGatedEkf,     ///< kEkf, with a gate of 99.9 % where a sensor has none
  kImm,          ///< good and poor positions, problems/sensor_imm.h
  kImmSmoother,  ///< its smoother
  kRobustBatch   ///< batch that finds the positions' error model itself
};

/// "ekf", "two_filter", "two_filter_conventional", "two_filter_euler", "hinf",
/// "modified_hinf", "rts", "iterated", "batch", "gated_ekf", "imm",
/// "imm_smoother", "robust_batch".
const char* MethodName(Method method);
/// Throws InputError for a name that is none, listing those that are.
Method MethodFromName(const std::string& name);

/// Names of all methods, of attitude alone too, in the order in which they are
/// preferred where nothing else decides: the whole interval before smoothers on
/// one linearisation, these before filters, which know the past alone, and
/// observers last, whose P is no covariance; of each kind the plain model
/// before the richer.
std::span<const char* const> MethodPreference();

/// Whether the method knows nothing later at each node; see Solution::forward.
bool IsForward(Method method);

/// Whether ReconstructionOptions::error changes the method's solution, be it
/// through the trajectory from which it starts to iterate.
bool DependsOnError(Method method);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_METHOD_H_
