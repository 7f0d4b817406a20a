#ifndef HINDSIGHT_APP_HELP_H_
#define HINDSIGHT_APP_HELP_H_

#include <string>
#include <vector>

#include "app/command.h"

namespace hindsight {

/// Page of `hindsight --help`: the sub-commands and the exit statuses.
std::string GeneralHelp(const std::vector<Command>& commands);

/// Page of `hindsight COMMAND --help`.
std::string CommandHelp(const Command& command);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_HELP_H_
