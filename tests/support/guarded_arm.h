// The virtual arm as a real device: guarded, and with readings that a test can falsify.
#pragma once

#include "devices/simulated/virtual_device.h"

namespace limpid::test {

// Has the arm's motors, range and hand, but hides from the rig what only a simulated device knows.
class GuardedArm final : public Device {
 public:
  explicit GuardedArm(const ArmDescription& arm) : own(arm), traits_(own.traits()) {
    traits_.guarded = true;
  }
  const DeviceTraits& traits() const override { return traits_; }
  bool read(DeviceReading& newest) noexcept override {
    own.read(newest);
    for (std::size_t i = 0; i < 3; ++i) newest.x[i] += off[i];
    newest.age = age;
    newest.hand = hand;
    newest.lapses = lapses;
    return here;
  }
  void write(std::span<const double> torque) noexcept override {
    std::copy_n(torque.begin(), 3, told.begin());
    own.write(torque);
  }
  void stop() noexcept override { own.stop(); }
  void expect(const Parameters& p, const HandInput& hand_of_it) noexcept override {
    own.expect(p, hand_of_it);
  }
  void place(std::span<const double> x, std::span<const double> v,
             const Vec3& target) noexcept override {
    own.place(x, v, target);
  }

  VirtualDevice<3> own;
  std::array<double, 3> off{};   // error of its readings [rad]
  std::array<double, 3> told{};  // torque [N m]
  double age = 0;                // age of its readings [s]
  bool here = true, hand = true;
  std::uint32_t lapses = 0;

 private:
  DeviceTraits traits_;
};

}  // namespace limpid::test
