// Devices that are programs: each listens on a socket of its own, NAME.device in a folder that only
// this user may write to, and gives it this name once it listens. See socket_transport.h for what
// such a program has to do.
#pragma once

#include <filesystem>
#include <vector>

#include "devices/registry/device_list.h"

namespace limpid {

// $XDG_RUNTIME_DIR/limpid; empty where that is not set: then there are none.
std::filesystem::path socket_folder();

// Those that somebody listens on, sorted by path; without connecting to them.
std::vector<FoundDevice> list_socket_devices(const std::filesystem::path& folder);

}  // namespace limpid
