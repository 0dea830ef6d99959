// A HID device as its firmware sees itself, free of any transport: plays through the kernel
// (uhid_device.h) or in the test's own process, in real or in simulated time. Written from the
// protocols alone, so that it checks the code under test instead of sharing its mistakes.
//
// Reports as hidapi has them: what the host sends and all features begin with the report's id,
// 0 where there is none; input reports begin with their id only where there is one.
#pragma once

#include <algorithm>
#include <optional>
#include <random>
#include <string>

#include "tests/support/hid/force_log.h"
#include "tests/support/hid/report_bits.h"

namespace limpid::test {

struct HidIdentity {
  std::string name;
  std::uint16_t vendor = 0, product = 0;
  std::string serial;
};

// Faults of a device that stays plugged in.
enum class Fault {
  none,
  silent,        // sends nothing, answers no question, but receives
  frozen,        // the firmware hangs: neither sends nor receives, the motors keep their torque
  deaf,          // receives nothing, but sends its position
  stuck,         // sends its newest report again and again
  garbage,       // random bytes
  cut_short,     // half of each report
  not_a_number,  // NaN, or in formats without it numbers outside their range
};

class ReferenceDevice {
 public:
  virtual ~ReferenceDevice() = default;
  ReferenceDevice(const ReferenceDevice&) = delete;
  ReferenceDevice& operator=(const ReferenceDevice&) = delete;

  const HidIdentity& identity() const { return identity_; }
  const Report& report_descriptor() const { return descriptor_; }
  Time period() const { return period_; }  // between two calls of input()
  const ForceLog& forces() const { return forces_; }
  ForceLog& forces() { return forces_; }
  // Violations of the protocol by the host, the first hundred, one line each.
  const std::vector<std::string>& violations() const { return violations_; }

  // Plugs the device in or out. It begins unplugged and forgets everything when unplugged.
  void power(bool on, Time now);
  bool powered() const { return powered_; }
  void set_fault(Fault fault) { fault_ = fault; }
  Fault fault() const { return fault_; }

  // Returns the reports that are due now, for every period. A time before an earlier call's counts
  // as that one's.
  std::vector<Report> input(Time now);
  // The host sent a report.
  void output(ReportView report, Time now);
  // The host asks for a feature; nothing if it does not exist.
  std::optional<Report> feature(std::uint8_t id, Time now);
  // The host sets a feature; false if it does not exist.
  bool set_feature(ReportView report, Time now);
  // The host asks for an input report; nothing if it does not exist.
  std::optional<Report> ask(std::uint8_t id, Time now);
  // Number of features that a host has read or set.
  int features_used() const { return features_used_; }
  // Whether the device answers; if not, the host waits in vain.
  bool answers() const { return powered_ && fault_ != Fault::silent && fault_ != Fault::frozen; }

 protected:
  ReferenceDevice(HidIdentity identity, Report descriptor, Time period)
      : identity_(std::move(identity)), descriptor_(std::move(descriptor)), period_(period) {}

  virtual void restart(Time now) = 0;  // to its state after plugging in
  virtual void run(Time now) = 0;      // advances its physics and timers to `now`
  virtual std::vector<Report> next_input(Time now) = 0;
  virtual void on_output(ReportView report, Time now) = 0;
  virtual std::optional<Report> on_get_feature(std::uint8_t id) = 0;
  virtual bool on_set_feature(ReportView report, Time now) = 0;
  virtual std::optional<Report> on_ask(std::uint8_t) { return std::nullopt; }

  void violation(std::string what) {
    if (violations_.size() < 100) violations_.push_back(std::move(what));
  }

 private:
  Time forward(Time now) { return newest_time_ = std::max(now, newest_time_); }
  void spoil(std::vector<Report>& reports);

  HidIdentity identity_;
  Report descriptor_;
  Time period_;
  ForceLog forces_;
  std::vector<std::string> violations_;
  bool powered_ = false;
  int features_used_ = 0;
  Fault fault_ = Fault::none;
  std::vector<Report> newest_;
  Time newest_time_ = Time::min();
  std::mt19937 random_{20240101};
};

}  // namespace limpid::test
