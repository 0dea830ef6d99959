// Arming: when the force of a device is on, and why it is off. ForceGate runs the table of
// transitions.
#pragma once

#include <cstdint>
#include <string>

namespace limpid {

// Why there is no force, or less of it, in the order of the session file's /device/force_state.
enum class ForceState : std::uint8_t {
  on,
  off,        // not armed
  no_hand,    // the dead-man switch is open
  stale,      // no reading for SafetyLimits::kStaleReading
  fault,      // the device reports a fault
  lost,       // unplugged
  too_fast,   // fades with the speed
  too_far,    // fades outside of the range of a joint
  energy,     // the motors have put more energy out than they should
  diverged,   // the command was not finite
  unwatched,  // the window does not answer; force fades
  stalled,    // the loop or the device stood still; force fades in anew
  frozen,     // the readings stand still while the motors push; force fades
  wrong,      // a reading had an impossible value
};
const char* explain(ForceState state);  // for people, a short clause

// True for reasons that only reduce the force, down to none.
constexpr bool holds_back(ForceState state) {
  using enum ForceState;
  return state == too_fast || state == too_far || state == unwatched || state == stalled;
}

// "force off: not armed"; empty while force is on.
inline std::string force_text(ForceState state) {
  if (state == ForceState::on) return {};
  return std::string(holds_back(state) ? "force held back: " : "force off: ") + explain(state);
}

// Whether the motors may push, and how much: the one state machine between a request for force and
// the motors. Nothing else in the loop arms, fades in or trips.
enum class Arming : std::uint8_t {
  off,
  waiting,  // armed; the hand does not hold the device
  fading,   // on its way to full force
  on,
  tripped,  // something went wrong; off until armed again
};
inline constexpr int kArmings = 5;

enum class ArmingEvent : std::uint8_t {
  arm,        // force is requested
  cut,        // an end of force is requested
  hand,       // the hand holds the device; reported every tick, as all below
  no_hand,    // the hand does not hold it
  gap,        // the device was without torque for a while
  held_back,  // a limit allows only part of the force
  full,       // nothing is held back any more
  trip,       // a fault
};
inline constexpr int kArmingEvents = 8;

constexpr Arming after(Arming now, ArmingEvent event) {
  using enum Arming;
  constexpr Arming table[kArmings][kArmingEvents] = {
      // arm    cut  hand     no_hand  gap      held_back full     trip
      {waiting, off, off, off, off, off, off, off},                          // off
      {waiting, off, fading, waiting, waiting, waiting, waiting, tripped},   // waiting
      {fading, off, fading, waiting, waiting, fading, on, tripped},          // fading
      {on, off, on, waiting, waiting, fading, on, tripped},                  // on
      {waiting, off, tripped, tripped, tripped, tripped, tripped, tripped},  // tripped
  };
  return table[static_cast<int>(now)][static_cast<int>(event)];
}

// Request for force at a tick.
enum class ForceRequest : std::uint8_t { as_it_is, arm, cut };

// Objections to force at a tick.
struct Objections {
  ForceState fault = ForceState::on;    // trips the gate; on: none
  ForceState limited = ForceState::on;  // reduces the force; on: nothing
  double ceiling = 1;                   // part of the force that is allowed, 0 to 1
  bool hand = true;
  bool gap = false;
};

class ForceGate {
 public:
  static constexpr double kFade = 0.5;  // from no force to full force [s]

  // Sets the state at the begin of a loop: off; or on, where nothing real is moved.
  void start(bool on) {
    state_ = on ? Arming::on : Arming::off;
    gain_ = on ? 1 : 0;
    armed_anew_ = false;
    why_ = tripped_ = on ? ForceState::on : ForceState::off;
  }
  // Advances by one tick of T [s].
  void step(ForceRequest wish, const Objections& against, double T) noexcept;

  Arming state() const { return state_; }
  bool armed() const { return state_ != Arming::off; }  // requested, and not cut since
  bool armed_anew() const { return armed_anew_; }       // by the last step's request
  double gain() const { return gain_; }                 // part of the torque that may leave, 0 to 1
  bool steady() const { return state_ != Arming::fading; }
  ForceState why() const { return why_; }  // reason for no force, or less of it

 private:
  void take(ArmingEvent event) noexcept { state_ = after(state_, event); }
  ForceState reason(const Objections& against) const noexcept;

  Arming state_ = Arming::off;
  double gain_ = 0;
  bool armed_anew_ = false;
  ForceState why_ = ForceState::off;
  ForceState tripped_ = ForceState::off;
};

}  // namespace limpid
