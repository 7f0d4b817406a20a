#ifndef HINDSIGHT_APP_SHELL_WORD_H_
#define HINDSIGHT_APP_SHELL_WORD_H_

#include <string>

namespace hindsight {

/// As one word of a POSIX shell, within quotes where it needs them.
std::string ShellWord(const std::string& word);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_SHELL_WORD_H_
