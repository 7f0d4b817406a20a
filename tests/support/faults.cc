// A library to be preloaded (LD_PRELOAD) into the program under test, which
// lets one call to the system fail or kills the process there.
//   HINDSIGHT_FAULT=CALL:N:ACTION  the Nth CALL from 1, "N+" it and all later;
//                                  ACTION is a number of errno; before or
//                                  after: SIGKILL there; hang: for 20 s
//   HINDSIGHT_FAULT_LOG=FILE       gets a line for every call, and "fired"
//   HINDSIGHT_FAULT_NO_EXCHANGE=1  the file system cannot exchange names
//   HINDSIGHT_FAULT_ONLY=WORD      of processes whose first argument is WORD
//   HINDSIGHT_FAULT_PID=N          what getpid says
// CALL is one of kNames, which also stands for that function's 64-bit twin.
#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace {

enum Call {
  kOpen,
  kOpenat,
  kFopen,
  kFdopendir,
  kReaddir,
  kRead,
  kPread,
  kClose,
  kWrite,
  kWritev,
  kFsync,
  kFtruncate,
  kMmap,
  kMkdir,
  kRmdir,
  kUnlink,
  kUnlinkat,
  kRemove,
  kRename,
  kRenameat2,
  kLink,
  kFlock,
  kStat,
  kLstat,
  kFstat,
  kFstatat
};
constexpr std::array<std::string_view, 26> kNames = {
    "open",   "openat",    "fopen", "fdopendir", "readdir",  "read",
    "pread",  "close",     "write", "writev",    "fsync",    "ftruncate",
    "mmap",   "mkdir",     "rmdir", "unlink",    "unlinkat", "remove",
    "rename", "renameat2", "link",  "flock",     "stat",     "lstat",
    "fstat",  "fstatat"};

std::array<std::atomic<long>, kNames.size()> counts;

void Log(std::string_view word) {
  const char* path = getenv("HINDSIGHT_FAULT_LOG");
  if (path == nullptr) return;
  const long fd =
      syscall(SYS_open, path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (fd < 0) return;
  syscall(SYS_write, fd, word.data(), word.size());
  syscall(SYS_write, fd, "\n", 1UL);
  syscall(SYS_close, fd);
}

void Kill() { syscall(SYS_kill, syscall(SYS_getpid), SIGKILL); }

/// Whether this process is one that HINDSIGHT_FAULT_ONLY names.
bool IsMeant() {
  static const bool is_meant = [] {
    const char* word = getenv("HINDSIGHT_FAULT_ONLY");
    if (word == nullptr) return true;
    std::array<char, 256> line = {};
    const long fd = syscall(SYS_open, "/proc/self/cmdline", O_RDONLY, 0);
    syscall(SYS_read, fd, line.data(), line.size() - 1);
    syscall(SYS_close, fd);
    return strcmp(line.data() + strlen(line.data()) + 1, word) == 0;
  }();
  return is_meant;
}

/// What is to happen at this call, "" for nothing.
std::string_view Action(Call call) {
  const int cause = errno;
  if (!IsMeant()) return "";
  const long count = ++counts[call];
  Log(kNames[call]);
  errno = cause;
  const char* fault = getenv("HINDSIGHT_FAULT");
  if (fault == nullptr) return "";
  const std::string_view name = kNames[call];
  if (strncmp(fault, name.data(), name.size()) != 0 ||
      fault[name.size()] != ':') {
    return "";
  }
  char* end = nullptr;
  const long at = strtol(fault + name.size() + 1, &end, 10);
  const bool persistent = *end == '+';
  if (persistent) ++end;
  if (*end != ':' || (persistent ? count < at : count != at)) return "";
  Log("fired");
  errno = cause;
  return end + 1;
}

template <typename Do>
long Perform(Call call, const Do& act) {
  const std::string_view action = Action(call);
  if (action.empty()) return act();
  if (action == "before") Kill();
  if (action == "hang") {
    for (unsigned left = 20; left > 0;) left = sleep(left);
  }
  // A close that fails has closed.
  const bool acts = action == "after" || action == "hang" || call == kClose;
  const long result = acts ? act() : -1;
  if (action == "after") Kill();
  if (action == "hang") return result;
  errno = atoi(action.data());
  return -1;
}

/// The function of that name in the libraries after this one.
template <typename Function>
Function* Next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

template <typename Function, typename... Arguments>
long PerformNext(Call call, const char* name, Arguments... arguments) {
  Function* const next = Next<Function>(name);
  return Perform(call, [&] { return static_cast<long>(next(arguments...)); });
}

/// The same of a function that returns a pointer, null where it fails.
template <typename Result, typename... Arguments>
Result* PerformPointer(Call call, const char* name, Arguments... arguments) {
  using Function = Result*(Arguments...);
  Function* const next = Next<Function>(name);
  const long result =
      Perform(call, [&] { return reinterpret_cast<long>(next(arguments...)); });
  return result == -1 ? nullptr : reinterpret_cast<Result*>(result);
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return static_cast<int>(Perform(
      kOpen, [&] { return syscall(SYS_openat, AT_FDCWD, path, flags, mode); }));
}

int close(int fd) {
  return static_cast<int>(
      Perform(kClose, [&] { return syscall(SYS_close, fd); }));
}

ssize_t write(int fd, const void* data, size_t size) {
  return Perform(kWrite, [&] { return syscall(SYS_write, fd, data, size); });
}

int fsync(int fd) {
  return static_cast<int>(
      Perform(kFsync, [&] { return syscall(SYS_fsync, fd); }));
}

void* mmap(void* address, size_t length, int protection, int flags, int fd,
           off_t offset) {
  return reinterpret_cast<void*>(Perform(kMmap, [&] {
    return syscall(SYS_mmap, address, length, protection, flags, fd, offset);
  }));
}

int mkdir(const char* path, mode_t mode) {
  return static_cast<int>(Perform(
      kMkdir, [&] { return syscall(SYS_mkdirat, AT_FDCWD, path, mode); }));
}

int rename(const char* from, const char* to) {
  return static_cast<int>(Perform(kRename, [&] {
    return syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0);
  }));
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to,
              unsigned flags) {
  return static_cast<int>(Perform(kRenameat2, [&]() -> long {
    if (getenv("HINDSIGHT_FAULT_NO_EXCHANGE") != nullptr) {
      errno = EINVAL;
      return -1;
    }
    return syscall(SYS_renameat2, from_folder, from, to_folder, to, flags);
  }));
}

