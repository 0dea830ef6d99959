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

// What can go wrong with a device that stays plugged in.
enum class Fault {
  none,
  silent,        // sends nothing, answers no question, but hears
  frozen,        // the firmware hangs: sends nothing, hears nothing, the motors keep their torque
  deaf,          // hears nothing, but says where it is
  stuck,         // sends its newest report again and again
  garbage,       // random bytes
  cut_short,     // half of each report
  not_a_number,  // NaN, or where a format has none, numbers outside their range
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
  // What the host did against the protocol, a line each; the first hundred.
  const std::vector<std::string>& violations() const { return violations_; }

  // Plugged in or out. A device begins unplugged and forgets everything when unplugged.
  void power(bool on, Time now);
  bool powered() const { return powered_; }
  void set_fault(Fault fault) { fault_ = fault; }
  Fault fault() const { return fault_; }

  // The reports that are due now, for every period. A time before one already given counts as that.
  std::vector<Report> input(Time now);
  // The host sent a report.
  void output(ReportView report, Time now);
  // The host asks for a feature; nothing if there is no such.
  std::optional<Report> feature(std::uint8_t id, Time now);
  // The host sets a feature; false if there is no such.
  bool set_feature(ReportView report, Time now);
  // The host asks for an input report; nothing if there is no such.
  std::optional<Report> ask(std::uint8_t id, Time now);
  // How often a host has asked for a feature or set one.
  int features_used() const { return features_used_; }
  // Else the host waits for an answer in vain.
  bool answers() const { return powered_ && fault_ != Fault::silent && fault_ != Fault::frozen; }

 protected:
  ReferenceDevice(HidIdentity identity, Report descriptor, Time period)
      : identity_(std::move(identity)), descriptor_(std::move(descriptor)), period_(period) {}

  virtual void restart(Time now) = 0;  // as it is after it was plugged in
  virtual void run(Time now) = 0;      // its physics and timers until now
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
