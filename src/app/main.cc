#include <glog/logging.h>

#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include "app/command.h"
#include "app/error_line.h"
#include "app/flags.h"
#include "app/help.h"
#include "app/interrupt.h"
#include "app/terminal.h"
#include "base/error.h"
#include "base/freed_memory.h"
#include "io/config/config_help.h"
#include "io/config/vehicle.h"
#include "io/write/output_error.h"
#include "io/write/unpublished.h"

namespace hindsight {
namespace {

void StartLogging(const char* program) {
  const std::vector<std::string> levels = {"info", "warning", "error", "none"};
  int severity = 0;
  while (severity < 4 &&
         levels[static_cast<std::size_t>(severity)] != FLAGS_log) {
    ++severity;
  }
  if (severity == 4) {
    throw UsageError("--log=" + FLAGS_log +
                     ": expected info, warning, error or none");
  }
  FLAGS_logtostderr = true;
  FLAGS_minloglevel = severity;
  google::InitGoogleLogging(program);
}

const Command& FindCommand(const std::vector<Command>& commands,
                           const std::string& name) {
  std::vector<std::string> names = {"help"};
  for (const Command& command : commands) {
    if (command.name == name) return command;
    names.push_back(command.name);
  }
  throw UsageError("unknown command '" + name + "'" + Suggestion(name, names) +
                   " ('hindsight --help' lists the commands)");
}

/// `hindsight help config [KEY | --markdown | --schema]`.
int HelpOnConfig(const std::vector<std::string>& words) {
  const std::string word = words.size() > 1 ? words[1] : "";
  if (words.size() > 2 ||
      (word.starts_with("-") && word != "--markdown" && word != "--schema")) {
    throw UsageError(
        "help config: expected nothing more, a key, a map, a kind of sensor, "
        "--markdown or --schema");
  }
  const std::string text = word == "--markdown" ? ConfigMarkdown()
                           : word == "--schema" ? ConfigSchema()
                                                : ConfigHelp(word);
  if (text.empty()) {
    throw UsageError("help config: no key, map or kind of sensor is named '" +
                     word + "' ('hindsight help config' lists them)");
  }
  std::cout << text;
  return kUsable;
}

/// `hindsight help formats [--markdown]`.
int HelpOnFormats(const std::vector<std::string>& words) {
  const bool markdown = words.size() == 2 && words[1] == "--markdown";
  if (words.size() > 1 && !markdown) {
    throw UsageError("help formats: expected nothing more, or --markdown");
  }
  std::cout << (markdown ? FormatMarkdown() : FormatHelp());
  return kUsable;
}

/// `hindsight help vehicles [--markdown]`.
int HelpOnVehicles(const std::vector<std::string>& words) {
  const bool markdown = words.size() == 2 && words[1] == "--markdown";
  if (words.size() > 1 && !markdown) {
    throw UsageError("help vehicles: expected nothing more, or --markdown");
  }
  std::cout << (markdown ? VehicleMarkdown() : VehicleHelp());
  return kUsable;
}

int Dispatch(const char* program, std::vector<std::string> words) {
  const std::vector<Command> commands = {
      CheckCommand(),    RunCommand(),      EvaluateCommand(),
      SimulateCommand(), InitCommand(),     MonteCarloCommand(),
      MergeCommand(),    CampaignCommand(), ReportCommand(),
      CombineCommand(),
  };
  if (!words.empty() && words[0] == "help") {
    words.erase(words.begin());
    if (!words.empty() && words[0] == "config") return HelpOnConfig(words);
    if (!words.empty() && words[0] == "formats") return HelpOnFormats(words);
    if (!words.empty() && words[0] == "vehicles") return HelpOnVehicles(words);
    if (!words.empty()) words = {words[0], "--help"};
  }
  if (words.empty() || words[0] == "--help" || words[0] == "-h") {
    std::cout << GeneralHelp(commands);
    return kUsable;
  }
  if (words[0] == "--version") {
    std::cout << "hindsight " HINDSIGHT_VERSION "\n";
    return kUsable;
  }
  const Command& command = FindCommand(commands, words[0]);
  words.erase(words.begin());
  const ParsedArguments arguments = ParseArguments(command, words);
  if (arguments.help) {
    std::cout << CommandHelp(command);
    return kUsable;
  }
  StartLogging(program);
  if (FLAGS_quiet) SilenceOutput();
  return command.run(arguments.positional);
}

int Fail(int status, const std::string& message) {
  // Whatever was printed so far comes before the error where both go to one
  // file.
  std::cout.flush();
  PrintError(message);
  return status;
}

/// Results in a folder or file are there whether or not they could be told of.
int StatusWithoutOutput(int status) {
  const std::string message = "standard output cannot be written";
  if (FLAGS_out.empty()) return Fail(kNotWritten, message);
  PrintNote(message + "; the results are in " + FLAGS_out);
  return status;
}

int Main(int argc, char** argv) {
  KeepFreedMemory();
  OccupyStandardStreams();
  CatchSignals();
  try {
    const int status =
        Dispatch(argv[0], std::vector<std::string>(argv + 1, argv + argc));
    std::cout.flush();
    return std::cout ? status : StatusWithoutOutput(status);
  } catch (const UsageError& error) {
    return Fail(kBadInput, error.what());
  } catch (const InputError& error) {
    return Fail(kBadInput, error.what());
  } catch (const EstimationError& error) {
    return Fail(kUnusable, error.what());
  } catch (const Interrupted& error) {
    return Fail(kStopped, error.what());
  } catch (const OutputError& error) {
    return Fail(kNotWritten, error.what());
  } catch (const std::bad_alloc&) {
    return Fail(kUnusable, "out of memory");
  } catch (const std::exception& error) {
    return Fail(kUnusable, error.what());
  }
}

}  // namespace
}  // namespace hindsight

int main(int argc, char** argv) { return hindsight::Main(argc, argv); }
