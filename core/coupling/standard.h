// The standard coupling: spring and damper alone, (1)-(2).
#pragma once

#include "core/coupling/spring_damper.h"

namespace limpid {

struct StandardLaw {
  static constexpr LawInfo kInfo{
      .key = "standard",
      .label = "Standard",
      .meaning = "spring and damper alone, (1)-(2).",
      .verdict = "The usual one: hand and world drift apart.",
      .scales_inertia = false,
      .observes = false,
      .keeps_ledger = false,
      .sliders = kPaperSliders,
  };

  using Settings = SpringDamper;

  template <int N>
  struct Of : PlainLaw<N> {
    Vec<N> step(const Settings& p, const LawInput<N>& in, Proxy<N>& proxy) {
      return couple<N>(p, in, Feedforward<N>::none(in.x1.size()), proxy);
    }
  };
};

}  // namespace limpid
