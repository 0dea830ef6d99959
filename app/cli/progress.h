// How far a piece of work is, on a terminal.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace limpid {

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
    std::function<std::vector<std::string>()> picture = {};  // lines above it, any time
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
