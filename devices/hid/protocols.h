// Kinds of HID devices that can be driven. A new kind is its own file and its line in the table of
// protocols.cpp; products that need permission get a line in assets/udev/70-limpid.rules.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "devices/hid/hid_protocol.h"
#include "devices/hid/pid_joystick.h"
#include "devices/hid/report_descriptor.h"

namespace limpid {

// Properties of a device that are known before it is opened.
struct DeviceKind {
  const char* key = "";       // for programs
  const char* name = "";      // for people
  const char* use = "";       // for people: what it is good for
  bool leads_hand = false;    // leads the virtual arm's hand; else it takes the arm's place
  bool uncalibrated = false;  // only its owner knows its PidSettings
  bool pushes = false;        // always; others say so themselves once they are opened
  const char* arm = "";  // file of its own arm, in assets/devices; none: any arm with its joints
  bool service = false;  // found by asking a program, which is not to be done all the time
};

struct HidProtocolEntry {
  DeviceKind kind;
  bool (*describes)(const ReportDescriptor& descriptor);
  // The reason why a described device cannot be used, for people; empty if it can.
  std::string (*objection)(const ReportDescriptor& descriptor);
  // Makes the protocol. Throws HidError. `settings` matter only to uncalibrated devices.
  std::unique_ptr<HidProtocol> (*make)(const ReportDescriptor& descriptor,
                                       const PidSettings& settings);
  std::uint16_t vendor = 0;  // USB's number for the maker, if only that tells; 0: any
};

std::span<const HidProtocolEntry> hid_protocols();
// The first entry that describes a device of this maker; null if none does.
const HidProtocolEntry* find_protocol(const ReportDescriptor& descriptor, std::uint16_t vendor,
                                      std::span<const HidProtocolEntry> among = hid_protocols());

}  // namespace limpid
