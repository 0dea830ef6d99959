// A HID device of this computer, by Linux's hidraw.
#pragma once

#include <memory>
#include <string>

#include "devices/hid/hid_transport.h"

namespace limpid {

// A device that is another program of this computer, spoken to through a Unix socket.
//
// The program listens on a SOCK_SEQPACKET socket and takes one connection at a time. Its packets
// are the 64-byte reports of the raw protocol (protocols/raw_protocol.h), without an id: first the
// feature report, then input reports; it is sent output reports. What firmware must do it must do
// too: above all have no torque when the connection ends, or 10 ms pass without a command. No
// guardian process is needed: however this program ends, the kernel closes the connection.

// Connects and waits a moment for the first packet. Throws HidError with the reason.
std::unique_ptr<HidTransport> open_socket(const std::string& path);

// Opens a hidraw node, such as /dev/hidraw3. Throws HidError with the reason.
std::unique_ptr<HidTransport> open_hidraw(const std::string& path);

}  // namespace limpid
