#ifndef HINDSIGHT_IO_RESULT_MANIFEST_H_
#define HINDSIGHT_IO_RESULT_MANIFEST_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hindsight {

/// Name of the file in a folder of results that lists the others:
///   {"program": "hindsight", "complete": true,
///    "files": ["config.resolved.yaml", "ekf.csv", ...]}
inline constexpr char kManifestName[] = "manifest.json";

struct ResultManifest {
  bool complete = false;           ///< false: the run was interrupted
  std::vector<std::string> files;  ///< names, without the manifest's own
};

/// Writes the manifest into `folder`. Throws OutputError.
void WriteManifest(const ResultManifest& manifest,
                   const std::filesystem::path& folder);

/// Nothing if `folder` holds none that this program wrote.
std::optional<ResultManifest> ReadManifest(const std::filesystem::path& folder);

/// The name of something in `folder` that is not a regular file listed in its
/// manifest, nor the manifest; "" if all is. Throws InputError if the folder
/// cannot be listed.
std::string FindUnlisted(const std::filesystem::path& folder);

/// Removes the files that the manifest lists, the manifest, and the folder if
/// nothing is left in it; whether it is gone.
bool RemoveListed(const std::filesystem::path& folder);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_RESULT_MANIFEST_H_
