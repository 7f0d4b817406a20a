#ifndef HINDSIGHT_IO_WRITE_UNPUBLISHED_H_
#define HINDSIGHT_IO_WRITE_UNPUBLISHED_H_

#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace hindsight {

/// \file
/// What has not got its name yet lies beside it, as .NAME.partial-XXXXXXXXXXXX
/// with twelve random hexadecimal digits (of a long NAME, its first 200 bytes).

/// A descriptor that closes itself. What was written through it is safe only
/// after fsync: an error of closing is not told.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor();

  int get() const { return fd_; }
  bool IsOpen() const { return fd_ >= 0; }

 private:
  int fd_ = -1;
};

/// An entry that nobody else has, locked (flock) until it is closed, so that
/// what a killed writer left can be told from what is still being written.
struct Unpublished {
  std::filesystem::path path;
  Descriptor descriptor;
};

/// Where an entry lies now: a folder above it may have been renamed meanwhile.
/// Nothing if it is gone, or the system does not tell.
std::optional<std::filesystem::path> PresentPath(const Unpublished& entry);

/// A name for something unpublished beside `target`. Nothing is created.
std::filesystem::path UnpublishedName(const std::filesystem::path& target);

/// Whether an entry of that name has the form of something unpublished that is
/// to be called `target`.
bool IsUnpublishedName(const std::string& name,
                       const std::filesystem::path& target);

/// A new empty file, open for reading and writing, or a new empty folder beside
/// `target`. Either is created by this call or the call fails with `error` set.
Unpublished CreateUnpublishedFile(const std::filesystem::path& target,
                                  std::error_code* error);
Unpublished CreateUnpublishedFolder(const std::filesystem::path& target,
                                    std::error_code* error);

/// What killed writers of `target` left: entries of that form beside it that
/// nobody holds locked, sorted. One whose lock cannot be tried is not listed.
std::vector<std::filesystem::path> FindAbandoned(
    const std::filesystem::path& target);

/// Holds a folder, so that no other gets its number (st_ino) even if it is
/// removed. Not open where there is no folder.
Descriptor HoldFolder(const std::filesystem::path& folder);

/// Waits until the medium has a folder's entries.
std::error_code SyncFolder(const std::filesystem::path& folder);

/// Gives `from`, a file, the name `to` unless that is taken; then the error is
/// `file_exists`.
std::error_code RenameToFree(const std::filesystem::path& from,
                             const std::filesystem::path& to);

/// Swaps two folders in one step. `operation_not_supported` where system or
/// file system cannot.
std::error_code ExchangeFolders(const std::filesystem::path& a,
                                const std::filesystem::path& b);

/// Opens what is closed of standard input, output and error, so that no file
/// of the program gets their numbers: writing to such an output fails.
void OccupyStandardStreams();

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_UNPUBLISHED_H_
