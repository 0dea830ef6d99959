// A simulated device that is not what its file says. To try identification on.
#pragma once

#include "core/dynamics/regressor.h"
#include "devices/identify/unlikeness.h"
#include "devices/simulated/virtual_arm.h"

namespace limpid {

// Reads before it is moved, as a real one does, and says no more than a real one; one write is one
// tick of 1 ms. Whoever drives it through a rig holds it, too.
class UnlikeDevice final : public Device {
 public:
  UnlikeDevice(const ArmDescription& truth, const Unlikeness& unlike);

  const DeviceTraits& traits() const override { return traits_; }
  bool read(DeviceReading& newest) noexcept override { return device_.read(newest); }
  void write(std::span<const double> torque) noexcept override;
  void stop() noexcept override { write({}); }
  // Of the parameters it is told the hand's alone: it is what it is.
  void expect(const Parameters& p, const HandInput& hand) noexcept override;
  // Somewhere at rest, the hand's target on the tip [rad].
  void put(const Eigen::VectorXd& x);
  // What nobody who drives it is told.
  const VirtualArm<kAnyDof>& arm() const { return device_.arm; }

  Eigen::VectorXd push;  // of somebody, besides [N m]

 private:
  VirtualDevice<kAnyDof> device_;
  DeviceTraits traits_;
  Parameters parameters_;
  HandInput hand_;
  double torque_scale_;
  std::array<double, kMaxDof> torque_{};
};

}  // namespace limpid
