#ifndef HINDSIGHT_APP_COMMAND_H_
#define HINDSIGHT_APP_COMMAND_H_

#include <stdexcept>
#include <string>
#include <vector>

#include "state/evidence.h"

namespace hindsight {

/// Exit statuses of the command.
enum ExitStatus {
  kUsable = 0,      ///< a usable answer
  kUnusable = 1,    ///< the data give no usable answer
  kBadInput = 2,    ///< wrong usage or bad input
  kDoubtful = 3,    ///< an answer that something contradicts
  kNotWritten = 4,  ///< results could not be written where they were to be
  kStopped = 130,   ///< stopped by Ctrl-C, SIGTERM or SIGHUP
};

/// The exit status that says a grade.
ExitStatus StatusOf(Grade grade);

/// The command line does not say what to do; ends with kBadInput.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A flag that a sub-command accepts.
struct FlagUse {
  std::string name;         ///< of the gflag, underscores for dashes
  std::string placeholder;  ///< of its value in the help, "" for a switch
  std::string help;         ///< one or more lines of text
};

/// One sub-command of `hindsight`.
struct Command {
  std::string name;
  std::string summary;    ///< one line, for the list of sub-commands
  std::string arguments;  ///< positional arguments as shown: "CONFIG"
  std::string help;       ///< what it does, reads and writes
  std::vector<FlagUse> flags;
  std::size_t min_arguments = 0;
  std::size_t max_arguments = 0;
  /// Returns the exit status. Throws what base/error.h and
  /// io/write/output_error.h declare.
  int (*run)(const std::vector<std::string>& arguments) = nullptr;
};

Command CheckCommand();
Command RunCommand();
Command EvaluateCommand();
Command SimulateCommand();
Command InitCommand();
Command MonteCarloCommand();
Command ReportCommand();
Command CampaignCommand();
Command MergeCommand();

}  // namespace hindsight

#endif  // HINDSIGHT_APP_COMMAND_H_
