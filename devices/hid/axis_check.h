// Check, with little force, that a device's motors move its own axes the right way. Nobody knows
// how a joystick's firmware takes a force that its descriptor does not tell, or how a motor is
// wired. With the wrong sign every wall is a spring that pushes the hand away.
//
// Each axis in turn is pushed one way and then the other. The torque grows from nothing to a tenth
// of full force and ends as soon as something has moved. Both times the same axis has to move, in
// the same sense of the torque: a hand that leads the device elsewhere moves it otherwise.
//
// Use, at every tick and with nothing else pushing:
//
//   AxisCheck check(device.traits());
//   device.write(check.step({reading.x, T, well}));
//
// `well`: the device is there, its newest reading is fresh, it reports no fault and the hand on it,
// and nobody has cut the force. Once `well` is false the check has ended: begin a new one. When
// check.done(), the torque stays zero, and the device may be trusted if check.passed();
// remember_check (device_store.h) then stores it. A panel shows axis() and what_to_do(stage())
// while it runs, afterwards explain(verdict) of axis().
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "devices/device.h"

namespace limpid {

enum class AxisVerdict : std::uint8_t {
  unknown,        // not pushed yet
  right,          // the axis moves as it is pushed
  reversed,       // the axis moves the other way: its sign has to be turned round
  wrong_axis,     // another axis moved
  nothing_moved,  // or not both ways: no arm, or held too firmly
  too_far,        // the axis moved farther or faster than so little force should move it
  restless,       // the axis moved by itself
  stalled,        // pushes were interrupted again and again
  given_up,       // cancelled, or the device was not well
  no_motor,       // nothing can push the axis, so that it needs no check
  beyond_limit,   // passed a limit of speed, range or energy that is set for the device
};

enum class AxisStage : std::uint8_t { resting, pushing, pushing_back, done };

const char* explain(AxisVerdict verdict);  // for people, a sentence about the axis
const char* what_to_do(AxisStage stage);   // for people, during the check

struct AxisFinding {
  AxisVerdict verdict = AxisVerdict::unknown;
  double moved_per_torque = 0;  // motion until the torque ended, over that torque [rad/(N m)]
};

class AxisCheck {
 public:
  struct Tick {
    std::span<const double> x;  // positions of the joints [rad]
    double T = 0;               // time since the last tick [s]
    bool well = false;          // as described above
    bool gap = false;           // after a stall: a push begins again, from nothing
  };

  // Throws std::invalid_argument if the device has no motors.
  explicit AxisCheck(const DeviceTraits& traits);

  // Returns the torque to be held until the next tick [N m]. Allocates nothing.
  std::span<const double> step(const Tick& in) noexcept;
  // Ends the check: no torque from the next step on.
  void cancel() noexcept { end(AxisVerdict::given_up); }
  // Ends the check likewise, as the caller has found a limit passed.
  void exceed() noexcept { end(AxisVerdict::beyond_limit); }

  int dof() const { return dof_; }
  const std::string& device() const { return device_; }  // its own name
  int axis() const { return axis_; }                     // the axis being pushed, or the last one
  AxisStage stage() const;
  bool done() const { return done_; }
  bool passed() const;  // all axes with motors are right or reversed
  const AxisFinding& finding(int axis) const { return findings_[static_cast<std::size_t>(axis)]; }

 private:
  using Joints = std::array<double, kMaxDof>;
  void rest(double T) noexcept;
  void rest_again() noexcept;
  void push() noexcept;
  void judge() noexcept;
  void next() noexcept;
  void skip_axes_without_motor() noexcept;
  void end(AxisVerdict verdict) noexcept;
  AxisFinding& found() { return findings_[static_cast<std::size_t>(axis_)]; }
  // Motion of an axis from a place, in parts of `limits`; the largest of all axes.
  double gone(int axis, const Joints& from, const Joints& limits) const noexcept;
  double furthest(const Joints& from, const Joints& limits) const noexcept;

  std::string device_;
  int dof_ = 0;
  Joints most_{};     // greatest torque [N m]
  Joints enough_{};   // motion beyond doubt [rad]
  Joints allowed_{};  // largest motion allowed [rad]
  std::array<AxisFinding, kMaxDof> findings_{};

  int axis_ = 0;
  int phase_ = 0;  // phase of the axis: rest, push, rest, push back, rest
  bool done_ = false;
  double time_ = 0;       // in the phase [s]
  int again_ = 0;         // pushes that began again after a stall, of all axes
  double still_ = 0;      // time in it without a motion [s]
  int sense_ = 0;         // sense of the motion of the first push
  bool started_ = false;  // x_ is known
  Joints x_{};            // positions now
  Joints start_{};        // positions that a motion counts from
  Joints home_{};         // positions before the axis' first push
  Joints torque_{};       // asked for
};

}  // namespace limpid
