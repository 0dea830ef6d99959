// Whether a real device may push at all, and how hard.
#pragma once

#include <cstdint>

#include "core/dynamics/arm.h"

namespace limpid {

// Why there is no force, or less of it. The order is that of the session file's
// /device/force_state.
enum class ForceState : std::uint8_t {
  on,
  off,       // not armed
  no_hand,   // the dead-man switch is open
  stale,     // no reading for kStaleReading
  fault,     // the device says that it is not well
  lost,      // unplugged
  too_fast,  // fades with the speed
  too_far,   // fades outside of the range of a joint
  energy,    // the motors have put more energy out than they should
  diverged,  // the command was not finite
};
const char* explain(ForceState state);  // for people, a short clause

// What a device says of itself at a tick; a virtual one is always well.
struct DeviceHealth {
  bool real = false;
  bool hand = true;
  bool fault = false;
  bool lost = false;
  double age = 0;  // of the reading [s]
};

struct SafetyLimits {
  static constexpr double kStaleReading = 0.005;  // [s]
  static constexpr double kFade = 1.5;            // force is gone at so many times a limit

  double joint_speed = 15;  // [rad/s]
  double tip_speed = 2;     // [m/s]
  double tip_force = 10;    // [N]
  double overrun = 0.1;     // beyond a joint's range, where force is gone [rad]
  double energy = 1.5;      // put out by the motors, forgotten within a second [J]
  double slew = 0.02;       // from no torque to the limit [s]
};

// Judges once a tick. What is dangerous to come back from by itself, an unplugged device or one
// that gives no readings, stays off until force was switched off and on again.
template <int N>
class Safety {
 public:
  explicit Safety(const ArmDescription& arm);

  // What was tripped stays so.
  void start();

  // `wanted`: armed by the user. `v` [rad/s]; `J` of the tip. `put_out`: work of the motors over
  // the last tick [J].
  void judge(const DeviceHealth& health, bool wanted, bool diverged, const Vec<N>& x,
             const Vec<N>& v, const Jacobian<N>& J, double put_out, double T);

  ForceState state() const { return state_; }
  bool allowed() const { return ceiling_ > 0; }
  double ceiling() const { return ceiling_; }  // part of the torque that may leave, 0 to 1
  // The torque with the force at the tip within its limit.
  Vec<N> within_tip_force(const Vec<N>& tau, const Jacobian<N>& J) const;

  SafetyLimits limits;

 private:
  void trip(ForceState reason);
  void fade(ForceState reason, double value, double limit, double gone);

  Vec<N> lower_, upper_;
  Vec<N> v_;  // smoothed [rad/s]
  ForceState state_ = ForceState::off;
  ForceState tripped_ = ForceState::on;  // stays until disarmed
  double ceiling_ = 0;
  double energy_ = 0;
};

extern template class Safety<3>;
extern template class Safety<kAnyDof>;

}  // namespace limpid
