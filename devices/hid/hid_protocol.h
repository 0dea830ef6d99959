// What the bytes of one kind of device mean. HidExchange speaks to all devices through this.
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
  reading,   // where the joints are
};

class HidProtocol {
 public:
  virtual ~HidProtocol() = default;

  // What is said when connecting, before any torque. Throws HidError if the device is unfit.
  virtual void open(HidTransport& transport) = 0;

  // All but its id, after open(); the name may be empty.
  virtual const DeviceTraits& traits() const = 0;

  // A device with motors that gives no reading for so long is not to be trusted.
  virtual nanoseconds stale_after() const = 0;

  // For devices that say nothing while nothing moves: the input report with the joints, empty but
  // for its id, by which to ask where they are. Nothing where that is not needed.
  virtual std::span<const std::uint8_t> silent_report() const { return {}; }

  // Takes an input report, any bytes at all, into the reading: x, hand, fault and buttons.
  virtual Decoded decode(std::span<const std::uint8_t> report, DeviceReading& reading) noexcept = 0;

  // Sends what makes the motors hold these torques [N m], one a joint, finite and within the
  // limits; what makes a joint's zero comes first. `send` may refuse the rest: then undelivered()
  // and zero on all joints come next. Called about every millisecond.
  virtual void encode(std::span<const double> torque, nanoseconds now,
                      const SendReport& send) noexcept = 0;

  // What encode() has just sent did not get through.
  virtual void undelivered() noexcept {}

  // Output reports that take all force away, whatever was said before; fixed after open().
  virtual const std::vector<Report>& stop_reports() const = 0;
};

}  // namespace limpid
