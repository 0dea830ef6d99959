// Transport of a device that is a service, in text messages through a WebSocket (RFC 6455).
//
// A message is a report without an id. Whatever the other side does, no call waits longer than it
// is told; a message longer than kMaxMessage ends the connection.
#pragma once

#include <memory>
#include <string>

#include "devices/hid/hid_transport.h"

namespace limpid {

struct ServiceAddress {
  std::string host = "localhost";
  std::string port = "10001";

  std::string text() const { return host + ":" + port; }
  friend bool operator==(const ServiceAddress&, const ServiceAddress&) = default;
};

// The address and port that a name leads to: one text for all names of one place, "here:PORT" for
// those of this computer, the name itself if it is unknown. Looking up a name may take seconds.
std::string resolved(const ServiceAddress& address);

// Connects within `timeout_ms`, or later if a name has to be looked up first. Throws HidError with
// the reason.
std::unique_ptr<HidTransport> open_web_socket(const ServiceAddress& address, int timeout_ms);

}  // namespace limpid
