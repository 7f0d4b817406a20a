#include "app/asked_methods.h"

#include <cstddef>

#include "app/flags.h"
#include "app/list_flags.h"
#include "base/error.h"
#include "problems/method.h"

namespace hindsight {

AskedMethods ReadMethods(const std::string& text) {
  AskedMethods asked;
  std::size_t attitude_alone = 0;
  for (const std::string& name : ReadWords("methods", text)) {
    try {
      attitude_alone += MethodOf(name).attitude_alone() ? 1 : 0;
    } catch (const InputError& error) {
      throw BadFlag("methods", text, error.what());
    }
    asked.names.push_back(name);
  }
  if (asked.names.empty()) {
    throw UsageError("--methods: expected some of " + MethodNames(false));
  }
  asked.attitude_alone = attitude_alone == asked.names.size();
  if (attitude_alone > 0 && !asked.attitude_alone) {
    throw BadFlag("methods", text,
                  MethodNames(true) +
                      " estimate attitude alone and do not go with the other "
                      "methods");
  }
  return asked;
}

std::vector<std::string> ReadTrajectoryMethods(const std::string& text) {
  AskedMethods asked = ReadMethods(text);
  if (!asked.attitude_alone) return asked.names;
  throw BadFlag("methods", text,
                "'" + asked.names.front() + "' is for attitude alone");
}

}  // namespace hindsight
