// Guardian of a device: takes the force away when this process is killed.
//
// A guardian is a child process that only waits for the end of the thread that made it. However
// that thread ends, the kernel releases the lock it holds. The guardian then writes the stop
// reports to the device, and ends. It learns of the end before the kernel frees our memory, which
// can take tens of milliseconds. It cannot help if it is killed with us, or if we hang or are
// stopped (SIGSTOP, Ctrl-Z): the devices' own watchdogs have to. A core dump would hold the lock
// for as long as the kernel writes it. Therefore a process leaves none once it has had a guardian,
// unless its limit was fixed at 0: then dumps that are piped into a program go on.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "devices/hid/hid_protocol.h"

namespace limpid {

class Guardian {
 public:
  // Opens the hidraw node for itself. `claim`: a descriptor that the guardian keeps as long as it
  // lives, so that nobody else gets the device before its stop; -1: none. Throws HidError if the
  // system refuses.
  Guardian(const std::string& path, const std::vector<Report>& stop_reports, int claim = -1);
  // Guards a device that is open already; takes over its descriptor.
  Guardian(int device, const std::vector<Report>& stop_reports, int claim = -1);
  // Has to run in the thread that made it. Without dismiss() before, the guardian stops the device.
  // Returns when the guardian has ended.
  ~Guardian();

  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  // Lets the guardian go without doing anything, as the device is stopped.
  void dismiss() noexcept;

 private:
  struct Watch;

  Watch* watch_ = nullptr;  // shared with the child
  pid_t child_ = -1;
};

}  // namespace limpid
