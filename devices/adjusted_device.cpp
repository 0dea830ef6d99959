#include "devices/adjusted_device.h"

#include <algorithm>
#include <cmath>

namespace limpid {

AdjustedDevice::AdjustedDevice(std::unique_ptr<Device> device, std::span<const AxisAdjustment> axes,
                               double torque_scale)
    : device_(std::move(device)), traits_(device_->traits()), torque_scale_(torque_scale) {
  factor_.fill(1);
  of_motor_.fill(1);
  for (std::size_t i = 0; i < axes.size() && i < factor_.size(); ++i) {
    factor_[i] = axes[i].factor();
    zero_[i] = axes[i].zero;
    of_motor_[i] = axes[i].reversed ? -factor_[i] : factor_[i];
  }
  for (std::size_t i = 0; i < traits_.lower.size(); ++i) {
    const double a = factor_[i] * (traits_.lower[i] - zero_[i]);
    const double b = factor_[i] * (traits_.upper[i] - zero_[i]);
    traits_.lower[i] = std::min(a, b);
    traits_.upper[i] = std::max(a, b);
  }
  for (std::size_t i = 0; i < traits_.resolution.size(); ++i) {
    traits_.resolution[i] *= std::abs(factor_[i]);
  }
  for (std::size_t i = 0; i < traits_.effort.size(); ++i) {
    traits_.effort[i] *= torque_scale_ / std::abs(factor_[i]);
  }
}

bool AdjustedDevice::read(DeviceReading& newest) noexcept {
  const bool here = device_->read(newest);
  for (std::size_t i = 0; i < static_cast<std::size_t>(traits_.dof); ++i) {
    newest.x[i] = factor_[i] * (newest.x[i] - zero_[i]);
  }
  return here;
}

void AdjustedDevice::write(std::span<const double> torque) noexcept {
  std::array<double, kMaxDof> out{};
  const std::size_t count = std::min(torque.size(), out.size());
  for (std::size_t i = 0; i < count; ++i) out[i] = of_motor_[i] * torque[i] / torque_scale_;
  device_->write({out.data(), count});
}

}  // namespace limpid
