// A device as its user wants it: axes inverted, scaled, and with its zero where it should be.
#pragma once

#include <memory>

#include "devices/device.h"

namespace limpid {

struct AxisAdjustment {
  double zero = 0;   // the device's reading where the joint is at zero [rad]
  double scale = 1;  // joint angle per device angle, above 0 [-]
  bool inverted = false;
  bool reversed = false;  // the motor pushes against the direction of the reading

  double factor() const { return inverted ? -scale : scale; }
  friend bool operator==(const AxisAdjustment&, const AxisAdjustment&) = default;
};

// Applies each axis' adjustment and the scale of the motors' torque. A reversed motor is told the
// opposite, so that it does what it is told. Angles become factor * (x - zero), torques are
// multiplied by the factor too. The power at the joint thus is the power at the device: nothing
// passive becomes active. Motors that give `torque_scale` times what they are told are told that
// much less; their limits rise as much.
class AdjustedDevice final : public Device {
 public:
  // Takes one adjustment a joint; joints without one stay as they are. torque_scale: above 0.
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
