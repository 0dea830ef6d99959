// The physical side of a reference device, to close a loop through it: each axis is a small mass
// that the motor turns and a springy hand leads along a path.
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

  // Starts at rest with the hand; the paths' time counts from `now`.
  void begin(Time now);
  // Advances to `now`; `torque_at(time)` gives the torque of the next step.
  void run(Time now, const std::function<Torque(Time)>& torque_at);

  int size() const { return static_cast<int>(axes_.size()); }
  double position(int axis) const { return states_[static_cast<std::size_t>(axis)].x; }  // [rad]
  // Angle that the encoder reports: that at which its wire broke, if it did, plus its miscount
  // [rad].
  double encoder(int axis) const {
    return off_ + (broken_.empty() ? position(axis) : broken_[static_cast<std::size_t>(axis)].x);
  }
  double velocity(int axis) const { return states_[static_cast<std::size_t>(axis)].v; }  // [rad/s]
  AxisPhysics& axis(int axis) { return axes_[static_cast<std::size_t>(axis)]; }
  const AxisPhysics& axis(int axis) const { return axes_[static_cast<std::size_t>(axis)]; }
  void hold(bool held) { held_ = held; }  // false lets go
  void break_encoders(bool broken) { broken_ = broken ? states_ : std::vector<State>{}; }
  void miscount(double off) { off_ = off; }  // error of the encoders [rad]
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
