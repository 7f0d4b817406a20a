#include "app/abandoned.h"

#include <algorithm>
#include <optional>
#include <system_error>

#include "app/error_line.h"
#include "base/error.h"
#include "io/read/paths.h"
#include "io/write/result_manifest.h"
#include "io/write/unpublished.h"

namespace hindsight {
namespace fs = std::filesystem;
namespace {

/// Complete results that never got their name, or had it before.
bool HoldsCompleteResults(const fs::path& folder) {
  const std::optional<ResultManifest> manifest = ReadManifest(folder);
  return manifest && manifest->complete &&
         std::all_of(
             manifest->files.begin(), manifest->files.end(),
             [&](const std::string& name) { return IsFile(folder / name); });
}

bool RemoveAbandoned(const fs::path& path) {
  std::error_code refused;
  if (!fs::is_directory(fs::symlink_status(path, refused))) {
    return fs::remove(path, refused);
  }
  return RemoveUnfinished(path);
}

void Treat(const fs::path& path, bool clean, const Disowned& disowned) {
  if (HoldsCompleteResults(path)) {
    PrintNote(path.string() +
              " holds complete results that a killed run did not put in "
              "place or replaced; rename or remove it");
    return;
  }
  const std::string objection = disowned(path);
  if (!clean) {
    PrintNote(
        path.string() +
        (objection.empty()
             ? " is left of a killed run; --clean removes it"
             : " has the name of what a killed run leaves, but " + objection));
  } else if (!objection.empty()) {
    throw InputError(path.string() + " " + objection +
                     "; --clean does not remove it");
  } else if (!RemoveAbandoned(path)) {
    throw InputError(path.string() + " cannot be removed");
  }
}

}  // namespace

std::string DisownedFolder(const fs::path& path) {
  std::error_code refused;
  if (!fs::is_directory(fs::symlink_status(path, refused))) {
    return "is no folder";
  }
  try {
    const std::string foreign = FindForeign(path, Finished::kNo);
    return foreign.empty() ? "" : "holds " + foreign;
  } catch (const InputError& error) {
    return error.what();
  }
}

void TreatAbandoned(const fs::path& target, bool clean,
                    const Disowned& disowned) {
  for (const fs::path& path : FindAbandoned(target)) {
    Treat(path, clean, disowned);
  }
}

}  // namespace hindsight
