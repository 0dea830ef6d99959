// Finds out with little force whether a device's motors move its own axes the right way: what a
// joystick's firmware makes of a force its descriptor does not tell, how a motor is wired nobody
// does, and with the wrong sign every wall is a spring that pushes the hand away.
//
// Each axis in turn is pushed one way and then the other, by a torque that grows from nothing to a
// tenth of full force and ends as soon as something has moved. Both times the same axis must move,
// in the same sense of the torque: a hand that leads the device elsewhere does not look like that.
//
// To drive it, at every tick and with nothing else pushing:
//
//   AxisCheck check(device.traits());
//   device.write(check.step({reading.x, T, well}));
//
// `well`: the device is there, its newest reading is fresh, it reports no fault and the hand on it,
// and nobody has cut the force. Once that is false, nothing moves on: begin with a new check. When
// check.done(), the torque is zero for good, and the device may be trusted if check.passed(); then
// let remember_check (device_store.h) store it. While it runs, the panel shows axis() and
// what_to_do(stage()); afterwards explain(verdict) of axis().
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "devices/device.h"

namespace limpid {

enum class AxisVerdict : std::uint8_t {
  unknown,        // not pushed yet
  right,          // it moves as it is pushed
  reversed,       // it moves the other way: its sign has to be turned round
  wrong_axis,     // another one moved
  nothing_moved,  // or not both ways: no arm, or held too firmly
  too_far,        // it moved further or faster than so little force should move it
  restless,       // it moved by itself
  given_up,       // cancelled, or the device was not well
  beyond_limit,   // of speed, range or energy, as they are set for the device
};

enum class AxisStage : std::uint8_t { resting, pushing, done };

const char* explain(AxisVerdict verdict);  // for people, a sentence about the axis
const char* what_to_do(AxisStage stage);   // for people, while it runs

struct AxisFinding {
  AxisVerdict verdict = AxisVerdict::unknown;
  double moved_per_torque = 0;  // how far until the torque ended, over that torque [rad/(N m)]
};

class AxisCheck {
 public:
  struct Tick {
    std::span<const double> x;  // positions of the joints [rad]
    double T = 0;               // since the last tick [s]
    bool well = false;          // see above
  };

  // Throws std::invalid_argument if it has no motors.
  explicit AxisCheck(const DeviceTraits& traits);

  // The torque to be held until the next tick [N m]. Allocates nothing.
  std::span<const double> step(const Tick& in) noexcept;
  // No torque from the next step on.
  void cancel() noexcept { end(AxisVerdict::given_up); }
  // The same, as whoever drives it has found a limit passed.
  void exceed() noexcept { end(AxisVerdict::beyond_limit); }

  int dof() const { return dof_; }
  const std::string& device() const { return device_; }  // the name that it gives
  int axis() const { return axis_; }                     // being pushed, or the last that was
  AxisStage stage() const;
  bool done() const { return done_; }
  bool passed() const;  // all axes are right or reversed
  const AxisFinding& finding(int axis) const { return findings_[static_cast<std::size_t>(axis)]; }

 private:
  using Joints = std::array<double, kMaxDof>;
  void rest(double T) noexcept;
  void push() noexcept;
  void judge() noexcept;
  void next() noexcept;
  void end(AxisVerdict verdict) noexcept;
  AxisFinding& found() { return findings_[static_cast<std::size_t>(axis_)]; }
  // How far the axis has gone from a place, in parts of `limits`; the furthest of all.
  double gone(int axis, const Joints& from, const Joints& limits) const noexcept;
  double furthest(const Joints& from, const Joints& limits) const noexcept;

  std::string device_;
  int dof_ = 0;
  Joints most_{};     // torque that it gets [N m]
  Joints enough_{};   // after so much it has moved beyond doubt [rad]
  Joints allowed_{};  // and more than this is too much [rad]
  std::array<AxisFinding, kMaxDof> findings_{};

  int axis_ = 0;
  int phase_ = 0;  // of the axis: rest, push, rest, push back, rest
  bool done_ = false;
  double time_ = 0;       // in the phase [s]
  double still_ = 0;      // of it without a motion [s]
  int sense_ = 0;         // of the motion of the first push
  bool started_ = false;  // x_ is known
  Joints x_{};            // now
  Joints start_{};        // where a motion counts from
  Joints home_{};         // where it was before its first push
  Joints torque_{};       // asked for
};

}  // namespace limpid
