#include "devices/rig/rig.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "core/dynamics/inverse_kinematics.h"

namespace limpid {

Rig::Rig(const ArmDescription& arm, const Scene& scene, bool real) {
  if (arm.dof() == 3) {
    of_ = std::make_unique<Of<3>>(arm, scene, real);
  } else {
    of_ = std::make_unique<Of<kAnyDof>>(arm, scene, real);
  }
}

void Rig::plug(Device* device) noexcept {
  std::visit(
      [&](auto& of) {
        of->plugged = device;
        of->lapses.reset();
      },
      of_);
}

bool Rig::real() const {
  return std::visit([](const auto& of) { return of->real; }, of_);
}

bool Rig::device_reading(DeviceReading& newest) const {
  return std::visit(
      [&](const auto& of) {
        newest = of->reading;
        return of->here;
      },
      of_);
}

const ForceGate& Rig::force() const {
  return std::visit([](const auto& of) -> const ForceGate& { return of->tick.force(); }, of_);
}

void Rig::limit(const SafetyLimits& limits) {
  std::visit([&](auto& of) { of->tick.limit(limits); }, of_);
}

template <int N>
Reading<N> Rig::Of<N>::read(const Parameters& p, const RigInput& now) noexcept {
  if (real) return read_real(p, now);
  virtual_device.expect(p, now.hand);
  virtual_device.read(reading);
  Reading<N> in = virtual_device.arm.read(0);
  std::copy_n(reading.x.begin(), in.x.size(), in.measured.begin());
  return in;
}

// What the loop sees. Of a device that says nothing, or nonsense: where it was when it last did.
template <int N>
Reading<N> Rig::Of<N>::read_real(const Parameters& p, const RigInput& now) noexcept {
  here = plugged != nullptr && plugged->read(reading);
  const Eigen::Index n = x_before.size();
  Vec<N> x = x_before;
  if (here && reading.count > 0) x = Eigen::Map<const Vec<N>>(reading.x.data(), n);
  const bool nonsense = !x.allFinite();
  if (nonsense) x = x_before;
  DeviceHealth health{true,  reading.hand, reading.fault || nonsense, !here, reading.age,
                      false, now.silence};
  if (reading.count == 0) health.age = SafetyLimits::kStaleReading * 2;
  health.gap = now.dt > SafetyLimits::kGap || (here && lapses != reading.lapses);
  if (here) lapses = reading.lapses;
  v_real = health.gap ? Vec<N>::Zero(n) : Vec<N>((x - x_before) / (now.periods * p.tick));
  x_before = x;
  return {x, x, v_real, health, now.periods, now.dt};
}

TouchWorld::TouchWorld(const ArmDescription& arm, const Scene& scene) {
  if (arm.dof() == 3) {
    contacts_ = std::make_unique<Contacts<3>>(arm, scene);
  } else {
    contacts_ = std::make_unique<Contacts<kAnyDof>>(arm, scene);
  }
}

void Rig::exchange(TouchWorld& world) noexcept {
  if (auto* of = std::get_if<std::unique_ptr<Of<3>>>(&of_)) {
    if (auto* c = std::get_if<0>(&world.contacts_)) (*of)->tick.exchange(*c);
  } else if (auto* c = std::get_if<1>(&world.contacts_)) {
    std::get<1>(of_)->tick.exchange(*c);
  }
}

const RowLayout& Rig::layout() const {
  return std::visit([](const auto& of) -> const RowLayout& { return of->tick.layout(); }, of_);
}

void Rig::start(const Parameters& p, const RigStart& start) {
  std::visit(
      [&](auto& of) {
        const bool armed = start.armed && !of->real;
        of->tick.start(p, {start.x1, start.v1, start.x2, start.v2, start.f1_hat, armed});
        of->virtual_device.arm.place(start.x1, start.v1, start.target);
        of->x_before = start.x1;
        of->v_real = start.v1;
        of->input = {{start.target, 1}};
      },
      of_);
}

void Rig::rebase(const Parameters& p, RigStart& scratch, const Vec3& target) {
  present(scratch);
  std::visit(
      [&](auto& of) {
        of->tick.rebase(p, {scratch.x1, scratch.v1, scratch.x2, scratch.v2, scratch.f1_hat});
        of->virtual_device.arm.place(scratch.x1, scratch.v1, target);
        of->x_before = scratch.x1;
        of->v_real = scratch.v1;
        of->input = {{target, 1}};
      },
      of_);
}

void Rig::present(RigStart& into) const {
  std::visit(
      [&](const auto& of) {
        const auto device = of->virtual_device.arm.read(0);
        into.x1 = of->real ? of->x_before : device.x;
        into.v1 = of->real ? of->v_real : device.v;
        into.x2 = of->tick.proxy().x();
        into.v2 = of->tick.proxy().v();
        into.f1_hat = of->tick.estimate();
        into.target = of->input.hand.target;
        into.armed = of->tick.force().armed();
      },
      of_);
}

void Rig::step(const Parameters& p, const RigInput& input, std::span<double> row) noexcept {
  std::visit(
      [&](auto& of) {
        const RowLayout& layout = of->tick.layout();
        const auto reading = of->read(p, input);
        const auto& torque = of->tick.run(p, reading, input.force, row);
        Device* device = of->real ? of->plugged : &of->virtual_device;
        if (device != nullptr) {
          const std::span tau(torque.data(), static_cast<std::size_t>(torque.size()));
          device->write(tau);
        }
        of->input = input;
        const std::span<double> f1 = layout.in(row, Column::hand_torque);
        const std::span<double> target = layout.in(row, Column::hand_target);
        if (of->real) {  // nobody measures the hand
          std::ranges::fill(f1, std::numeric_limits<double>::quiet_NaN());
          const Vec3 tip = of->tick.tip();
          std::copy_n(tip.data(), 3, target.begin());
        } else {
          std::ranges::copy(of->virtual_device.arm.hand_torque(), f1.begin());
          std::copy_n(input.hand.target.data(), 3, target.begin());
        }
        layout.in(row, Column::hand_grip)[0] = input.hand.grip;
      },
      of_);
}

Vec3 Rig::tip() const {
  return std::visit(
      [](const auto& of) { return of->real ? of->tick.tip() : of->virtual_device.arm.tip(); }, of_);
}

bool Rig::steady() const {
  return std::visit([](const auto& of) { return of->tick.steady(); }, of_);
}

bool Rig::diverged() const {
  return std::visit([](const auto& of) { return of->tick.diverged(); }, of_);
}

RigStart rest_at(const ArmDescription& arm, const Vec3& target) {
  const auto x = inverse_kinematics(arm, target, rest_pose(arm));
  if (!x) throw std::invalid_argument("out of reach");
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(arm.dof());
  return {*x, zero, *x, zero, zero, target, true};
}

RigStart start_of(const RowLayout& layout, std::span<const double> row) {
  const auto vector = [&](Column c) {
    const auto values = layout.in(row, c);
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(values.data(), layout.width(c)));
  };
  const auto target = layout.in(row, Column::hand_target);
  return {vector(Column::device_position),
          vector(Column::device_velocity),
          vector(Column::proxy_position),
          vector(Column::proxy_velocity),
          vector(Column::hand_torque_estimate),
          Vec3(target[0], target[1], target[2]),
          layout.in(row, Column::force_wanted)[0] != 0};
}

}  // namespace limpid
