#include "devices/simulated/virtual_device.h"

#include <algorithm>

namespace limpid {

namespace {

// Positions as encoders of this step give them; a step of 0 is exact [rad].
template <int N>
Vec<N> rounded(const Vec<N>& x, double step) {
  return step > 0 ? Vec<N>((x / step).array().round().matrix() * step) : x;
}

}  // namespace

template <int N>
VirtualDevice<N>::VirtualDevice(const ArmDescription& description)
    : arm(description), plant_(description) {
  traits_.name = description.name;
  traits_.id = "virtual";
  traits_.dof = description.dof();
  traits_.pushes = true;
  traits_.guarded = false;
  traits_.rate = 1 / p_.tick;
  for (const Joint& joint : description.joints) {
    traits_.lower.push_back(joint.lower);
    traits_.upper.push_back(joint.upper);
    traits_.resolution.push_back(0);
    traits_.effort.push_back(joint.effort);
  }
  sent_.fill(Vec<N>::Zero(traits_.dof));
}

template <int N>
void VirtualDevice<N>::place(std::span<const double> x, std::span<const double> v,
                             const Vec3& target) noexcept {
  const Eigen::Index n = traits_.dof;
  arm.place(Eigen::Map<const Vec<N>>(x.data(), n), Eigen::Map<const Vec<N>>(v.data(), n), target);
  plant_.place(arm.x(), arm.v());
  sent_.fill(Vec<N>::Zero(n));
}

template <int N>
std::optional<DeviceTruth> VirtualDevice<N>::truth() const noexcept {
  const auto joints = [](const Vec<N>& values) {
    return std::span(values.data(), static_cast<std::size_t>(values.size()));
  };
  return DeviceTruth{joints(arm.x()), joints(arm.v()), joints(plant_.hand_torque()),
                     joints(plant_.torque())};
}

template <int N>
bool VirtualDevice<N>::read(DeviceReading& newest) noexcept {
  const Vec<N> shown = rounded<N>(plant_.encoders(p_, arm.x()), p_.encoder_step);
  std::copy_n(shown.data(), shown.size(), newest.x.begin());
  newest.count = ++count_;
  newest.age = 0;
  return true;
}

template <int N>
void VirtualDevice<N>::write(std::span<const double> torque) noexcept {
  Vec<N> tau = Vec<N>::Zero(traits_.dof);
  if (!torque.empty()) tau = Eigen::Map<const Vec<N>>(torque.data(), traits_.dof);
  newest_ = (newest_ + 1) % sent_.size();
  sent_[newest_] = tau;
  const std::size_t late = newest_ + sent_.size() - static_cast<std::size_t>(p_.device_delay);
  plant_.live(arm, p_, sent_[late % sent_.size()], hand_);
}

template class VirtualDevice<3>;
template class VirtualDevice<7>;
template class VirtualDevice<kAnyDof>;

}  // namespace limpid
