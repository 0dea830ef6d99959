// How far a piece of work is, on a terminal.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>

namespace limpid {

// A folder for what a command finds.

// Before any work, so that none is lost on a place that cannot be written or is full: the folder is
// there then. Errors: UsageError.
void prepare_out(const std::filesystem::path& dir);

// Questions in a terminal before something moves or pushes.

// Says the prompt and waits for Enter; what was typed before is no answer to it. `meanwhile` is
// called all along and takes the time between two looks. False once that says false. Errors:
// UsageError at the end of what can be typed.
bool await_enter(const std::string& prompt, const std::function<bool()>& meanwhile);

// One line on standard error, rewritten in place: "run: 41 %, 12.3 of 30.0 s, 85 times real time,
// 4 s left". Only where that is a terminal, only once the work takes over a second; gone when the
// work is over. Printed by a thread of its own, so that no work waits for a terminal.
class Progress {
 public:
  struct Words {
    std::string title;   // "run"
    double whole = 100;  // what at() comes to in the end
    std::string unit;    // of it, where done and whole are worth saying: "s"; else empty
    std::string rate;    // what it is called a second: "times real time"
  };
  explicit Progress(Words words);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // From any thread; going back begins anew.
  void at(double done) { done_.store(done, std::memory_order_relaxed); }

 private:
  void show(const std::stop_token& stop) const;

  Words words_;
  std::atomic<double> done_{0};
  std::jthread thread_;
};

// That line, `seconds` after the work began at nothing done.
std::string progress_line(const Progress::Words& words, double done, double seconds);

}  // namespace limpid
