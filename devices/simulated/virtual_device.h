// The virtual arm as a device.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "core/tick/parameters.h"
#include "devices/device.h"
#include "devices/simulated/plant.h"
#include "devices/simulated/virtual_arm.h"

namespace limpid {

// write() simulates the tick; its torque reaches the motors some ticks later.
template <int N>
class VirtualDevice final : public Device {
 public:
  explicit VirtualDevice(const ArmDescription& arm);

  void expect(const Parameters& p, const HandInput& hand) noexcept override {
    p_ = p;
    hand_ = hand;
  }
  void place(std::span<const double> x, std::span<const double> v,
             const Vec3& target) noexcept override;
  std::optional<DeviceTruth> truth() const noexcept override;
  const DeviceTraits& traits() const override { return traits_; }
  bool read(DeviceReading& newest) noexcept override;
  void write(std::span<const double> torque) noexcept override;
  void stop() noexcept override { write({}); }

  VirtualArm<N> arm;

 private:
  DeviceTraits traits_;
  Parameters p_;
  HandInput hand_;
  std::array<Vec<N>, kMostDelay + 1> sent_;  // ring of torques, one a tick [N m]
  std::size_t newest_ = 0;                   // its newest place
  Plant<N> plant_;
  std::uint64_t count_ = 0;
};

extern template class VirtualDevice<3>;
extern template class VirtualDevice<7>;
extern template class VirtualDevice<kAnyDof>;

}  // namespace limpid
