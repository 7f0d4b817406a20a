#include "io/write/unpublished.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <random>

namespace hindsight {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kRandomDigits = 12;
/// Names of files have at most 255 bytes.
constexpr std::size_t kLongestStem = 200;
constexpr int kAttempts = 100;
constexpr char kHexadecimal[] = "0123456789abcdef";

std::error_code SystemError(int number) {
  return {number, std::system_category()};
}

std::string Prefix(const fs::path& target) {
  return "." + target.filename().string().substr(0, kLongestStem) + ".partial-";
}

std::string RandomDigits() {
  std::random_device source;
  std::string digits;
  while (digits.size() < kRandomDigits) digits += kHexadecimal[source() % 16];
  return digits;
}

fs::path FolderOf(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

/// Locks a new entry unless somebody took it for abandoned before that.
bool TakeLock(const Unpublished& entry) {
  if (flock(entry.descriptor.get(), LOCK_EX | LOCK_NB) != 0) {
    return errno != EWOULDBLOCK;
  }
  struct stat mine = {};
  struct stat named = {};
  if (fstat(entry.descriptor.get(), &mine) != 0) return true;
  if (lstat(entry.path.c_str(), &named) != 0) return errno != ENOENT;
  return mine.st_ino == named.st_ino;
}

template <typename Create>
Unpublished CreateLocked(const fs::path& target, const Create& create,
                         std::error_code* error) {
  error->clear();
  for (int i = 0; i < kAttempts; ++i) {
    Unpublished entry{UnpublishedName(target), Descriptor()};
    entry.descriptor = Descriptor(create(entry.path.c_str()));
    if (!entry.descriptor.IsOpen()) {
      if (errno == EEXIST) continue;
      *error = SystemError(errno);
      return {};
    }
    if (TakeLock(entry)) return entry;
    // Empty still, and of no use to whoever holds it.
    std::remove(entry.path.c_str());
  }
  *error = SystemError(EEXIST);
  return {};
}

/// `operation_not_supported` where system or file system know no such flag.
std::error_code RenameBy(unsigned flag, const fs::path& a, const fs::path& b) {
  if (renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), flag) == 0) return {};
  if (errno == EINVAL || errno == ENOSYS || errno == EOPNOTSUPP) {
    return std::make_error_code(std::errc::operation_not_supported);
  }
  return SystemError(errno);
}

bool IsAbandoned(const fs::path& path) {
  const Descriptor entry(
      open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  return entry.IsOpen() && flock(entry.get(), LOCK_EX | LOCK_NB) == 0;
}

}  // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

Descriptor::~Descriptor() {
  if (fd_ >= 0) close(fd_);
}

std::optional<fs::path> PresentPath(const Unpublished& entry) {
  struct stat mine = {};
  if (fstat(entry.descriptor.get(), &mine) != 0) return std::nullopt;
  const auto names_it = [&mine](const fs::path& path) {
    struct stat named = {};
    return lstat(path.c_str(), &named) == 0 && named.st_ino == mine.st_ino &&
           named.st_dev == mine.st_dev;
  };
  if (names_it(entry.path)) return entry.path;
  std::error_code refused;
  const fs::path moved = fs::read_symlink(
      "/proc/self/fd/" + std::to_string(entry.descriptor.get()), refused);
  if (refused || !names_it(moved)) return std::nullopt;
  return moved;
}

fs::path UnpublishedName(const fs::path& target) {
  return target.parent_path() / (Prefix(target) + RandomDigits());
}

bool IsUnpublishedName(const std::string& name, const fs::path& target) {
  const std::string prefix = Prefix(target);
  return name.size() == prefix.size() + kRandomDigits &&
         name.starts_with(prefix) &&
         name.find_first_not_of(kHexadecimal, prefix.size()) == name.npos;
}

Unpublished CreateUnpublishedFile(const fs::path& target,
                                  std::error_code* error) {
  return CreateLocked(
      target,
      [](const char* path) {
        return open(path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      },
      error);
}

Unpublished CreateUnpublishedFolder(const fs::path& target,
                                    std::error_code* error) {
  return CreateLocked(
      target,
      [](const char* path) {
        if (mkdir(path, 0777) != 0) return -1;
        const int fd = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        const int cause = errno;
        if (fd < 0) rmdir(path);
        errno = cause;
        return fd;
      },
      error);
}

Descriptor HoldFolder(const fs::path& folder) {
  return Descriptor(
      open(folder.c_str(), O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
}

std::vector<fs::path> FindAbandoned(const fs::path& target) {
  std::vector<fs::path> found;
  std::error_code refused;
  fs::directory_iterator entry(FolderOf(target), refused);
  for (; !refused && entry != fs::directory_iterator();
       entry.increment(refused)) {
    if (IsUnpublishedName(entry->path().filename().string(), target) &&
        IsAbandoned(entry->path())) {
      found.push_back(entry->path());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::error_code SyncFolder(const fs::path& folder) {
  const Descriptor descriptor(open(folder.empty() ? "." : folder.c_str(),
                                   O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!descriptor.IsOpen()) return SystemError(errno);
  // Some network file systems know no such request of a folder.
  if (fsync(descriptor.get()) != 0 && errno != EINVAL) {
    return SystemError(errno);
  }
  return {};
}

std::error_code RenameToFree(const fs::path& from, const fs::path& to) {
  const std::error_code error = RenameBy(RENAME_NOREPLACE, from, to);
  if (error != std::errc::operation_not_supported) return error;
  if (link(from.c_str(), to.c_str()) != 0) return SystemError(errno);
  unlink(from.c_str());
  return {};
}

std::error_code ExchangeFolders(const fs::path& a, const fs::path& b) {
  return RenameBy(RENAME_EXCHANGE, a, b);
}

void OccupyStandardStreams() {
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(fd, F_GETFD) != -1) continue;
    // The lowest free number is this one. Only standard error takes what is
    // written, so that a lost result is noticed and a lost message is not.
    open("/dev/null", fd == STDERR_FILENO ? O_WRONLY : O_RDONLY);
  }
}

}  // namespace hindsight
