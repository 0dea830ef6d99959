// Takes the force away when this process is killed.
//
// A child process that does nothing but wait for the end of the thread that made it. However that
// thread ends, the kernel lets go of the lock it holds; the guardian then writes the stop reports
// to the device and ends too. It learns of it before the kernel takes our memory apart, which can
// take tens of milliseconds. It cannot help if it is killed with us, if we hang, or while the
// kernel writes a core dump: that is what the devices' own watchdogs are for.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "devices/hid/hid_protocol.h"

namespace limpid {

class Guardian {
 public:
  // Opens the hidraw node for itself. `claim`: a descriptor that it keeps as long as it lives, so
  // that nobody else has the device before its stop; -1: none. Throws HidError if the system
  // refuses.
  Guardian(const std::string& path, const std::vector<Report>& stop_reports, int claim = -1);
  // For a device that is open already; takes over its descriptor.
  Guardian(int device, const std::vector<Report>& stop_reports, int claim = -1);
  // In the thread that made it. Without dismiss() before: the guardian stops the device. Returns
  // when it has ended.
  ~Guardian();

  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  // The device is stopped; the guardian may go without doing anything.
  void dismiss() noexcept;

 private:
  struct Watch;

  Watch* watch_ = nullptr;  // shared with the child
  pid_t child_ = -1;
};

}  // namespace limpid
