// A simulated device that is not what its file says: other inertia, friction, gravity, springs,
// delay. To try identification on.
#pragma once

#include "core/dynamics/regressor.h"
#include "devices/simulated/virtual_arm.h"

namespace limpid {

struct Unlikeness {
  Vec3 gravity = Vec3::Zero();         // in the base's frame [m/s^2]
  double encoder_step = 0;             // [rad]
  int delay = 0;                       // [ticks]
  Eigen::VectorXd spring{}, offset{};  // of each joint; none: nothing [N m/rad, N m]
  double torque_scale = 1;             // what its motors give of what they are told
};

// The file's arm with other masses (half to twice), centres, damping and friction, drawn by this
// seed. `most_friction` [N m].
ArmDescription unlike(const ArmDescription& file, unsigned seed, double most_friction);

// Axes of 10 or 16 bits, a delay of 1 to 4 ms, springs, drawn by this seed; gravity as it is given.
Unlikeness drawn_bench(const ArmDescription& file, unsigned seed, const Vec3& gravity);
// Between 0.7 and 1.4, drawn by this seed.
double drawn_torque_scale(unsigned seed);

// The arm with a small thing of so many kg fixed to its tip.
ArmDescription loaded(ArmDescription arm, double mass);

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
