// Shares of the energy E_c: what the coupling gave, apart from what changing a setting put in.
#pragma once

#include <span>

#include "core/tick/row.h"

namespace limpid {

// Energy that counts: E_c above zero by less than this is noise [J].
inline constexpr double kGivenEnergy = 1e-3;

// Returns the energy that the coupling's spring holds in a row: -tau1 . x_E / 2, and 0 of a law
// without a spring [J].
double spring_energy(const RowLayout& layout, std::span<const double> row);

// Shares of E_c, the energy that the controller gave since the start. Four are no fault of the
// coupling:
//
// - A person who switches the coupling, or moves one of its sliders, while it is stretched puts
//   energy in, as bending a spring does. The gain of E_c within kSettling after a change counts so.
// - A motor at its limit, or without force, gives another torque than the coupling asks for. The
//   gain of E_c meanwhile is the limit's.
// - A run may begin while the coupling's spring is stretched. The spring may give back what it held
//   then.
// - The motors give energy for the device's own weight, springs and friction; the device takes it.
//
// The rest is the coupling's own: while it is passive it stays below zero. Energy that it gave
// before the last change is forgiven: the setting that gave it is gone. So E_c is own() +
// by_changes() + by_limits() + stored() + forgiven(), and the energy for the device's own forces.
class EnergyShares {
 public:
  static constexpr double kSettling = 0.3;  // [s]

  // Tells of a setting's change at `time` [s], which is not before that of the last row.
  void change(double time);
  // Takes the next row: E_c without the energy for the device's own forces [J], and whether a motor
  // gave another torque than the coupling asked for.
  void take(double time, double energy, bool limited);
  // Starts again: no row so far counts. E_c begins with the next one, in which the coupling's
  // spring holds `stored` [J].
  void begin(double stored) {
    total_ = changes_ = limits_ = forgiven_ = peak_ = 0;
    stored_ = stored;
  }

  // Returns E_c without the energy for the device's own forces [J].
  double total() const { return total_; }
  double by_changes() const { return changes_; }             // [J]
  double forgiven() const { return forgiven_; }              // [J]
  double by_limits() const { return limits_; }               // [J]
  double stored() const { return stored_; }                  // in the spring at the start [J]
  double own() const { return without_limits() - limits_; }  // [J]
  // Returns the coupling's share with the limits' [J], for a coupling known not to be passive: the
  // limit of its motors is no excuse then.
  double without_limits() const { return total_ - changes_ - forgiven_ - stored_; }

 private:
  double total_ = 0, changes_ = 0, limits_ = 0, forgiven_ = 0, stored_ = 0;
  double settled_ = -1;  // time at which the last change has settled [s]
  double peak_ = 0;      // of E_c since the excuse began [J]
  bool excused_ = false;
};

}  // namespace limpid
