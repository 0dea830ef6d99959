// Transports of HID devices: Linux's hidraw, and Unix sockets of programs.
#pragma once

#include <memory>
#include <string>

#include "core/base/child.h"
#include "devices/hid/hid_transport.h"

namespace limpid {

// Connects to a device that is another program of this computer, and waits a moment for the first
// packet. Throws HidError with the reason.
//
// The program listens on a SOCK_SEQPACKET socket and takes one connection at a time. Its packets
// are the reports of the raw protocol (raw_protocol.h), without an id: first the feature
// report, then input reports; it is sent output reports. It must do what firmware must do: above
// all have no torque when the connection ends, or 10 ms pass without a command. No guardian process
// is needed: however this program ends, the kernel closes the connection.
std::unique_ptr<HidTransport> open_socket(const std::string& path);

// Connects over `file`, which it takes over, to a device that is the program `child`. Waits for its
// description, or for a packet that begins with `refusal` and says why there is none. Throws
// HidError. The program ends with the transport: it is given some time, then killed. One that gives
// no reading for 0.2 s after its first is killed at once.
std::unique_ptr<HidTransport> open_socket_of(std::unique_ptr<Child> child, int file, char refusal);

// Opens a hidraw node, such as /dev/hidraw3. Throws HidError with the reason.
std::unique_ptr<HidTransport> open_hidraw(const std::string& path);

}  // namespace limpid
