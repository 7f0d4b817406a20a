#ifndef HINDSIGHT_IO_WRITE_OUTPUT_ERROR_H_
#define HINDSIGHT_IO_WRITE_OUTPUT_ERROR_H_

#include <filesystem>
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
  /// "output file FILE cannot be written: CAUSE".
  OutputError(const std::filesystem::path& file, const std::string& cause)
      : std::runtime_error("output file " + file.string() +
                           " cannot be written: " + cause),
        file_(file),
        cause_(cause) {}

  /// The file that could not be written, at its path then; empty: no file.
  const std::filesystem::path& file() const { return file_; }
  const std::string& cause() const { return cause_; }

 private:
  std::filesystem::path file_;
  std::string cause_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_OUTPUT_ERROR_H_
