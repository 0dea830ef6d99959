#include "devices/hid/protocols.h"

#include <algorithm>
#include <array>

#include "devices/hid/raw_protocol.h"
#include "devices/hid/space_mouse.h"

namespace limpid {
namespace {

std::string none(const ReportDescriptor&) { return {}; }

template <class Protocol>
std::unique_ptr<HidProtocol> from_descriptor(const ReportDescriptor& descriptor,
                                             const PidSettings&) {
  return std::make_unique<Protocol>(descriptor);
}

std::unique_ptr<HidProtocol> raw(const ReportDescriptor&, const PidSettings&) {
  return std::make_unique<RawProtocol>();
}

std::unique_ptr<HidProtocol> pid(const ReportDescriptor& descriptor, const PidSettings& settings) {
  return std::make_unique<PidJoystick>(descriptor, settings);
}

constexpr std::array<HidProtocolEntry, 3> kProtocols{{
    {{.key = "raw",
      .name = "raw HID haptic device",
      .use = "has joints of its own; gives force if its description says so"},
     RawProtocol::describes,
     none,
     raw},
    {{.key = "pid",
      .name = "PID force-feedback joystick",
      .use = "has two joints; gives force",
      .uncalibrated = true,
      .pushes = true},
     PidJoystick::describes,
     PidJoystick::objection,
     pid},
    {{.key = "space_mouse",
      .name = "SpaceMouse",
      .use = "moves the hand of the virtual arm; no force",
      .leads_hand = true},
     SpaceMouse::describes,
     none,
     from_descriptor<SpaceMouse>},
}};

}  // namespace

std::span<const HidProtocolEntry> hid_protocols() { return kProtocols; }

const HidProtocolEntry* find_protocol(const ReportDescriptor& descriptor, std::uint16_t vendor,
                                      std::span<const HidProtocolEntry> among) {
  const auto found = std::ranges::find_if(among, [&](const HidProtocolEntry& entry) {
    return (entry.vendor == 0 || entry.vendor == vendor) && entry.describes(descriptor);
  });
  return found == among.end() ? nullptr : &*found;
}

}  // namespace limpid
