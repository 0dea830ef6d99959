// What there is to say against force on a device that must be guarded.
#pragma once

#include "core/dynamics/arm.h"
#include "core/tick/arming.h"
#include "core/tick/safety_limits.h"

namespace limpid {

// What a device, and whoever watches it, says at a tick.
struct DeviceHealth {
  bool guarded = false;  // the limits hold; else nothing below is judged
  bool hand = true;
  bool fault = false;
  bool wrong = false;  // its newest reading says what cannot be, and was not taken
  bool lost = false;
  double age = 0;      // of the reading [s]
  bool gap = false;    // the device was without torque, or the loop stood still, before this tick
  double silence = 0;  // since the window last answered [s]
};

// What a device did over a tick, and under which torque.
template <int N>
struct DrivenTick {
  const Vec<N>& x;       // where it is after it, as measured [rad]
  const Vec<N>& v;       // [rad/s]
  const Jacobian<N>& J;  // of the tip
  const Vec<N>& tau;     // that the motors held [N m]
  double put_out;        // their work [J]
  double T;              // [s]
};

// Judges once a tick. What is dangerous to come back from by itself trips.
//
// Readings that come but stand still, as those of an encoder with a broken wire or of a service
// that repeats itself, look like a device that is held still. A device that is well shows it: its
// force is faded out as if its readings were frozen, and as soon as any of them moves, the force
// comes back. Where a hand holds it against a wall that takes a few milliseconds, as the hand moves
// on when the wall yields. Where nothing has moved when the force is gone, it trips, and arming
// helps no sooner than something has moved.
template <int N>
class Safety {
 public:
  explicit Safety(const ArmDescription& arm);

  void start();
  void limit(const SafetyLimits& wanted);

  Objections judge(const DeviceHealth& health, bool diverged, const DrivenTick<N>& last);

  double tip_force() const { return limits_.tip_force; }  // that the tip may have [N]

 private:
  void watch_readings(const DrivenTick<N>& last);
  bool pushed(const DrivenTick<N>& last) const;

  SafetyLimits limits_;
  Vec<N> arm_lower_, arm_upper_, lower_, upper_;  // [rad]
  Vec<N> arm_effort_;                             // [N m]
  Vec<N> v_;                                      // smoothed [rad/s]
  Vec<N> x_;                                      // the last reading [rad]
  double energy_ = 0;
  double still_ = 0;  // how long the motors have pushed since a reading last moved [s]
};

extern template class Safety<3>;
extern template class Safety<7>;
extern template class Safety<kAnyDof>;

}  // namespace limpid
