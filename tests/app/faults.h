#ifndef HINDSIGHT_TESTS_APP_FAULTS_H_
#define HINDSIGHT_TESTS_APP_FAULTS_H_

#include <cstdlib>
#include <functional>
#include <map>
#include <string>

namespace hindsight {

/// Variables of support/faults.cc by their names after HINDSIGHT_FAULT, for a
/// child: {"", "write:1:28"}, {"_LOG", path}.
inline std::function<void()> WithFaults(
    std::map<std::string, std::string> variables) {
  return [variables = std::move(variables)] {
    setenv("LD_PRELOAD", HINDSIGHT_FAULTS, 1);
    for (const auto& [name, value] : variables) {
      setenv(("HINDSIGHT_FAULT" + name).c_str(), value.c_str(), 1);
    }
  };
}

/// A sanitizer's runtime must be the first library and takes the same calls.
inline bool CanInjectFaults() { return HINDSIGHT_FAULTS[0] != '\0'; }

}  // namespace hindsight

#endif  // HINDSIGHT_TESTS_APP_FAULTS_H_
