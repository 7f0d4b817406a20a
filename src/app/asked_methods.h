#ifndef HINDSIGHT_APP_ASKED_METHODS_H_
#define HINDSIGHT_APP_ASKED_METHODS_H_

#include <string>
#include <vector>

namespace hindsight {

/// The methods of --methods.
struct AskedMethods {
  std::vector<std::string> names;  ///< in the order given, each once
  bool attitude_alone = false;     ///< all of them estimate no more
};

/// Of the words between the commas of `text`. Throws UsageError for none, for
/// one that is no method, and where those of attitude alone stand beside others.
AskedMethods ReadMethods(const std::string& text);

/// The same, of trajectories alone. Throws UsageError.
std::vector<std::string> ReadTrajectoryMethods(const std::string& text);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_ASKED_METHODS_H_
