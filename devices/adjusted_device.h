// A device as its user wants it: axes turned round, scaled, and with its zero where it should be.
#pragma once

#include <memory>

#include "devices/device.h"

namespace limpid {

struct AxisAdjustment {
  double zero = 0;   // the device's reading where the joint is at zero [rad]
  double scale = 1;  // joint angle a device angle, above 0 [-]
  bool inverted = false;
  bool reversed = false;  // its motor pushes the other way than its reading counts

  double factor() const { return inverted ? -scale : scale; }
  friend bool operator==(const AxisAdjustment&, const AxisAdjustment&) = default;
};

// A motor that is reversed is told the opposite, so that it does what it is told. Then angles
// become factor * (x - zero), torques are multiplied by the factor too: the power at the joint is
// the power at the device, so that nothing passive becomes active. A device whose motors give
// `torque_scale` times what they are told is told so much less, and its limits are so much higher.
class AdjustedDevice final : public Device {
 public:
  // One adjustment a joint; joints without one are left as they are. torque_scale: above 0.
  AdjustedDevice(std::unique_ptr<Device> device, std::span<const AxisAdjustment> axes,
                 double torque_scale = 1);

  const DeviceTraits& traits() const override { return traits_; }
  bool read(DeviceReading& newest) noexcept override;
  void write(std::span<const double> torque) noexcept override;
  void stop() noexcept override { device_->stop(); }

 private:
  std::unique_ptr<Device> device_;
  DeviceTraits traits_;
  std::array<double, kMaxDof> factor_{}, zero_{}, of_motor_{};
  double torque_scale_;
};

}  // namespace limpid
