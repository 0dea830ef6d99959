// Plays a reference device to the kernel through /dev/uhid: its own thread sends the reports at
// absolute deadlines and answers the host as a device on the bus does.
#pragma once

#include <atomic>
#include <filesystem>
#include <mutex>
#include <thread>

#include "tests/support/hid/reference_device.h"

namespace limpid::test {

struct UhidCounts {
  int sent = 0;    // reports
  int missed = 0;  // periods without a report, as the thread came too late
  Time latest{};   // the longest delay of a report after its deadline
  int opened = 0;  // number of times a program opened it
};

// Time of reports and logs, from the steady clock.
Time steady_now();

class UhidDevice {
 public:
  // Plugs the model in and returns when the kernel has it. From then on the model belongs to the
  // thread: use it through with(). Throws std::system_error if there is no /dev/uhid.
  explicit UhidDevice(ReferenceDevice& model);
  ~UhidDevice();
  UhidDevice(const UhidDevice&) = delete;
  UhidDevice& operator=(const UhidDevice&) = delete;

  void unplug();
  void replug();

  // Calls use(now) between two reports and returns what it returns.
  template <class Use>
  auto with(Use use) {
    const std::lock_guard lock(mutex_);
    return use(steady_now());
  }
  UhidCounts counts() {
    return with([&](Time) { return counts_; });
  }
  // Path of its /dev/hidrawN; empty if the kernel has none for it (yet).
  std::filesystem::path path() const;

 private:
  void play();
  void plug();
  void handle_event();
  void send_reports(Time deadline);
  void wait_for_path() const;

  ReferenceDevice& model_;
  int file_ = -1;
  std::mutex mutex_;
  UhidCounts counts_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace limpid::test
