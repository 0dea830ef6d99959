// Tasks: work beside the window.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>

namespace limpid {

// A thread that does tasks one after the other; they may take their time. The thread, and threads
// that tasks start, are scheduled as the queue's maker was then, not as whoever asks for a task:
// the window may have stepped behind all others by that time.
class TaskQueue {
 public:
  TaskQueue() : thread_([this] { live(); }) {}
  ~TaskQueue() {  // waits for all tasks
    {
      const std::lock_guard lock(mutex_);
      quit_ = true;
    }
    changed_.notify_one();
    thread_.join();
  }
  TaskQueue(const TaskQueue&) = delete;
  TaskQueue& operator=(const TaskQueue&) = delete;

  // Asks for a task. The future gets the result, or the exception. Dropping the future does not
  // wait.
  template <class Work>
  auto run(Work work) -> std::future<std::invoke_result_t<Work&>> {
    using Result = std::invoke_result_t<Work&>;
    auto task = std::make_shared<std::packaged_task<Result()>>(std::move(work));
    std::future<Result> result = task->get_future();
    {
      const std::lock_guard lock(mutex_);
      waiting_.push_back([task] { (*task)(); });
    }
    changed_.notify_one();
    return result;
  }

 private:
  void live() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return quit_ || !waiting_.empty(); });
      if (waiting_.empty()) return;
      std::function<void()> work = std::move(waiting_.front());
      waiting_.pop_front();
      lock.unlock();
      work();
      work = nullptr;  // frees what it held, too
      lock.lock();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  bool quit_ = false;
  std::thread thread_;
};

// Returns the result of a queue's task, once, when it is there; throws what the task threw.
template <class Result>
std::optional<Result> take_ready(std::future<Result>& result) {
  if (!result.valid() || result.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    return std::nullopt;
  }
  std::future<Result> ready = std::move(result);
  return ready.get();
}

struct TaskProgress {
  std::atomic<double> part{0};      // 0 to 1
  std::atomic<bool> cancel{false};  // asked for by the window
};

// Long work whose progress the window shows; one at a time, and it can be cancelled.
template <class Result>
class Task {
 public:
  using Work = std::function<Result(TaskProgress&)>;

  ~Task() { cancel(); }

  bool busy() const { return thread_.joinable(); }
  const std::string& what() const { return what_; }
  double part() const { return progress_.part.load(); }
  double seconds() const {  // since it was started
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  }

  // Starts work; cancels running work first.
  void start(std::string what, Work work) {
    cancel();
    what_ = std::move(what);
    progress_.part = 0;
    progress_.cancel = false;
    done_ = false;
    started_ = std::chrono::steady_clock::now();
    thread_ = std::thread([this, work = std::move(work)] {
      try {
        result_ = work(progress_);
      } catch (...) {
        failure_ = std::current_exception();
      }
      done_.store(true, std::memory_order_release);
    });
  }

  // Asks the work to stop, without waiting: take() throws what the work then throws, or gives what
  // it still returns.
  void ask_to_stop() { progress_.cancel = true; }

  void cancel() {
    if (!busy()) return;
    progress_.cancel = true;
    thread_.join();
    result_.reset();
    failure_ = nullptr;
  }

  // Returns the result, once, when it is there; throws what the work threw.
  std::optional<Result> take() {
    if (!busy() || !done_.load(std::memory_order_acquire)) return std::nullopt;
    thread_.join();
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    return std::exchange(result_, std::nullopt);
  }

 private:
  std::string what_;
  std::chrono::steady_clock::time_point started_;
  TaskProgress progress_;
  std::atomic<bool> done_{false};
  std::optional<Result> result_;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace limpid
