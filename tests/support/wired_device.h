// A real device at a wire: a test sets its angle and buttons while a loop reads it.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "tests/support/built_in.h"
#include "tests/support/device_traits.h"

namespace limpid::test {

// State of the device, shared with the test.
struct Wire {
  std::atomic<double> angle{0};  // from the arm's rest [rad]
  std::atomic<bool> here{true};
  std::atomic<std::uint32_t> buttons{0}, buttons_known{~0u};
  std::atomic<double> torque{0};  // largest of the newest command [N m]
  std::atomic<int> closed{0};
};

class WiredDevice final : public Device {
 public:
  WiredDevice(int dof, std::shared_ptr<Wire> wire, double effort = 0.5)
      : traits_(pushing(dof, 3, effort)),
        rest_(static_cast<std::size_t>(dof)),
        wire_(std::move(wire)) {
    if (dof == 3) Eigen::Map<Eigen::Vector3d>(rest_.data()) = rest_pose(omni());
  }
  ~WiredDevice() override { ++wire_->closed; }
  const DeviceTraits& traits() const override { return traits_; }
  bool read(DeviceReading& newest) noexcept override {
    for (std::size_t i = 0; i < rest_.size(); ++i) newest.x[i] = rest_[i] + wire_->angle;
    newest.count = ++count_;
    if (newest.count % 2 == 0) newest.x[0] += 1e-12;  // a hand is never quite still
    newest.buttons = wire_->buttons;
    newest.buttons_known = wire_->buttons_known;
    return wire_->here;
  }
  void write(std::span<const double> torque) noexcept override {
    double largest = 0;
    for (const double tau : torque) largest = std::max(largest, std::abs(tau));
    wire_->torque = largest;
  }
  void stop() noexcept override { wire_->torque = 0; }

 private:
  DeviceTraits traits_;
  std::vector<double> rest_;  // [rad]
  std::shared_ptr<Wire> wire_;
  std::uint64_t count_ = 0;
};

}  // namespace limpid::test
