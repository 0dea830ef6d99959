// The Inverse3s that a Haply Inverse Service has (devices/inverse3/inverse_protocol.h).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "devices/inverse3/web_socket.h"
#include "devices/registry/device_list.h"

namespace limpid {

// Which one is meant, as its id and options say it: inverse3[:ID][@HOST[:PORT]].
struct InverseName {
  std::string id;  // as the service has it; empty: the first there
  ServiceAddress address;

  std::string text() const;
};

// Nothing where the words name no Inverse3. Throws HidError where they do, but not as above.
std::optional<InverseName> inverse_name(const std::string& words);

// Those of the service on this computer, where it usually is, and of the one that `wanted` is at.
// A wanted one that is not there is among them, with what it lacks. Connects to services: not for
// every second, each takes that as a session of its own.
std::vector<FoundDevice> list_inverse_devices(const std::optional<InverseName>& wanted,
                                              const ServiceAddress& usual = {});

}  // namespace limpid
