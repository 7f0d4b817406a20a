#ifndef HINDSIGHT_IO_WRITE_RESULT_MANIFEST_H_
#define HINDSIGHT_IO_WRITE_RESULT_MANIFEST_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hindsight {

/// Name of the file in a folder of results that lists the others:
///   {"program": "hindsight", "complete": true,
///    "files": ["config.resolved.yaml", "ekf.csv", ...]}
inline constexpr char kManifestName[] = "manifest.json";

/// It is there before the first of them: what lies in a folder that is being
/// written is listed. Of incomplete results it may list files that were never
/// finished.
struct ResultManifest {
  bool complete = false;           ///< false: the run was interrupted
  std::vector<std::string> files;  ///< names, without the manifest's own
};

/// Writes the manifest into `folder`. Throws OutputError.
void WriteManifest(const ResultManifest& manifest,
                   const std::filesystem::path& folder);

/// Nothing if `folder` holds none that this program wrote.
std::optional<ResultManifest> ReadManifest(const std::filesystem::path& folder);

/// Whether a folder's files have their names; if not, they may also have those
/// of io/write/unpublished.h.
enum class Finished { kYes, kNo };

/// Something in `folder` that is neither a regular file listed in its manifest
/// nor the manifest, and why not: "thesis.txt, which is not listed in its
/// manifest.json"; "" if there is no such thing. Throws InputError if the
/// folder cannot be listed.
std::string FindForeign(const std::filesystem::path& folder,
                        Finished finished = Finished::kYes);

/// Removes the files that the manifest lists, the manifest, and the folder if
/// nothing is left in it; whether it is gone.
bool RemoveListed(const std::filesystem::path& folder);

/// The same of a folder that was being written, with its unfinished files.
/// Throws InputError if the folder cannot be listed.
bool RemoveUnfinished(const std::filesystem::path& folder);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_RESULT_MANIFEST_H_
