// Safety checks of a real device: limits on position, speed, torque and energy, stale or frozen
// readings.
#pragma once

#include "core/dynamics/arm.h"
#include "core/tick/arming.h"
#include "core/tick/safety_limits.h"

namespace limpid {

// State of a device at a tick, and of the window that watches it.
struct DeviceHealth {
  bool guarded = false;  // the limits hold; else none of the following is judged
  bool hand = true;
  bool fault = false;
  bool wrong = false;  // the newest reading had an impossible value and was not taken
  bool lost = false;
  double age = 0;      // age of the reading [s]
  bool gap = false;    // before this tick the device had no torque, or the loop stood still
  double silence = 0;  // time since the window last answered [s]
};

// Motion of a device over a tick, and the torque it was under.
template <int N>
struct DrivenTick {
  const Vec<N>& x;       // position at the end, as measured [rad]
  const Vec<N>& v;       // [rad/s]
  const Jacobian<N>& J;  // Jacobian of the tip
  const Vec<N>& tau;     // held by the motors [N m]
  double put_out;        // work of the motors [J]
  double T;              // [s]
};

// Judges a device once a tick. Faults from which it would be dangerous to return unasked trip.
//
// Frozen readings, as from a broken encoder wire or a service that repeats itself, look like a
// device held still. To tell them apart the force fades out, and returns as soon as any reading
// moves. With a hand against a wall this takes a few milliseconds: the hand moves on when the wall
// yields. If nothing has moved when the force is gone, it trips; arming helps only after something
// has moved.
template <int N>
class Safety {
 public:
  explicit Safety(const ArmDescription& arm);

  void start();
  void limit(const SafetyLimits& wanted);

  Objections judge(const DeviceHealth& health, bool diverged, const DrivenTick<N>& last);

  double tip_force() const { return limits_.tip_force; }  // largest force at the tip [N]

 private:
  void watch_readings(const DrivenTick<N>& last);
  bool pushed(const DrivenTick<N>& last) const;

  SafetyLimits limits_;
  Vec<N> arm_lower_, arm_upper_, lower_, upper_;  // [rad]
  Vec<N> arm_effort_;                             // [N m]
  Vec<N> v_;                                      // smoothed [rad/s]
  Vec<N> x_;                                      // the last reading [rad]
  double energy_ = 0;
  double still_ = 0;  // time for which the motors have pushed since a reading last moved [s]
};

extern template class Safety<3>;
extern template class Safety<7>;
extern template class Safety<kAnyDof>;

}  // namespace limpid
