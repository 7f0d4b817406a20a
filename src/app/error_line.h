#ifndef HINDSIGHT_APP_ERROR_LINE_H_
#define HINDSIGHT_APP_ERROR_LINE_H_

#include <string>

namespace hindsight {

/// "hindsight: error: MESSAGE" on standard error, as one line of at most 500
/// characters whatever the message holds.
void PrintError(const std::string& message);

/// The same with "note" in place of "error": for what needs no action now.
void PrintNote(const std::string& message);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_ERROR_LINE_H_
