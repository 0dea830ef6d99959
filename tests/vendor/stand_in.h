// Stand-ins for makers' libraries: a virtual arm in real time, a record of what its motors hold,
// and faults on order. They have the same names of functions; nothing of a maker is in them.
//
// LIMPID_STAND_IN orders faults, "NAME[:VALUE][@MS],...": MS is the time after the device was
// opened. "sway:NEWTON" is no fault, but a hand that moves the tip to and fro.
//
// LIMPID_STAND_IN_RECORD names a file that keeps each change of the motors' force, also
// when the process is killed: a count of 8 bytes, then entries of 40: time [ns], force [N] in the
// library's own axes, and 1 if the motors are on.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>

namespace limpid::stand_in {

using Three = std::array<double, 3>;

std::int64_t now();  // CLOCK_MONOTONIC [ns]

class Faults {
 public:
  Faults();
  // Begins the time after which faults come.
  void start() { start_ = now(); }
  // Whether a fault is ordered, and its time has come.
  bool due(const char* name) const;
  // The same, and true but once.
  bool due_once(const char* name);
  double value(const char* name, double otherwise) const;

 private:
  struct Fault {
    double value = -1;
    std::int64_t after = 0;  // [ns]
    bool done = false;
  };
  std::map<std::string, Fault> faults_;
  std::int64_t start_ = 0;
};

// The virtual arm: a mass at the tip, held by a spring and a damper, pushed by its motors.
class Arm {
 public:
  Arm();
  Three place();  // [m], in the library's axes
  // The motors hold this force from now on [N].
  void hold(const Three& force, bool on);

 private:
  void move();
  void record(const Three& force, bool on);

  struct Entry {
    std::int64_t time;
    Three force;
    std::int64_t on;
  };
  static constexpr std::size_t kMost = 100'000;
  struct Record {
    std::int64_t count;
    std::array<Entry, kMost> entries;
  };

  std::mutex mutex_;
  Record* record_ = nullptr;
  Three x_{}, v_{}, force_{};
  bool on_ = false, any_ = false;
  double sway_ = 0, time_ = 0;  // of a hand that moves the tip to and fro [N, s]
  std::int64_t moved_ = 0;
};

void wait_for_ever();
void sleep_ms(double ms);

}  // namespace limpid::stand_in
