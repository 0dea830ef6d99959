// Takes the force away when this process is killed.
//
// A child process that does nothing but wait on a socket to us. However we end, the kernel closes
// our side of it; the guardian then writes the stop reports to the device and ends too. It cannot
// help if it is killed with us, or if we hang: that is what the devices' own watchdogs are for.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "devices/hid/hid_protocol.h"

namespace limpid {

class Guardian {
 public:
  // Opens the hidraw node for itself and locks it against other guardians. Throws HidError if
  // another Limpid has the device, or the system refuses.
  Guardian(const std::string& path, const std::vector<Report>& stop_reports);
  // For a device that is open already; takes over the descriptor.
  Guardian(int device, const std::vector<Report>& stop_reports);
  // Without dismiss() before: the guardian stops the device. Returns when it has ended.
  ~Guardian();

  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  // The device is stopped; the guardian may go without doing anything.
  void dismiss() noexcept;

 private:
  int socket_ = -1;
  pid_t child_ = -1;
};

}  // namespace limpid
