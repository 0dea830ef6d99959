// A device whose readings the test sets, and which keeps its last torque.
#pragma once

#include <algorithm>
#include <vector>

#include "tests/support/device_traits.h"

namespace limpid::test {

class FakeDevice final : public Device {
 public:
  explicit FakeDevice(int dof) : traits_(pushing(dof)) { reading.count = 1; }
  const DeviceTraits& traits() const override { return traits_; }
  DeviceTraits& own_traits() { return traits_; }
  bool read(DeviceReading& newest) noexcept override {
    newest = reading;
    return here;
  }
  void write(std::span<const double> torque) noexcept override {
    told.fill(0);
    std::copy_n(torque.begin(), std::min(torque.size(), told.size()), told.begin());
  }
  void stop() noexcept override {
    told.fill(0);
    stopped = true;
  }

  DeviceReading reading;
  bool here = true, stopped = false;
  std::array<double, kMaxDof> told{};  // torque [N m]

 private:
  DeviceTraits traits_;
};

}  // namespace limpid::test
