#include "app/help.h"

#include <algorithm>
#include <sstream>

#include "app/flags.h"

namespace hindsight {
namespace {

constexpr std::size_t kFlagColumn = 24;

std::string FlagHelp(const FlagUse& flag) {
  std::string left = "  --" + flag.name;
  std::replace(left.begin(), left.end(), '_', '-');
  if (!flag.placeholder.empty()) left += "=" + flag.placeholder;
  if (left.size() + 2 > kFlagColumn) {
    left += "\n" + std::string(kFlagColumn, ' ');
  } else {
    left.resize(kFlagColumn, ' ');
  }
  std::string text;
  for (const char c : flag.help) {
    text += c;
    if (c == '\n') text.append(kFlagColumn, ' ');
  }
  return left + text + "\n";
}

}  // namespace

ExitStatus StatusOf(Grade grade) {
  switch (grade) {
    case Grade::kUsable:
      return kUsable;
    case Grade::kDoubtful:
      return kDoubtful;
    case Grade::kUnusable:
      return kUnusable;
  }
  return kUnusable;
}

std::string GeneralHelp(const std::vector<Command>& commands) {
  std::ostringstream out;
  out << "hindsight: reconstructs a vehicle's trajectory from a recording\n\n"
         "Usage: hindsight COMMAND [arguments] [--flags]\n\nCommands:\n";
  for (const Command& command : commands) {
    out << "  " << command.name << std::string(12 - command.name.size(), ' ')
        << command.summary << "\n";
  }
  out << "\n'hindsight COMMAND --help' describes a command and its flags;\n"
         "'hindsight help config [KEY]' describes a configuration's keys;\n"
         "'hindsight help formats' lists the formats of files that are read;\n"
         "'hindsight help vehicles' lists what `vehicle: NAME` sets, and why;\n"
         "'hindsight --version' prints the version.\n\n"
         "Exit status: 0 usable answer, 3 doubtful, 1 no usable answer,\n"
         "2 wrong usage or bad input, 4 results that could not be written or\n"
         "put in place, 130 stopped by Ctrl-C. Errors are one line on "
         "stderr.\n";
  return out.str();
}

std::string CommandHelp(const Command& command) {
  std::ostringstream out;
  out << "Usage: hindsight " << command.name << " " << command.arguments
      << " [--flags]\n\n"
      << command.help << "\nFlags (--flag=value or --flag value):\n";
  for (const FlagUse& flag : command.flags) out << FlagHelp(flag);
  for (const FlagUse& flag : CommonFlags()) out << FlagHelp(flag);
  out << FlagHelp({"help", "", "print this page"});
  return out.str();
}

}  // namespace hindsight