pid_t getpid() {
  const char* pid = getenv("HINDSIGHT_FAULT_PID");
  return pid != nullptr ? atoi(pid) : static_cast<pid_t>(syscall(SYS_getpid));
}

// Calls that are passed on: the twin of a name has the same arguments, its own
// types being those of this one on a 64-bit system.
#define PASS_ON(call, result, name, parameters, ...)               \
  result name parameters {                                         \
    return static_cast<result>(                                    \
        PerformNext<result parameters>(call, #name, __VA_ARGS__)); \
  }

PASS_ON(kRead, ssize_t, read, (int fd, void* data, size_t size), fd, data, size)
PASS_ON(kPread, ssize_t, pread, (int fd, void* data, size_t size, off_t at), fd,
        data, size, at)
PASS_ON(kPread, ssize_t, pread64, (int fd, void* data, size_t size, off64_t at),
        fd, data, size, at)
PASS_ON(kWritev, ssize_t, writev,
        (int fd, const struct iovec* parts, int count), fd, parts, count)
PASS_ON(kFtruncate, int, ftruncate, (int fd, off_t size), fd, size)
PASS_ON(kFtruncate, int, ftruncate64, (int fd, off64_t size), fd, size)
PASS_ON(kRmdir, int, rmdir, (const char* path), path)
PASS_ON(kUnlink, int, unlink, (const char* path), path)
PASS_ON(kUnlinkat, int, unlinkat, (int folder, const char* path, int flags),
        folder, path, flags)
PASS_ON(kRemove, int, remove, (const char* path), path)
PASS_ON(kLink, int, link, (const char* from, const char* to), from, to)
PASS_ON(kFlock, int, flock, (int fd, int operation), fd, operation)
PASS_ON(kStat, int, stat, (const char* path, struct stat* status), path, status)
PASS_ON(kStat, int, stat64, (const char* path, struct stat64* status), path,
        status)
PASS_ON(kLstat, int, lstat, (const char* path, struct stat* status), path,
        status)
PASS_ON(kLstat, int, lstat64, (const char* path, struct stat64* status), path,
        status)
PASS_ON(kFstat, int, fstat, (int fd, struct stat* status), fd, status)
PASS_ON(kFstat, int, fstat64, (int fd, struct stat64* status), fd, status)
PASS_ON(kFstatat, int, fstatat,
        (int folder, const char* path, struct stat* status, int flags), folder,
        path, status, flags)
PASS_ON(kFstatat, int, fstatat64,
        (int folder, const char* path, struct stat64* status, int flags),
        folder, path, status, flags)

int openat(int folder, const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return static_cast<int>(Perform(
      kOpenat, [&] { return syscall(SYS_openat, folder, path, flags, mode); }));
}

FILE* fopen(const char* path, const char* mode) {
  return PerformPointer<FILE>(kFopen, "fopen", path, mode);
}
FILE* fopen64(const char* path, const char* mode) {
  return PerformPointer<FILE>(kFopen, "fopen64", path, mode);
}
DIR* opendir(const char* path) {
  return PerformPointer<DIR>(kFdopendir, "opendir", path);
}
DIR* fdopendir(int fd) {
  return PerformPointer<DIR>(kFdopendir, "fdopendir", fd);
}
struct dirent* readdir(DIR* folder) {
  return PerformPointer<struct dirent>(kReaddir, "readdir", folder);
}
struct dirent64* readdir64(DIR* folder) {
  return PerformPointer<struct dirent64>(kReaddir, "readdir64", folder);
}
}
