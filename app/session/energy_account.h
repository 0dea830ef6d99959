// Whose energy it is: what the coupling gave, apart from what changing a setting put in.
#pragma once

#include "app/plot/history.h"
#include "app/session/trace_channels.h"

namespace limpid {

// Of E_c, the energy that the controller gave since the start, the part that is nobody's fault:
//
// - Who switches the coupling, or moves one of its sliders, while it is stretched puts energy in,
// as
//   one who bends a spring does. What E_c gains within kSettling after a change is the change's.
// - A motor at its limit gives another torque than the coupling asks for. What E_c gains meanwhile
//   is the limit's.
// - What the motors give for the device's own weight, springs and friction the device takes.
//
// What is left is the coupling's own: while it is passive it stays below zero. What it gave before
// the last change is forgiven: the setting that gave it is gone.
class EnergyAccount {
 public:
  static constexpr double kSettling = 0.3;  // [s]

  // Accounts for the samples up to `end` that were not looked at yet; from the beginning where
  // `end` lies before them. The history has the channels of TraceChannels.
  void follow(const History& history, SampleIndex end);

  // E_c, without what was for the device's own forces [J].
  double total() const { return total_; }
  double by_changes() const { return changes_; }             // [J]
  double by_limits() const { return limits_; }               // [J]
  double own() const { return without_limits() - limits_; }  // [J]
  // Where the coupling is known not to be passive, its motors' limit is no excuse [J].
  double without_limits() const { return total_ - changes_ - forgiven_; }

 private:
  void start_over() { *this = EnergyAccount(); }
  void take(double time, double energy, bool limited);

  SampleIndex next_ = 0;
  double looked_until_ = -1;  // at the marks [s]
  double total_ = 0, changes_ = 0, limits_ = 0, forgiven_ = 0;
  double settled_ = -1;  // when the last change has settled [s]
  double peak_ = 0;      // of E_c since the excuse began [J]
  bool excused_ = false;
};

}  // namespace limpid
