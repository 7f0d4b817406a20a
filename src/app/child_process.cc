#include "app/child_process.h"

#include <poll.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>

#include "base/error.h"
#include "io/write/claim.h"

namespace hindsight {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kGrace = 10.0;  // [s] from SIGTERM to SIGKILL

std::vector<char*> Pointers(std::vector<std::string>* words) {
  std::vector<char*> pointers;
  for (std::string& word : *words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

double SecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Whether the process ends within so many seconds.
bool EndsWithin(const Descriptor& process, double seconds) {
  constexpr double kLongest = 3600.0;  // [s] what poll surely takes
  const Clock::time_point begin = Clock::now();
  while (true) {
    const double left = seconds - SecondsSince(begin);
    pollfd entry = {process.get(), POLLIN, 0};
    const double wait = std::clamp(left, 0.0, kLongest);
    if (poll(&entry, 1, static_cast<int>(std::ceil(1e3 * wait))) > 0) {
      return true;
    }
    if (left <= 0.0) return false;
  }
}

/// In the child, between fork and exec: nothing that takes memory.
[[noreturn]] void Become(char* const* words, int log, pid_t parent,
                         rlim_t memory) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);
  if (memory != RLIM_INFINITY) {
    const rlimit limit = {memory, memory};
    setrlimit(RLIMIT_DATA, &limit);
  }
  std::signal(SIGPIPE, SIG_DFL);
  close(STDIN_FILENO);
  if (dup2(log, STDOUT_FILENO) >= 0 && dup2(log, STDERR_FILENO) >= 0) {
    execv("/proc/self/exe", words);
  }
  _exit(127);
}

ChildEnd EndOf(pid_t process, double seconds, bool over_time) {
  int raw = 0;
  rusage usage = {};
  while (wait4(process, &raw, 0, &usage) < 0 && errno == EINTR) continue;
  return {.status = WIFEXITED(raw) ? WEXITSTATUS(raw) : 0,
          .signal = WIFSIGNALED(raw) ? WTERMSIG(raw) : 0,
          .over_time = over_time,
          .seconds = seconds,
          .megabytes = static_cast<double>(usage.ru_maxrss) / 1024.0};
}

}  // namespace

// posix_spawn knows neither limits nor a signal for the parent's death.
pid_t Children::Start(std::vector<std::string> words, int log,
                      const ChildLimits& limits) {
  words.insert(words.begin(), "hindsight");
  const std::vector<char*> pointers = Pointers(&words);
  const rlim_t memory =
      std::isfinite(limits.megabytes)
          ? static_cast<rlim_t>(std::ceil(1048576.0 * limits.megabytes))
          : RLIM_INFINITY;
  const pid_t parent = getpid();
  const std::lock_guard lock(mutex_);
  const pid_t process = fork();
  if (process < 0) {
    throw EstimationError(std::string("no process can be started: ") +
                          std::strerror(errno));
  }
  if (process == 0) Become(pointers.data(), log, parent, memory);
  if (stopped_) kill(process, SIGTERM);
  running_.insert(process);
  return process;
}

ChildEnd Children::Run(std::vector<std::string> words,
                       const std::filesystem::path& log,
                       const ChildLimits& limits) {
  const Descriptor output = OpenLog(log);
  const Clock::time_point begin = Clock::now();
  const pid_t process = Start(std::move(words), output.get(), limits);
  // glibc 2.36 declares its function as one of C++ only.
  const Descriptor watched(
      static_cast<int>(syscall(SYS_pidfd_open, process, 0)));
  const bool over_time =
      watched.IsOpen() && !EndsWithin(watched, limits.seconds);
  if (over_time) {
    kill(process, SIGTERM);
    if (!EndsWithin(watched, kGrace)) kill(process, SIGKILL);
  }
  siginfo_t ended = {};
  while (waitid(P_PID, static_cast<id_t>(process), &ended, WEXITED | WNOWAIT) !=
             0 &&
         errno == EINTR) {
  }
  // Until it is waited for, its number is nobody else's.
  const std::lock_guard lock(mutex_);
  running_.erase(process);
  return EndOf(process, SecondsSince(begin), over_time);
}

void Children::Stop() {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
  for (const pid_t process : running_) kill(process, SIGTERM);
}

bool Children::stopped() const {
  const std::lock_guard lock(mutex_);
  return stopped_;
}

ProgramOutput RunProgram(std::vector<std::string> words) {
  constexpr std::size_t kMost = 1 << 20;
  std::array<int, 2> ends = {-1, -1};
  if (pipe(ends.data()) != 0) return {};
  const Descriptor from(ends[0]);
  Descriptor to(ends[1]);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, to.get(), STDOUT_FILENO);
  posix_spawn_file_actions_addclose(&actions, from.get());
  const std::vector<char*> pointers = Pointers(&words);
  pid_t process = -1;
  const int refused = posix_spawnp(&process, pointers[0], &actions, nullptr,
                                   pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  to = Descriptor();
  if (refused != 0) return {};
  ProgramOutput output = {.found = true, .succeeded = false, .text = ""};
  std::array<char, 4096> piece = {};
  ssize_t count = 0;
  while ((count = read(from.get(), piece.data(), piece.size())) > 0) {
    if (output.text.size() < kMost) {
      output.text.append(piece.data(), static_cast<std::size_t>(count));
    }
  }
  const ChildEnd end = EndOf(process, 0.0, false);
  output.succeeded = end.status == 0 && end.signal == 0;
  return output;
}

}  // namespace hindsight
