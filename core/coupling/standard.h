// The standard coupling: spring and damper alone, (1)-(2).
#pragma once

#include "core/coupling/spring_damper.h"

namespace limpid {

template <int N>
struct StandardLaw::Of : PlainLaw<N> {
  Vec<N> step(const Settings& p, const LawInput<N>& in, Proxy<N>& proxy) {
    return couple<N>(p, in, Feedforward<N>::none(in.x1.size()), proxy);
  }
};

}  // namespace limpid
