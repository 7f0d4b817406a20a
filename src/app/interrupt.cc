#include "app/interrupt.h"

#include <semaphore.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <utility>

#include "app/command.h"
#include "app/error_line.h"

namespace hindsight {
namespace {

constexpr std::int64_t kSameRequest = 50'000'000;  // [ns]

std::atomic<bool> watched{false};
std::atomic<std::int64_t> first_signal{0};  // monotonic [ns]; 0: none yet
static_assert(std::atomic<bool>::is_always_lock_free &&
                  std::atomic<std::int64_t>::is_always_lock_free,
              "a signal handler may only touch lock-free atomics");
sem_t wake;

std::int64_t Now() {
  timespec time = {};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return std::int64_t{1'000'000'000} * time.tv_sec + time.tv_nsec;
}

void OnSignal(int) {
  if (!watched) _exit(kStopped);
  const int cause = errno;
  const std::int64_t now = Now();
  std::int64_t first = 0;
  if (first_signal.compare_exchange_strong(first, now)) {
    sem_post(&wake);
  } else if (now - first > kSameRequest) {
    _exit(kStopped);
  }
  errno = cause;
}

void WaitAndFinish(const std::function<std::string()>& finish) {
  while (sem_wait(&wake) != 0) continue;
  if (first_signal == 0) return;
  const std::string words = finish();
  // Nobody writes between this line and the end.
  flockfile(stderr);
  if (isatty(STDERR_FILENO) != 0) std::fputs("\r\033[K", stderr);
  PrintError(words);
  _exit(kStopped);
}

}  // namespace

void CatchSignals() {
  struct sigaction action = {};
  action.sa_handler = OnSignal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction old = {};
    sigaction(number, nullptr, &old);
    if (old.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);
  }
  std::signal(SIGXFSZ, SIG_IGN);
}

StopWatch::StopWatch(std::function<std::string()> finish) {
  std::signal(SIGPIPE, SIG_IGN);
  sem_init(&wake, 0, 0);
  thread_ = std::thread(WaitAndFinish, std::move(finish));
  watched = true;
}

StopWatch::~StopWatch() {
  watched = false;
  sem_post(&wake);
  thread_.join();
}

}  // namespace hindsight
