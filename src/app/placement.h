#ifndef HINDSIGHT_APP_PLACEMENT_H_
#define HINDSIGHT_APP_PLACEMENT_H_

#include <sys/stat.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/write/unpublished.h"

namespace hindsight {

/// What --out, --force and --clean say.
struct OutputRequest {
  std::string folder;
  bool force = false;
  bool clean = false;
};

/// The name under which a folder of results appears, in one step. What is in
/// the way then is never removed: the results stay beside it, as FOLDER.1,
/// FOLDER.2 and so on. What was there from the start is replaced while it is an
/// empty folder, and with `force` where it holds nothing but files that its
/// manifest lists (io/write/result_manifest.h), by exchanging the two in one
/// step; where the file system cannot, by two renames, and a kill between these
/// leaves both folders beside the name. Results that lie elsewhere by then, as
/// a folder above was renamed, get FOLDER.1 and so on there.
class Placement {
 public:
  using Paths = std::vector<std::filesystem::path>;

  /// `inputs` names what is read besides; it is asked only if the folder
  /// exists. Throws InputError if the folder exists and may not be replaced,
  /// holds an input or is or holds the working directory, which the new folder
  /// would leave without a name.
  Placement(const OutputRequest& request, const std::function<Paths()>& inputs);

  /// Absolute and without links, so that what is made beside it lies on the
  /// same file system.
  const std::filesystem::path& folder() const { return folder_; }

  /// Gives the folder `finished` the name. Incomplete results never replace
  /// complete ones. Throws OutputError where `finished` cannot be brought onto
  /// the medium, and for complete results that did not get the name or may lose
  /// it, telling where they are.
  void Place(const std::filesystem::path& finished, bool complete);

  /// Where the results are, once they are to stay.
  const std::optional<std::filesystem::path>& placed() const { return placed_; }

 private:
  std::optional<struct stat> CheckMayReplace(
      const std::function<Paths()>& inputs) const;
  void CheckHolds(const std::function<Paths()>& inputs) const;
  std::string Objection(const std::filesystem::path& old, bool complete) const;
  void PlaceBeside(const std::string& reason);
  void Replace();
  void ReplaceByTwoRenames();
  void TakenFrom(const std::filesystem::path& old);

  bool force_;
  std::filesystem::path folder_;
  std::optional<struct stat> replaced_;  ///< what may be replaced
  Descriptor held_;  ///< of it, so that no other folder gets its number
  std::filesystem::path finished_;  ///< what is being placed
  bool complete_ = false;
  std::optional<std::filesystem::path> placed_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_APP_PLACEMENT_H_
