// Meaning of the bytes of one kind of device. HidExchange speaks to all devices through this.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "devices/device.h"
#include "devices/hid/hid_transport.h"

namespace limpid {

using std::chrono::nanoseconds;

using SendReport = std::function<void(std::span<const std::uint8_t>)>;

enum class Decoded : std::uint8_t {
  unusable,  // not a report of ours, or damaged: nothing was taken from it
  status,    // hand, fault, buttons; no news of the joints
  reading,   // positions of the joints
};

class HidProtocol {
 public:
  virtual ~HidProtocol() = default;

  // Sends what a device needs when it is connected, before any torque. Throws HidError if the
  // device is unfit.
  virtual void open(HidTransport& transport) = 0;

  // Traits without the id, after open(); the name may be empty.
  virtual const DeviceTraits& traits() const = 0;

  // Age of a reading from which a device with motors is not to be trusted.
  virtual nanoseconds stale_after() const = 0;

  // The input report by which to ask for the joints, with its id alone, of devices that are silent
  // while nothing moves. Empty if not needed.
  virtual std::span<const std::uint8_t> silent_report() const { return {}; }

  // Takes an input report, any bytes at all, into the reading: x, hand, fault and buttons.
  virtual Decoded decode(std::span<const std::uint8_t> report, DeviceReading& reading) noexcept = 0;

  // Sends reports that make the motors hold these torques [N m], one a joint, finite and within the
  // limits; those that make a joint's torque zero come first. `send` may refuse the rest:
  // undelivered() and zero for all joints come next. Called about every millisecond.
  virtual void encode(std::span<const double> torque, nanoseconds now,
                      const SendReport& send) noexcept = 0;

  // Tells the protocol that a report of encode() did not get through.
  virtual void undelivered() noexcept {}

  // Output reports that take all force away, whatever was sent before; fixed after open().
  virtual const std::vector<Report>& stop_reports() const = 0;
};

}  // namespace limpid
