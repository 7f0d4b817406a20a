#include <iostream>

#include "app/command.h"
#include "app/flags.h"
#include "base/error.h"
#include "io/atomic_file.h"
#include "io/init_config.h"
#include "io/paths.h"

namespace hindsight {
namespace {

constexpr const char* kHelp =
    R"(Looks at the files in FOLDER and prints a commented configuration for what it
recognises, to be completed and given to 'check' and 'run'.
)";

int Run(const std::vector<std::string>& arguments) {
  if (!FLAGS_out.empty() && !FLAGS_force && PathExists(FLAGS_out)) {
    throw InputError("output file " + FLAGS_out +
                     " exists; choose another or replace it with --force");
  }
  const std::string config = InitConfig(arguments[0]);
  if (FLAGS_out.empty()) {
    std::cout << config;
    return kUsable;
  }
  WriteFileAtomically(FLAGS_out, config);
  std::cout << "wrote " << FLAGS_out << "\nlook at the recording with: "
            << "hindsight check " << FLAGS_out << "\n";
  return kUsable;
}

}  // namespace

Command InitCommand() {
  return {
      .name = "init",
      .summary = "draft a configuration for a folder of recorded files",
      .arguments = "FOLDER",
      .help = kHelp,
      .flags = {{"out", "FILE", "write the configuration there"},
                {"force", "", "replace FILE if it exists"}},
      .min_arguments = 1,
      .max_arguments = 1,
      .run = Run,
  };
}

}  // namespace hindsight
