// A real device, exchanged with by a thread of its own.
//
// If this process dies in any way, a guardian process takes the force away. If both die, or the
// computer does, the device's own watchdog has to (raw protocol: 10 ms, PID: its effects end).
#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <string>
#include <thread>

#include "core/realtime/realtime.h"
#include "devices/device.h"
#include "devices/hid/device_claim.h"
#include "devices/hid/hid_exchange.h"

namespace limpid {

// Place of a device, for people and for the guardian.
struct HidPlace {
  std::string name;
  std::string id;    // vendor:product:serial
  std::string path;  // of the hidraw node; empty: the transport guards the device, if at all
  std::string library = {};  // file of the maker's library that drives it; empty: none
};

class HidDevice final : public Device {
 public:
  // Opens the protocol and starts the exchange. Throws HidError. `ask`: see become_realtime().
  // `claim`: of the device; released once the device has had its stop. Not for the haptic thread,
  // nor for a thread that yielded to it: the device's own thread inherits the scheduling.
  HidDevice(std::unique_ptr<HidTransport> transport, std::unique_ptr<HidProtocol> protocol,
            const HidPlace& place, const AskForPriority& ask = {}, DeviceClaim claim = {});
  // Leaves the device without force and with its motors off, if it can be reached. The kernel
  // releases a device that hangs only after seconds; its force was taken away before.
  ~HidDevice() override;

  HidDevice(const HidDevice&) = delete;
  HidDevice& operator=(const HidDevice&) = delete;

  const DeviceTraits& traits() const override { return traits_; }
  bool read(DeviceReading& newest) noexcept override { return exchange_->read(newest); }
  void write(std::span<const double> torque) noexcept override { exchange_->write(torque); }
  void stop() noexcept override { exchange_->stop(); }

  bool lost() const noexcept { return exchange_->lost(); }
  // Number of reports that were damaged or made no sense.
  std::uint64_t unusable() const noexcept { return exchange_->unusable(); }

 private:
  void run(const AskForPriority& ask, std::promise<void> guarded) noexcept;

  DeviceClaim claim_;  // first, so that it is released last
  std::unique_ptr<HidTransport> transport_;
  std::unique_ptr<HidProtocol> protocol_;
  DeviceTraits traits_;
  std::unique_ptr<HidExchange> exchange_;
  std::string path_;
  std::atomic<bool> quit_{false};
  std::thread thread_;
};

}  // namespace limpid
