// A simulated device that differs from its file, to try identification on.
#pragma once

#include "core/dynamics/regressor.h"
#include "devices/identify/unlikeness.h"
#include "devices/simulated/virtual_device.h"

namespace limpid {

// Behaves as a real device: can be read before it is moved, and has no truth(). One write is one
// tick of 1 ms. A rig that drives it also is the hand that holds it.
class UnlikeDevice final : public Device {
 public:
  UnlikeDevice(const ArmDescription& truth, const Unlikeness& unlike);

  const DeviceTraits& traits() const override { return traits_; }
  bool read(DeviceReading& newest) noexcept override { return device_.read(newest); }
  void write(std::span<const double> torque) noexcept override;
  void stop() noexcept override { write({}); }
  // Uses only the hand's parameters of `p`; the arm's errors stay as constructed.
  void expect(const Parameters& p, const HandInput& hand) noexcept override;
  // Puts it at rest, the hand's target on the tip [rad].
  void put(const Eigen::VectorXd& x);
  // The true arm, hidden from whoever drives the device.
  const VirtualArm<kAnyDof>& arm() const { return device_.arm; }

  Eigen::VectorXd push;  // torque of somebody besides [N m]

 private:
  VirtualDevice<kAnyDof> device_;
  DeviceTraits traits_;
  Parameters parameters_;
  HandInput hand_;
};

}  // namespace limpid
