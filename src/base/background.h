#ifndef HINDSIGHT_BASE_BACKGROUND_H_
#define HINDSIGHT_BASE_BACKGROUND_H_

#include <condition_variable>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <type_traits>
#include <utility>

namespace hindsight {

/// What another thread does, and whether it has been done.
class BackgroundTask {
 public:
  virtual ~BackgroundTask() = default;

  /// Has a thread do it at once that nothing else uses meanwhile: one whose work has
  /// ended, or else a new one. Throws std::system_error if there can be none.
  static void Start(std::shared_ptr<BackgroundTask> task);
  /// Until it has been done, and what it holds to do it is gone.
  void Wait();

 private:
  class Worker;

  /// Throws nothing.
  virtual void Do() = 0;

  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_done_ = false;
};

/// Work that another thread does. Its call waits for what that returns or throws,
/// its destructor for its end.
template <typename Work>
class BackgroundWork {
 public:
  using Result = std::invoke_result_t<Work&>;

  explicit BackgroundWork(Work work)
      : task_(std::make_shared<Task>(std::move(work))) {
    BackgroundTask::Start(task_);
  }
  BackgroundWork(BackgroundWork&&) noexcept = default;
  BackgroundWork& operator=(BackgroundWork&&) = delete;
  ~BackgroundWork() {
    if (task_ != nullptr) task_->Wait();
  }

  Result operator()() {
    task_->Wait();
    return task_->result.get();
  }

 private:
  struct Task final : BackgroundTask {
    explicit Task(Work of) : work(std::in_place, std::move(of)) {}
    void Do() override {
      std::packaged_task<Result()> run(std::ref(*work));
      result = run.get_future();
      run();
      work.reset();
    }
    std::optional<Work> work;
    std::future<Result> result;
  };

  std::shared_ptr<Task> task_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_BACKGROUND_H_
