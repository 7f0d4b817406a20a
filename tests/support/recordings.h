#ifndef HINDSIGHT_TESTS_SUPPORT_RECORDINGS_H_
#define HINDSIGHT_TESTS_SUPPORT_RECORDINGS_H_

#include <cstdlib>
#include <filesystem>

namespace hindsight::testing {

/// The folder of the recordings (data/README.md): what the environment sets
/// HINDSIGHT_RECORDINGS to, else the entry of CMake's cache of that name. Tests
/// of a recording that is not in it are skipped.
inline std::filesystem::path RecordingsFolder() {
  const char* folder = std::getenv("HINDSIGHT_RECORDINGS");
  return folder != nullptr ? folder : HINDSIGHT_RECORDINGS;
}

}  // namespace hindsight::testing

#endif  // HINDSIGHT_TESTS_SUPPORT_RECORDINGS_H_
