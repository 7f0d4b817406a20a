#include "io/write/claim.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>
#include <utility>

#include "io/write/output_error.h"

namespace hindsight {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kName = "claim.";

fs::path ClaimPath(const fs::path& folder, long number) {
  return folder / (std::string(kName) + std::to_string(number));
}

/// Zero if there is none.
long Newest(const fs::path& folder) {
  long newest = 0;
  std::error_code refused;
  fs::directory_iterator entry(folder, refused);
  for (; !refused && entry != fs::directory_iterator();
       entry.increment(refused)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(kName)) continue;
    long number = 0;
    const char* end = name.data() + name.size();
    const auto read = std::from_chars(name.data() + kName.size(), end, number);
    if (read.ec == std::errc() && read.ptr == end) {
      newest = std::max(newest, number);
    }
  }
  if (refused) throw OutputError(folder, refused.message());
  return newest;
}

std::string ReadAll(int fd) {
  char text[512];
  const ssize_t count = pread(fd, text, sizeof text, 0);
  return {text, count > 0 ? static_cast<std::size_t>(count) : 0};
}

/// Says which start of which kernel this is, so that locks of one and the same
/// can be relied on.
const std::string& ThisSystem() {
  static const std::string id = [] {
    const Descriptor file(
        open("/proc/sys/kernel/random/boot_id", O_RDONLY | O_CLOEXEC));
    std::string text = file.IsOpen() ? ReadAll(file.get()) : "";
    return text.substr(0, text.find('\n'));
  }();
  return id;
}

double SecondsOf(const struct stat& status) {
  return static_cast<double>(status.st_mtim.tv_sec) +
         1e-9 * static_cast<double>(status.st_mtim.tv_nsec);
}

/// Whether the claim's owner has gone; what it noted.
bool IsDead(const fs::path& folder, long number, double stale_after,
            std::string* note) {
  // Opening it, other than asking for its times, has a network file system ask
  // its server.
  const Descriptor file(
      open(ClaimPath(folder, number).c_str(), O_RDWR | O_CLOEXEC));
  if (!file.IsOpen()) return false;
  const std::string text = ReadAll(file.get());
  const std::size_t end = text.find('\n');
  if (end != text.npos) {
    *note = text.substr(end + 1, text.find('\n', end + 1) - (end + 1));
    const bool is_of_this_system =
        !ThisSystem().empty() && text.substr(0, end) == ThisSystem();
    if (is_of_this_system && flock(file.get(), LOCK_EX | LOCK_NB) == 0) {
      return true;
    }
  }
  struct stat status = {};
  if (fstat(file.get(), &status) != 0) return false;
  // A time to come is that of an owner who died before the clock was set back.
  return std::abs(FileServerTime(folder) - SecondsOf(status)) > stale_after;
}

}  // namespace

double FileServerTime(const fs::path& folder) {
  std::error_code error;
  const Unpublished file = CreateUnpublishedFile(folder / "clock", &error);
  if (error) throw OutputError(folder / "clock", error.message());
  struct stat status = {};
  // The times of creation may be a client's; "now" is its server's.
  const bool known = futimens(file.descriptor.get(), nullptr) == 0 &&
                     fstat(file.descriptor.get(), &status) == 0;
  const int cause = errno;
  unlink(file.path.c_str());
  if (!known) throw OutputError(file.path, std::strerror(cause));
  return SecondsOf(status);
}

Descriptor OpenLog(const fs::path& file) {
  Descriptor log(open(
      file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666));
  if (!log.IsOpen()) throw OutputError(file, std::strerror(errno));
  return log;
}

std::optional<Claim> Claim::Take(const fs::path& folder, double stale_after) {
  const long newest = Newest(folder);
  std::string note;
  if (newest > 0 && !IsDead(folder, newest, stale_after, &note)) {
    return std::nullopt;
  }
  const fs::path path = ClaimPath(folder, newest + 1);
  Descriptor file(
      open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (!file.IsOpen()) {
    if (errno == EEXIST) return std::nullopt;
    throw OutputError(path, std::strerror(errno));
  }
  flock(file.get(), LOCK_EX | LOCK_NB);
  Claim claim(folder, newest + 1, std::move(file));
  claim.note_before_ = note;
  claim.Note(note);
  return claim;
}

Claim::~Claim() {
  if (!file_.IsOpen() || !IsNamed()) return;
  for (long number = 1; number <= number_; ++number) {
    unlink(ClaimPath(folder_, number).c_str());
  }
}

void Claim::Note(const std::string& line) {
  const std::string text = ThisSystem() + "\n" + line + "\n";
  const ssize_t written = pwrite(file_.get(), text.data(), text.size(), 0);
  // What a full disk cut off nobody may take for the whole.
  if (written != static_cast<ssize_t>(text.size()) &&
      ftruncate(file_.get(), 0) != 0) {
    unlink(ClaimPath(folder_, number_).c_str());
  }
}

bool Claim::IsNamed() const {
  struct stat mine = {};
  struct stat named = {};
  return fstat(file_.get(), &mine) == 0 &&
         lstat(ClaimPath(folder_, number_).c_str(), &named) == 0 &&
         mine.st_ino == named.st_ino;
}

bool Claim::Beat() const {
  struct stat next = {};
  return futimens(file_.get(), nullptr) == 0 && IsNamed() &&
         lstat(ClaimPath(folder_, number_ + 1).c_str(), &next) != 0;
}

}  // namespace hindsight
