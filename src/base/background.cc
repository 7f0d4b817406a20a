#include "base/background.h"

#include <pthread.h>

#include <system_error>
#include <thread>
#include <vector>

namespace hindsight {

/// A thread that waits for its next task when one has ended. It is never joined: as
/// the process ends it may be at work still.
class BackgroundTask::Worker {
 public:
  static void Give(std::shared_ptr<BackgroundTask> task) {
    static const int registered =
        pthread_atfork(&LockForFork, &UnlockAfterFork, &BeginInChild);
    if (registered != 0) {
      throw std::system_error(registered, std::generic_category());
    }
    std::unique_lock<std::mutex> lock(Mutex());
    if (Idle().empty()) {
      lock.unlock();
      std::thread(&Worker::Run, std::move(task)).detach();
      return;
    }
    Worker* const worker = Idle().back();
    Idle().pop_back();
    worker->task_ = std::move(task);
    lock.unlock();
    worker->given_.notify_one();
  }

 private:
  // Of those that outlive what is static.
  static std::mutex& Mutex() {
    static auto* const mutex = new std::mutex;
    return *mutex;
  }
  /// The last to have become idle goes first: its stack is in the cache.
  static std::vector<Worker*>& Idle() {
    static auto* const idle = new std::vector<Worker*>;
    return *idle;
  }

  static void LockForFork() { Mutex().lock(); }
  static void UnlockAfterFork() { Mutex().unlock(); }
  /// A process that was forked has the memory of the idle, but not the threads.
  static void BeginInChild() {
    Idle().clear();
    Mutex().unlock();
  }

  static void Run(std::shared_ptr<BackgroundTask> task) {
    Worker self;
    while (true) {
      task->Do();
      // Idle before the task counts as done: who waits for it may start the next.
      std::unique_lock<std::mutex> lock(Mutex());
      Idle().push_back(&self);
      lock.unlock();
      Finish(std::move(task));
      lock.lock();
      self.given_.wait(lock, [&self] { return self.task_ != nullptr; });
      task = std::move(self.task_);
    }
  }
  static void Finish(std::shared_ptr<BackgroundTask> task) {
    const std::lock_guard<std::mutex> guard(task->mutex_);
    task->is_done_ = true;
    task->changed_.notify_all();
  }

  std::condition_variable given_;
  std::shared_ptr<BackgroundTask> task_;
};

void BackgroundTask::Start(std::shared_ptr<BackgroundTask> task) {
  Worker::Give(std::move(task));
}

void BackgroundTask::Wait() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return is_done_; });
}

}  // namespace hindsight
