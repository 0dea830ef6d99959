#include "tests/support/hid/sprung_hand.h"

#include <algorithm>
#include <cmath>

namespace limpid::test {

namespace {

double seconds(Time time) { return std::chrono::duration<double>(time).count(); }

}  // namespace

void SprungHand::begin(Time now) {
  start_ = now_ = now;
  states_.assign(axes_.size(), {});
  for (std::size_t i = 0; i < axes_.size(); ++i) states_[i].x = axes_[i].path(0);
}

void SprungHand::run(Time now, const std::function<Torque(Time)>& torque_at) {
  for (; now_ + kStep <= now; now_ += kStep) {
    const Torque torque = torque_at(now_);
    for (std::size_t i = 0; i < axes_.size(); ++i) step(i, seconds(now_ - start_), torque[i]);
  }
}

void SprungHand::step(std::size_t i, double t, double torque) {
  const AxisPhysics& axis = axes_[i];
  State& state = states_[i];
  const double dt = seconds(kStep);
  double push = torque - axis.friction * state.v + axis.weight * std::sin(state.x);
  if (held_) {
    const double speed = (axis.path(t + dt) - axis.path(t)) / dt;
    push += axis.stiffness * (axis.path(t) - state.x) + axis.damping * (speed - state.v);
  }
  state.v += push / axis.inertia * dt;
  const double lost = axis.coulomb / axis.inertia * dt;
  state.v = std::abs(state.v) > lost ? state.v - std::copysign(lost, state.v) : 0;
  state.x += state.v * dt;
  if (state.x >= axis.lower && state.x <= axis.upper) return;
  state.x = std::clamp(state.x, axis.lower, axis.upper);
  state.v = 0;
}

}  // namespace limpid::test
