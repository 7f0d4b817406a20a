#ifndef HINDSIGHT_PROBLEMS_METHOD_H_
#define HINDSIGHT_PROBLEMS_METHOD_H_

#include <initializer_list>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "state/solution.h"

namespace hindsight {

class AttitudeEstimation;
class MethodStage;

/// What a method heeds or is, beyond what all of its kind do.
enum class MethodTrait {
  /// Uses nothing later than the node at each node; see Solution::forward.
  kForward,
  /// Is linear about the forward filter's trajectory.
  kLinearisesOnce,
  /// Minimises the cost of the whole interval, so that its optimum compares
  /// with that of others that do.
  kFindsOptimum,
  /// ReconstructionOptions::error changes its solution, if only through the
  /// trajectory from which the method starts to iterate.
  kDependsOnError,
  /// Heeds ReconstructionOptions::h_infinity, modified_h_infinity.
  kHInfinity,
  kModifiedHInfinity,
  /// Heeds ReconstructionOptions::max_time.
  kSearches,
  /// Takes MethodStage::SolveBatch of the shared nodes.
  kSolvesBatch,
};

constexpr unsigned TraitsOf(std::initializer_list<MethodTrait> traits) {
  unsigned bits = 0;
  for (const MethodTrait trait : traits) {
    bits |= 1u << static_cast<unsigned>(trait);
  }
  return bits;
}

/// A method of `hindsight run`: a file of problems/methods/, which has all of
/// this, and its place in the table of problems/method.cc.
struct Method {
  using OfTrajectory = Solution (*)(MethodStage*);
  using OfAttitude = Solution (*)(AttitudeEstimation*);

  const char* name;  ///< as it is asked for and written
  const char* help;  ///< one or more lines, without an indent
  unsigned traits;   ///< MethodTraits, joined by TraitsOf
  /// Of position, velocity and attitude, or of attitude alone.
  std::variant<OfTrajectory, OfAttitude> run;
  /// About how long it takes after the methods that it builds on, in passes of
  /// the forward filter: for the time left that a progress bar tells.
  double work = 1.0;

  bool Has(MethodTrait trait) const {
    return (traits & TraitsOf({trait})) != 0;
  }
  bool attitude_alone() const {
    return std::holds_alternative<OfAttitude>(run);
  }
};

/// Every method, in the order in which they are preferred where nothing else
/// decides (BestOf): the whole interval before smoothers on one linearisation,
/// these before filters, which know the past alone, and observers last, whose P
/// is no covariance; of each kind the plain model before the richer; attitude
/// alone after all others.
std::span<const Method* const> Methods();

/// Adds a method that a program brings, behind all others; it must outlive the
/// use of the table. Throws std::invalid_argument if the name is taken.
void AddMethod(const Method& method);

/// The best of several solutions of one recording, of which there must be one
/// (BestOf, with the methods' order of preference).
const Solution& Best(const std::vector<Solution>& solutions);

/// Names of all methods of one kind, separated by ", ".
std::string MethodNames(bool attitude_alone);

/// Names and help of all methods of one kind, for the terminal.
std::string MethodHelp(bool attitude_alone);

/// Throws InputError for a name that is none, listing those that are.
const Method& MethodOf(const std::string& name);

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_METHOD_H_
