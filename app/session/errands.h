// Work that may take its time, done one after the other by a thread of its own.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <type_traits>
#include <utility>

namespace limpid {

// Its thread, and threads that errands start, are scheduled as whoever made it was then, not as
// whoever asks for the errand: the window may have stepped behind all others by that time.
class Errands {
 public:
  Errands() : thread_([this] { live(); }) {}
  ~Errands() {  // after all that was asked for
    {
      const std::lock_guard lock(mutex_);
      quit_ = true;
    }
    changed_.notify_one();
    thread_.join();
  }
  Errands(const Errands&) = delete;
  Errands& operator=(const Errands&) = delete;

  // The result, or what was thrown, is in the future. Dropping the future does not wait.
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
      work = nullptr;  // and what it held
      lock.lock();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  bool quit_ = false;
  std::thread thread_;
};

// What came of an errand, once, when it is there; throws what the errand threw.
template <class Result>
std::optional<Result> take_ready(std::future<Result>& result) {
  if (!result.valid() || result.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    return std::nullopt;
  }
  std::future<Result> ready = std::move(result);
  return ready.get();
}

}  // namespace limpid
