#include "app/session/energy_account.h"

#include <algorithm>
#include <string_view>

namespace limpid {

void EnergyAccount::follow(const History& history, SampleIndex end) {
  if (end < next_) start_over();
  next_ = std::max(next_, history.first());
  // One that was placed at the last sample after it was looked at counts, too.
  auto mark = std::ranges::lower_bound(history.marks(), looked_until_, {}, &Mark::time);
  for (; next_ < end; ++next_) {
    const double time = history.time(next_);
    for (; mark != history.marks().end() && mark->time <= time; ++mark) {
      if (mark->key == kResetMark) {
        const SampleIndex at = next_;
        start_over();
        next_ = at;
      } else if (mark->key.find('.') != std::string::npos) {  // a parameter's
        settled_ = mark->time + kSettling;
        forgiven_ += std::max(0.0, own());
      }
    }
    looked_until_ = time;
    const auto value = [&](Channel c) { return history.value(static_cast<int>(c), next_); };
    const double energy = static_cast<double>(value(Channel::energy_total)) -
                          static_cast<double>(value(Channel::energy_compensation));
    take(time, energy, value(Channel::limited) > 0.5f);
  }
}

void EnergyAccount::take(double time, double energy, bool limited) {
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
