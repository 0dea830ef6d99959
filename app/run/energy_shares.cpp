#include "app/run/energy_shares.h"

#include <algorithm>

namespace limpid {

void EnergyShares::change(double time) {
  settled_ = time + kSettling;
  forgiven_ += std::max(0.0, own());
}

void EnergyShares::take(double time, double energy, bool limited) {
  const bool settling = time <= settled_;
  const bool excused = settling || limited;
  if (excused && !excused_) peak_ = total_;
  excused_ = excused;
  total_ = energy;
  if (!excused || energy <= peak_) return;
  (settling ? changes_ : limits_) += energy - peak_;
  peak_ = energy;
}

}  // namespace limpid
