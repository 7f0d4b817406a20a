#ifndef HINDSIGHT_APP_BUILD_ID_H_
#define HINDSIGHT_APP_BUILD_ID_H_

#include <string>

namespace hindsight {

/// What tells this build of the program from any other, in hexadecimal: the
/// linker's hash of all that was linked (the note NT_GNU_BUILD_ID); the same
/// sources built alike have the same. "" if the linker left none.
std::string BuildId();

}  // namespace hindsight

#endif  // HINDSIGHT_APP_BUILD_ID_H_
