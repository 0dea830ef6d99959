#include "devices/rig.h"

#include <algorithm>
#include <stdexcept>

#include "core/dynamics/inverse_kinematics.h"

namespace limpid {

Rig::Rig(const ArmDescription& arm, const Scene& scene) {
  if (arm.dof() == 3) {
    of_ = std::make_unique<Of<3>>(Tick<3>(arm, scene), VirtualArm<3>(arm), RigInput{});
  } else {
    of_ = std::make_unique<Of<kAnyDof>>(Tick<kAnyDof>(arm, scene), VirtualArm<kAnyDof>(arm),
                                        RigInput{});
  }
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
        of->tick.start(p, {start.x1, start.v1, start.x2, start.v2, start.f1_hat, start.armed});
        of->arm.place(start.x1, start.v1, start.target);
        of->input = {{start.target, 1}, start.armed};
      },
      of_);
}

void Rig::present(RigStart& into) const {
  std::visit(
      [&](const auto& of) {
        const auto device = of->arm.read(0);
        into.x1 = device.x;
        into.v1 = device.v;
        into.x2 = of->tick.proxy().x();
        into.v2 = of->tick.proxy().v();
        into.f1_hat = of->tick.estimate();
        into.target = of->input.hand.target;
        into.armed = of->input.force;
      },
      of_);
}

void Rig::step(const Parameters& p, const RigInput& input, std::span<double> row) noexcept {
  std::visit(
      [&](auto& of) {
        const RowLayout& layout = of->tick.layout();
        const auto reading = of->arm.read(p.encoder_step);
        const auto& torque = of->tick.run(p, reading, input.force, row);
        of->arm.live(p, torque, input.hand);
        of->input = input;
        const auto& f1 = of->arm.hand_torque();
        std::copy_n(f1.data(), f1.size(), layout.in(row, Column::hand_torque).begin());
        std::copy_n(input.hand.target.data(), 3, layout.in(row, Column::hand_target).begin());
        layout.in(row, Column::hand_grip)[0] = input.hand.grip;
      },
      of_);
}

Vec3 Rig::tip() const {
  return std::visit([](const auto& of) { return of->arm.tip(); }, of_);
}

bool Rig::steady() const {
  return std::visit([](const auto& of) { return of->tick.steady(of->input.force); }, of_);
}

bool Rig::diverged() const {
  return std::visit([](const auto& of) { return of->tick.diverged(); }, of_);
}

std::size_t Rig::contacts(std::span<ContactForce> into) const noexcept {
  return std::visit([&](const auto& of) { return of->tick.proxy().contacts().forces(into); }, of_);
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
