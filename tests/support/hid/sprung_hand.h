// The physical side of a reference device: each axis a small mass which the motor turns and a
// springy hand leads along a path. So a loop can be closed through it.
#pragma once

#include <functional>
#include <vector>

#include "tests/support/hid/force_log.h"

namespace limpid::test {

struct AxisPhysics {
  double inertia = 2e-3;   // [kg m^2]
  double friction = 5e-3;  // viscous, of the bearing [N m s/rad]
  double coulomb = 0;      // dry, of the bearing [N m]
  double weight = 0;       // pulls by weight sin x [N m]
  double stiffness = 2;    // of the hand [N m/rad]
  double damping = 0.05;   // of the hand [N m s/rad]
  double lower = -0.35;    // stop [rad]
  double upper = 0.35;     // stop [rad]
  std::function<double(double)> path = [](double) { return 0.0; };  // of the hand, t [s] -> [rad]
};

class SprungHand {
 public:
  static constexpr Time kStep = std::chrono::microseconds(100);

  explicit SprungHand(std::vector<AxisPhysics> axes) : axes_(std::move(axes)) { begin(Time{}); }

  // At rest where the hand is, at the time which the paths count from.
  void begin(Time now);
  // Steps until now; `torque_at(time)` gives the Torque which acts for the next step.
  void run(Time now, const std::function<Torque(Time)>& torque_at);

  int size() const { return static_cast<int>(axes_.size()); }
  double position(int axis) const { return states_[static_cast<std::size_t>(axis)].x; }  // [rad]
  // As the encoder has it: where it was when its wire broke, so much off [rad].
  double encoder(int axis) const {
    return off_ + (broken_.empty() ? position(axis) : broken_[static_cast<std::size_t>(axis)].x);
  }
  double velocity(int axis) const { return states_[static_cast<std::size_t>(axis)].v; }  // [rad/s]
  AxisPhysics& axis(int axis) { return axes_[static_cast<std::size_t>(axis)]; }
  const AxisPhysics& axis(int axis) const { return axes_[static_cast<std::size_t>(axis)]; }
  void hold(bool held) { held_ = held; }  // or let go
  void break_encoders(bool broken) { broken_ = broken ? states_ : std::vector<State>{}; }
  void miscount(double off) { off_ = off; }  // what the encoders say is off by this [rad]
  bool held() const { return held_; }

 private:
  struct State {
    double x = 0, v = 0;
  };
  void step(std::size_t axis, double t, double torque);

  std::vector<AxisPhysics> axes_;
  std::vector<State> states_, broken_;
  Time start_{}, now_{};
  bool held_ = true;
  double off_ = 0;
};

}  // namespace limpid::test
