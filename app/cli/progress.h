// Commands at a terminal: questions, and a line of progress.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>

namespace limpid {

// Prints the prompt and waits for Enter, ignoring earlier input. Calls `meanwhile` until then,
// which also paces the loop. False if `meanwhile` returns false. Errors: UsageError at the end of
// input.
bool await_enter(const std::string& prompt, const std::function<bool()>& meanwhile);

// Progress in a line on standard error, rewritten in place: "run: 41 %, 12.3 of 30.0 s, 85 times
// real time, 4 s left". Shown only on a terminal and after a second of work, removed at the end.
// Printed by its own thread, so that no work waits for a terminal.
class Progress {
 public:
  struct Words {
    std::string title;   // "run"
    double whole = 100;  // at() at the end
    std::string unit;    // of done and whole, "s"; empty: these are not printed
    std::string rate;    // name of units a second: "times real time"
  };
  explicit Progress(Words words);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Sets the work done; from any thread. A smaller value starts the clock anew.
  void at(double done) { done_.store(done, std::memory_order_relaxed); }

 private:
  void show(const std::stop_token& stop) const;

  Words words_;
  std::atomic<double> done_{0};
  std::jthread thread_;
};

// The line `seconds` after the work began.
std::string progress_line(const Progress::Words& words, double done, double seconds);
// A rate of at least 0.1 in two digits, or more before the point.
std::string rate_text(double rate);

}  // namespace limpid
