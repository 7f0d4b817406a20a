#ifndef HINDSIGHT_IO_OUTPUT_ERROR_H_
#define HINDSIGHT_IO_OUTPUT_ERROR_H_

#include <stdexcept>
#include <string>

namespace hindsight {

/// A result could not be written, or not put where it was asked for: a full
/// disk, a limit on the size of files, a name that another took meanwhile.
/// what() is one line. The command ends with status 4.
class OutputError : public std::runtime_error {
 public:
  explicit OutputError(const std::string& message)
      : std::runtime_error(message) {}
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_OUTPUT_ERROR_H_
