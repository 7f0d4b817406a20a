#ifndef HINDSIGHT_APP_STUDIES_H_
#define HINDSIGHT_APP_STUDIES_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "problems/montecarlo.h"

namespace hindsight {

/// A Monte Carlo comparison that comes with the program.
struct NamedStudy {
  std::string name;
  std::string help;  ///< one or more lines
  /// As the flags ask for. Throws UsageError for those that do not fit, before
  /// it computes anything.
  std::function<Study()> make;
  /// The flags of its own, with underscores for dashes.
  std::vector<std::string> flags = {"set", "sweep"};
  std::uint64_t default_runs = 100;
};

/// All of them.
const std::vector<NamedStudy>& NamedStudies();

/// Every vehicle of --faults, healthy and with every fault that it has a place
/// for. Throws UsageError, and InputError for a file that is no list of faults.
Study GradesStudy();

}  // namespace hindsight

#endif  // HINDSIGHT_APP_STUDIES_H_
