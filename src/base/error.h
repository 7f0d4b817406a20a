#ifndef HINDSIGHT_BASE_ERROR_H_
#define HINDSIGHT_BASE_ERROR_H_

#include <stdexcept>
#include <string>

namespace hindsight {

/// Bad input from outside: a file, a configuration key, a flag. what() is one
/// line that says where, what is wrong and what was expected. The command ends
/// with status 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message)
      : std::runtime_error(message) {}

  /// "file:line: message"; line counts from 1, and 0 leaves the line out.
  InputError(const std::string& file, long line, const std::string& message)
      : std::runtime_error(file + ":" +
                           (line > 0 ? std::to_string(line) + ": " : " ") +
                           message) {}
};

/// The data are well formed but give no usable answer (a state that cannot be
/// observed, a divergence). The command ends with status 1.
class EstimationError : public std::runtime_error {
 public:
  explicit EstimationError(const std::string& message)
      : std::runtime_error(message) {}
};

/// The user asked to stop. The command ends with status 130.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_ERROR_H_
