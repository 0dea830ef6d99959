#include "devices/reading_watch.h"

#include <cmath>

namespace limpid {

bool within_reach(const DeviceReading& reading, const DeviceTraits& traits) noexcept {
  constexpr double kBeyond = SafetyLimits::kOutside;
  const auto joints = static_cast<std::size_t>(traits.dof);
  for (std::size_t i = 0; i < joints; ++i) {
    const double x = reading.x[i];
    if (!std::isfinite(x)) return false;
    if (i < traits.lower.size() && x < traits.lower[i] - kBeyond) return false;
    if (i < traits.upper.size() && x > traits.upper[i] + kBeyond) return false;
  }
  return true;
}

bool ReadingWatch::believes(const DeviceReading& now, const DeviceTraits& traits) noexcept {
  const bool news = now.count != count_;
  if (!news && now.x == judged_) return believed_;
  count_ = now.count;
  judged_ = now.x;
  believed_ = within_reach(now, traits);
  const double farthest = SafetyLimits::kFastest * (since_ + SafetyLimits::kStaleReading);
  for (std::size_t i = 0; believed_ && any_ && i < static_cast<std::size_t>(traits.dof); ++i) {
    believed_ = std::abs(now.x[i] - last_[i]) <= farthest;
  }
  if (!believed_) return false;
  last_ = now.x;
  any_ = true;
  if (news) since_ = 0;
  return true;
}

}  // namespace limpid
