// Requests for force by other threads than the loop's: to arm, to cut.
#pragma once

#include <atomic>
#include <cstdint>
#include <utility>

#include "core/tick/arming.h"

namespace limpid {

class ForceAsked {
 public:
  // Any thread's.
  void arm() noexcept { arms_.fetch_add(1, std::memory_order_relaxed); }
  void cut() noexcept { cuts_.fetch_add(1, std::memory_order_relaxed); }

  // The loop's: what was asked since the last call. A cut wins.
  ForceRequest take() noexcept {
    const bool arm = taken(arms_, known_arms_), cut = taken(cuts_, known_cuts_);
    return cut ? ForceRequest::cut : arm ? ForceRequest::arm : ForceRequest::as_it_is;
  }
  bool waits() const noexcept { return known_arms_ != arms_.load() || known_cuts_ != cuts_.load(); }

 private:
  using Count = std::atomic<std::uint32_t>;

  static bool taken(const Count& asked, std::uint32_t& known) noexcept {
    const std::uint32_t now = asked.load(std::memory_order_relaxed);
    return std::exchange(known, now) != now;
  }

  Count arms_{0}, cuts_{0};
  std::uint32_t known_arms_ = 0, known_cuts_ = 0;
};

}  // namespace limpid
