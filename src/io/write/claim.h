#ifndef HINDSIGHT_IO_WRITE_CLAIM_H_
#define HINDSIGHT_IO_WRITE_CLAIM_H_

#include <filesystem>
#include <optional>
#include <string>

#include "io/write/unpublished.h"

namespace hindsight {

/// The right of one worker, of many on many machines that share a folder, to
/// work on it: a file claim.N in that folder, touched again and again. A claim
/// that was not for `stale_after` is dead, by the clock of the file server
/// alone, which stamps the claim as well as what it is compared with; one of
/// this running system is dead as soon as its process is. A dead claim.N is
/// followed by claim.N+1, which the file system lets one worker create; the
/// former owner, should it wake up, finds that it was superseded.
class Claim {
 public:
  /// Claims `folder`, which exists, or nothing where another claim lives.
  /// `stale_after` in [s]. Throws OutputError where no file can be created.
  static std::optional<Claim> Take(const std::filesystem::path& folder,
                                   double stale_after);
  Claim(Claim&&) = default;
  Claim& operator=(Claim&&) = delete;
  /// Gives it back.
  ~Claim();

  /// What the owner of the claim that this one followed had noted last; "" if
  /// there was none or the medium lost it.
  const std::string& note_before() const { return note_before_; }
  /// Leaves a line for whoever follows, as far as the medium takes it; at first
  /// it is note_before().
  void Note(const std::string& line);

  /// Shows that its owner lives; false where another follows it already.
  bool Beat() const;

 private:
  Claim(std::filesystem::path folder, long number, Descriptor file)
      : folder_(std::move(folder)), number_(number), file_(std::move(file)) {}

  /// Whether the claim's name is that of its file still, and not of a later
  /// claim of the same number.
  bool IsNamed() const;

  std::filesystem::path folder_;
  long number_;
  Descriptor file_;
  std::string note_before_;
};

/// Time of the clock that stamps the files of `folder` [s since 1970]. Throws
/// OutputError.
double FileServerTime(const std::filesystem::path& folder);

/// Adds to a file, created if need be, as the standard output of another
/// process. Throws OutputError.
Descriptor OpenLog(const std::filesystem::path& file);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_WRITE_CLAIM_H_
