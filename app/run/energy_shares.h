// Shares of the energy E_c: what the coupling gave, apart from what changing a setting put in.
#pragma once

#include <span>
#include <vector>

#include "core/tick/row.h"

namespace limpid {

// Energy that counts: E_c above zero by less than this is noise [J].
inline constexpr double kGivenEnergy = 1e-3;

// Returns the energy that the coupling's spring holds in a row: -tau1 . x_E / 2, and 0 of a law
// without a spring [J].
double spring_energy(const RowLayout& layout, std::span<const double> row);

// Energy that motors gave by torque other than the loop asked for, while they were at a limit, or
// force was off or faded: the sum of (tau_given - tau_asked) . dx1 over all ticks.
class WithheldEnergy {
 public:
  // Starts anew with the next row.
  void begin() { missing_.clear(); }
  // Takes the next row; returns the energy since the first one [J]. `given`, `asked`: torques from
  // this row on [N m]; `x1`: position of the device [rad].
  template <class Given, class Asked, class X1>
  double add(int dof, const Given& given, const Asked& asked, const X1& x1) {
    const auto size = static_cast<std::size_t>(dof);
    if (missing_.size() != size) {
      energy_ = 0;
      missing_.assign(size, 0);
      x1_.assign(size, 0);
      for (int j = 0; j < dof; ++j) x1_[static_cast<std::size_t>(j)] = x1(j);
    }
    for (int j = 0; j < dof; ++j) {
      const auto at = static_cast<std::size_t>(j);
      energy_ += missing_[at] * (x1(j) - x1_[at]);
      missing_[at] = given(j) - asked(j);
      x1_[at] = x1(j);
    }
    return energy_;
  }
  double add(const RowLayout& layout, std::span<const double> row);

 private:
  std::vector<double> missing_, x1_;  // of the last row; empty: there is none
  double energy_ = 0;
};

// Shares of E_c, the energy that the controller gave since the start. Four are no fault of the
// coupling:
//
// - A person who switches the coupling, or moves one of its sliders, while it is stretched puts
//   energy in, as bending a spring does. The gain of E_c within kSettling after a change counts so.
// - A motor at its limit, or without force, gives another torque than the coupling asks for. The
//   work of the difference is the limit's. So is the gain of E_c while a law that knows the limits
//   asks for no more than them.
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
  // Takes the next row: E_c without the energy for the device's own forces, the part of it that is
  // withheld (WithheldEnergy) [J], and whether a motor was at its limit.
  void take(double time, double energy, double withheld, bool limited);
  // Starts again: no row so far counts. E_c begins with the next one, in which the coupling's
  // spring holds `stored` [J].
  void begin(double stored) {
    total_ = changes_ = limits_ = withheld_ = forgiven_ = peak_ = 0;
    stored_ = stored;
  }

  // Returns E_c without the energy for the device's own forces [J].
  double total() const { return total_; }
  double by_changes() const { return changes_; }                 // [J]
  double forgiven() const { return forgiven_; }                  // [J]
  double by_limits() const { return limits_ + withheld_; }       // [J]
  double stored() const { return stored_; }                      // in the spring at the start [J]
  double own() const { return without_limits() - by_limits(); }  // [J]
  // Returns the coupling's share with the limits' [J], for a coupling known not to be passive: the
  // limit of its motors is no excuse then.
  double without_limits() const { return total_ - changes_ - forgiven_ - stored_; }

 private:
  double total_ = 0, changes_ = 0, limits_ = 0, withheld_ = 0, forgiven_ = 0, stored_ = 0;
  double settled_ = -1;  // time at which the last change has settled [s]
  double peak_ = 0;      // of E_c, without the withheld energy, since the excuse began [J]
  bool excused_ = false;
};

}  // namespace limpid
