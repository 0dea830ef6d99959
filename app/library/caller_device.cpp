#include "app/library/caller_device.h"

namespace limpid {

CallerDevice::CallerDevice(const ArmDescription& arm, bool guarded)
    : torque_(static_cast<std::size_t>(arm.dof()), 0.0) {
  traits_.name = arm.name;
  traits_.id = "caller";
  traits_.dof = arm.dof();
  traits_.pushes = true;
  traits_.guarded = guarded;
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    traits_.lower.push_back(arm.joints[i].lower);
    traits_.upper.push_back(arm.joints[i].upper);
    traits_.effort.push_back(arm.joints[i].effort);
    traits_.slides.push_back(arm.slides(i));
    unit_.push_back(arm.slides(i) ? kSlideUnit : 1);
  }
}

void CallerDevice::take(std::span<const double> position, bool fresh, bool hand, bool fault,
                        double elapsed) noexcept {
  whole_ = whole(position, fresh);
  reading_.hand = hand;
  reading_.fault = fault;
  reading_.age += elapsed;
  if (!whole_ || repeated(fresh)) return;
  reading_.age = 0;
  ++reading_.count;
  for (std::size_t i = 0; i < unit_.size(); ++i) reading_.x[i] = position[i] / unit_[i];
}

bool CallerDevice::read(DeviceReading& newest) noexcept {
  newest = reading_;
  return whole_;
}

void CallerDevice::write(std::span<const double> torque) noexcept {
  for (std::size_t i = 0; i < unit_.size(); ++i) torque_[i] = torque[i] / unit_[i];
}

void CallerDevice::stop() noexcept { std::ranges::fill(torque_, 0.0); }

}  // namespace limpid
