// A HID device of this computer, by Linux's hidraw.
#pragma once

#include <memory>
#include <string>

#include "devices/hid/hid_transport.h"

namespace limpid {

// Opens a hidraw node, such as /dev/hidraw3. Throws HidError with the reason.
std::unique_ptr<HidTransport> open_hidraw(const std::string& path);

}  // namespace limpid
