// A device that is a service, spoken to in text messages through a WebSocket (RFC 6455).
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

// The address and port that it leads to: one text for all names of one place, "here:PORT" for those
// of this computer. Of a name that nobody knows: the name itself. A name that has to be looked up
// may take seconds.
std::string resolved(const ServiceAddress& address);

// Connects within so long [ms]; a name that has to be looked up first may take longer. Throws
// HidError with the reason.
std::unique_ptr<HidTransport> open_web_socket(const ServiceAddress& address, int timeout_ms);

}  // namespace limpid
