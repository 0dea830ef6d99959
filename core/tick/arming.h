// Arming: when the force of a device is on, and why it is off. ForceGate is the table of
// transitions.
#pragma once

#include <cstdint>
#include <string>

namespace limpid {

// Why there is no force, or less of it.

// The order is that of the session file's /device/force_state.
enum class ForceState : std::uint8_t {
  on,
  off,        // not armed
  no_hand,    // the dead-man switch is open
  stale,      // no reading for kStaleReading
  fault,      // the device says that it is not well
  lost,       // unplugged
  too_fast,   // fades with the speed
  too_far,    // fades outside of the range of a joint
  energy,     // the motors have put more energy out than they should
  diverged,   // the command was not finite
  unwatched,  // the window does not answer; fades
  stalled,    // the loop or the device stood still; fades in anew
  frozen,     // the readings stand still while the motors push; fades
  wrong,      // a reading said what cannot be
};
const char* explain(ForceState state);  // for people, a short clause

// What is said of a moment without force, or with less of it.

// A reason for less force, which may end in none.
constexpr bool holds_back(ForceState state) {
  using enum ForceState;
  return state == too_fast || state == too_far || state == unwatched || state == stalled;
}

// "force off: not armed"; empty while force is on.
inline std::string force_text(ForceState state) {
  if (state == ForceState::on) return {};
  return std::string(holds_back(state) ? "force held back: " : "force off: ") + explain(state);
}

// Whether the motors may push, and how much: the one state machine between somebody's wish for
// force and the motors. Nothing else arms, fades in or trips.
enum class Arming : std::uint8_t {
  off,
  waiting,  // armed; the hand does not hold the device
  fading,   // on its way to full force
  on,
  tripped,  // something went wrong; off until armed again
};
inline constexpr int kArmings = 5;

enum class ArmingEvent : std::uint8_t {
  arm,        // somebody asks for force
  cut,        // somebody wants none
  hand,       // the hand holds the device; told at every tick, as all below
  no_hand,    // it does not
  gap,        // the device was without torque for a while
  held_back,  // a limit leaves part of the force only
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

// What somebody wants of the force at a tick.
enum class ForceRequest : std::uint8_t { as_it_is, arm, cut };

// What there is to say against force at a tick.
struct Objections {
  ForceState fault = ForceState::on;    // trips; on: none
  ForceState limited = ForceState::on;  // what holds back; on: nothing
  double ceiling = 1;                   // the part of the force that is left, 0 to 1
  bool hand = true;
  bool gap = false;
};

class ForceGate {
 public:
  static constexpr double kFade = 0.5;  // from no force to full force [s]

  // Of a loop that begins: off, or, where nothing real is moved, on.
  void start(bool on) {
    state_ = on ? Arming::on : Arming::off;
    gain_ = on ? 1 : 0;
    armed_anew_ = false;
    why_ = tripped_ = on ? ForceState::on : ForceState::off;
  }
  // One tick of T [s].
  void step(ForceRequest wish, const Objections& against, double T) noexcept;

  Arming state() const { return state_; }
  bool armed() const { return state_ != Arming::off; }  // by somebody, and not cut since
  bool armed_anew() const { return armed_anew_; }       // by the last step's wish
  double gain() const { return gain_; }                 // part of the torque that may leave, 0 to 1
  bool steady() const { return state_ != Arming::fading; }
  ForceState why() const { return why_; }  // there is no force, or less of it

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
