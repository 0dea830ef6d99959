// Measures the speed of the program's parts here, in times, ratios and instructions.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace limpid::bench {

// Times of many runs of the same thing, and their quantiles.
class Samples {
 public:
  explicit Samples(std::size_t expected) { values_.reserve(expected); }

  // Runs `work` once and keeps how long it took [us].
  template <class Work>
  void time(Work&& work) {
    const auto began = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - began;
    add(took.count());
  }
  void add(double value) { values_.push_back(value); }

  // Value that a share of all values stays below: 0.5 the median, 1 the largest. Precondition:
  // there are values.
  double quantile(double share) const;

 private:
  std::vector<double> values_;
};

// Counts the instructions of the calling thread, where processor and system allow it.
class InstructionCounter {
 public:
  InstructionCounter();
  InstructionCounter(const InstructionCounter&) = delete;
  InstructionCounter& operator=(const InstructionCounter&) = delete;
  ~InstructionCounter();

  bool counts() const { return file_ >= 0; }
  // Counts the instructions of `work`, without those of the system.
  template <class Work>
  void count(Work&& work) {
    start();
    work();
    stop();
  }
  // Instructions so far; nothing if they cannot be counted.
  std::optional<std::uint64_t> total() const;

 private:
  void start() const;
  void stop() const;

  int file_;
};

// Figures of one measured thing.
struct Line {
  std::string id;    // "tick/3/proposed": for scripts; stays the same from version to version
  std::string what;  // for people
  std::string unit;  // of the figures: "us", or "us a tick"
  double median = 0, p99 = 0, p999 = 0, largest = 0;
  std::string of = {};                      // id of the line that `ratio` refers to, if any
  std::optional<double> ratio = {};         // of the medians [-]
  std::optional<double> instructions = {};  // of each run; nothing if they cannot be counted
  std::optional<double> real_time = {};  // of a recorded run: how many times faster than life [-]
};

struct Machine {
  std::string processor;  // by its own name
  int processors = 0;
  std::string kernel;
  std::string compiler;
  std::string threads;  // what the system grants the haptic thread
  bool counts = false;  // whether instructions can be counted
};
Machine this_machine();

struct Report {
  std::string program;  // its version
  std::string date;     // of the measurement, UTC: 2026-01-31T12:00:00Z
  Machine machine = {};
  double share = 1;  // of a processor for the measuring thread; below 0.95 others were busy
  std::vector<Line> lines = {};
};

struct Wishes {
  int ticks = 20000;      // of each kind of tick
  std::string only = {};  // this id, or those below it: "tick", "tick/3"; empty: all
};

// Measures until it is interrupted; `done` receives the share done and the next id. Errors:
// std::invalid_argument if nothing matches `only`, std::runtime_error if a file cannot be written.
Report measure(const Wishes& wishes, const std::function<void(double, const std::string&)>& done);

// The report as a table, and as a JSON object.
std::string text_of(const Report& report);
std::string json_of(const Report& report);

// A line of the table, and its head, for other tables like it.
std::string table_head();
std::string table_line(const Line& line);
// A line of `times`, with their ratio to `yardstick`, if any.
Line line_of(std::string id, std::string what, const Samples& times,
             const Line* yardstick = nullptr);

}  // namespace limpid::bench
