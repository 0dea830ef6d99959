// Serves an open device of a maker's library to Limpid, as one of the raw protocol, version 2.
#pragma once

#include <string>

#include "devices/vendor/back_end.h"

namespace limpid {

struct ServerPlace {
  std::string socket;   // path to listen on; takes one connection after the other
  int connection = -1;  // or a connection that is there already; its end is the server's
};

// Holds the signals back that ask the process to end, for serve() to take them. To be called before
// there are threads.
void hold_signals();

// Begins the device's frames and serves it until it fails, a signal asks for the end, or a
// connection that was handed over ends. The device is then without force and closed. Throws
// VendorError.
void serve(VendorBackEnd& device, const VendorTraits& traits, const ServerPlace& place);

}  // namespace limpid
