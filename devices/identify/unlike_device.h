// A simulated device that is not what its file says: other inertia, friction, gravity, springs,
// delay. To try identification on.
#pragma once

#include "core/dynamics/regressor.h"
#include "devices/virtual_arm.h"

namespace limpid {

struct Unlikeness {
  Vec3 gravity = Vec3::Zero();         // in the base's frame [m/s^2]
  double encoder_step = 0;             // [rad]
  int delay = 0;                       // [ticks]
  Eigen::VectorXd spring{}, offset{};  // of each joint; none: nothing [N m/rad, N m]
};

// The file's arm with other masses (half to twice), centres, damping and friction, drawn by this
// seed. `most_friction` [N m].
ArmDescription unlike(const ArmDescription& file, unsigned seed, double most_friction);

// Reads before it is moved, as a real one does; one write is one tick of 1 ms.
class UnlikeDevice final : public Device {
 public:
  UnlikeDevice(const ArmDescription& truth, const Unlikeness& unlike);

  const DeviceTraits& traits() const override { return traits_; }
  bool read(DeviceReading& newest) noexcept override { return device_.read(newest); }
  void write(std::span<const double> torque) noexcept override;
  void stop() noexcept override { write({}); }

  Eigen::VectorXd push;  // of somebody, besides [N m]

 private:
  Unlikeness unlike_;
  Arm<kAnyDof> arm_;
  VirtualDevice<kAnyDof> device_;
  DeviceTraits traits_;
  Parameters parameters_;
  HandInput hand_;
  Eigen::VectorXd parameters_of_links_, others_;
};

}  // namespace limpid
