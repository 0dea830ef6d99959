// Devices of makers with a library of their own, which the program limpid-vendor reaches
// (devices/vendor). It is started to list them, and for each device that is opened.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "devices/hid/device_list.h"
#include "devices/hid/hid_transport.h"

namespace limpid {

// Name of the program, which lies beside this one.
inline constexpr const char* kVendorProgram = "limpid-vendor";

// A line of `limpid-vendor list`: a library, or a device.
struct VendorLine {
  std::string back_end;  // as in ids: BACKEND:NAME
  bool is_device = false;
  std::string name;          // of the device; path of the library
  std::string title;         // for people
  std::string missing;       // why it cannot be used, and what to do; empty if it can
  bool absent = false;       // the library is not installed at all
  std::string version = {};  // of the library; empty: it says it only of an open device
};

// Asks the program. Lines that make no sense are left out; none if it cannot be started.
std::vector<VendorLine> ask_vendors();

// Lists the devices among these lines; with the wanted one, if its library is there: not every
// library tells its devices.
std::vector<FoundDevice> list_vendor_devices(const std::vector<VendorLine>& lines,
                                             const std::string& wanted);

// The kind of device that an id names, BACKEND:NAME; null if it names none of these.
const DeviceKind* vendor_kind(const std::string& id);

// Starts the program with a device and connects to it, which may take seconds. Throws HidError with
// what it says. The program ends with the transport. `claim`: a descriptor that it keeps as long as
// it lives, so that nobody else gets the device before its motors are off; -1: none.
std::unique_ptr<HidTransport> open_vendor(const std::string& back_end, const std::string& name,
                                          int claim = -1);

}  // namespace limpid
