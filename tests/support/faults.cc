// A library to be preloaded (LD_PRELOAD) into the program under test, which
// lets one call to the system fail or kills the process there.
//   HINDSIGHT_FAULT=CALL:N:ACTION  the Nth CALL from 1, "N+" it and all later;
//                                  ACTION is a number of errno; before or
//                                  after: SIGKILL there; hang: for 20 s
//   HINDSIGHT_FAULT_LOG=FILE       gets a line for every call, and "fired"
//   HINDSIGHT_FAULT_NO_EXCHANGE=1  the file system cannot exchange names
//   HINDSIGHT_FAULT_PID=N          what getpid says
// CALL is open, close, write, fsync, mmap, mkdir, rename or renameat2.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace {

enum Call { kOpen, kClose, kWrite, kFsync, kMmap, kMkdir, kRename, kRenameat2 };
constexpr std::array<std::string_view, 8> kNames = {
    "open", "close", "write", "fsync", "mmap", "mkdir", "rename", "renameat2"};

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

/// What is to happen at this call, "" for nothing.
std::string_view Action(Call call) {
  const int cause = errno;
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
}
