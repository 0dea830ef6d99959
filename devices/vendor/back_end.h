// Back ends of limpid-vendor: the libraries of makers, by which it reaches their devices. A further
// maker is a file with a VendorBackEnd and the function that makes it, and a line in
// devices/hid/vendor_kinds.h.
//
// A library is loaded while the program runs. Nothing of it, header or text, is part of Limpid:
// each back end declares the few functions that it calls.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "devices/device.h"
#include "devices/hid/vendor_kinds.h"

namespace limpid {

class Servo;

// Error of a maker's library or device, in words for people.
struct VendorError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Thrown where a library is not installed at all.
struct VendorAbsent : VendorError {
  using VendorError::VendorError;
};

// Axes as Limpid has them: x forward, y to the left, z up.
using TipVector = std::array<double, 3>;

struct VendorLibrary {
  std::string path;
  std::string version;  // empty: it says none before a device is open
};

struct VendorListed {
  std::string name;     // by which it is opened
  std::string title;    // for people
  std::string missing;  // why it cannot be opened, and what to do; empty if it can
};

// Properties of an open device: a tip that is moved and pushed in three directions.
struct VendorTraits {
  std::string name;            // model and serial number
  std::string serial;          // empty: not known
  std::string made_by;         // the library and its version, at most 28 characters
  TipVector lower{}, upper{};  // range [m]
  double resolution = 0;       // [m]
  double force = 0;            // largest along each axis [N]
};

struct VendorReading {
  TipVector x{};  // [m]
  std::uint32_t buttons = 0;
  bool hand = true;
  bool calibrated = true;
  bool fault = false;
  NoForce no_force = NoForce::none;
  float warmth = 0;                    // 0 to 1
  std::array<float, 4> orientation{};  // of the tool, as in tool_frame.h; all zero: not known
};

struct VendorForce {
  TipVector force{};     // [N]
  bool enabled = false;  // else the motors are off
};

struct VendorOptions {
  bool simulator = false;  // also opens what a maker's simulator plays
};

class VendorBackEnd {
 public:
  VendorBackEnd() = default;
  VendorBackEnd(const VendorBackEnd&) = delete;
  VendorBackEnd& operator=(const VendorBackEnd&) = delete;
  virtual ~VendorBackEnd() = default;

  // Loads the library; the other functions need it. All functions but end() and close() throw
  // VendorError.
  virtual VendorLibrary load() = 0;
  virtual std::vector<VendorListed> list(const VendorOptions& options) = 0;
  // Opens a device, which stays without force.
  virtual VendorTraits open(const std::string& name, const VendorOptions& options) = 0;
  // Says in words what calibrate() would move, if the open device needs it; empty if it does not.
  virtual std::string needs_calibration() = 0;
  // Calibrates the open device, which may move by itself.
  virtual void calibrate() = 0;

  // Read and write belong to the frames: one of each in every frame.
  virtual void read(VendorReading& reading) = 0;
  virtual void write(const VendorForce& force) = 0;

  // Begins the frames, in a rhythm and a thread of the library's own or, as here, in our own.
  virtual void begin(Servo& servo);
  // Ends the frames; the last one has commanded no force, if it came.
  virtual void end() noexcept;
  // Words about what the frames have shown of the device, once they have ended; empty: none.
  virtual std::string remark() const { return {}; }
  // Leaves the device without force and closes it.
  virtual void close() noexcept = 0;

 private:
  std::thread thread_;
};

struct BackEndEntry {
  const char* key;                 // as in ids of devices
  const char* maker;               // for people
  std::vector<std::uint16_t> usb;  // the maker's numbers for vendors on USB
  std::unique_ptr<VendorBackEnd> (*make)();
};

std::span<const BackEndEntry> back_ends();

#define DECLARED(key, name, maker, ...) std::unique_ptr<VendorBackEnd> make_##key();
LIMPID_VENDORS(DECLARED)
#undef DECLARED

}  // namespace limpid
