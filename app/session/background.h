// Long work beside the window: one thing at a time, with progress, and it can be cancelled.
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <utility>

namespace limpid {

struct BackgroundProgress {
  std::atomic<double> part{0};      // 0 to 1
  std::atomic<bool> cancel{false};  // asked for by the window
};

template <class Result>
class Background {
 public:
  using Work = std::function<Result(BackgroundProgress&)>;

  ~Background() { cancel(); }

  bool busy() const { return thread_.joinable(); }
  const std::string& what() const { return what_; }
  double part() const { return progress_.part.load(); }
  double seconds() const {  // since it was started
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  }

  // Ends what was running.
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

  // Does not wait: take() throws what the work then throws, or gives what it still returns.
  void ask_to_stop() { progress_.cancel = true; }

  void cancel() {
    if (!busy()) return;
    progress_.cancel = true;
    thread_.join();
    result_.reset();
    failure_ = nullptr;
  }

  // The result, once, when it is there; throws what the work threw.
  std::optional<Result> take() {
    if (!busy() || !done_.load(std::memory_order_acquire)) return std::nullopt;
    thread_.join();
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    return std::exchange(result_, std::nullopt);
  }

 private:
  std::string what_;
  std::chrono::steady_clock::time_point started_;
  BackgroundProgress progress_;
  std::atomic<bool> done_{false};
  std::optional<Result> result_;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace limpid
