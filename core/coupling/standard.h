// The standard coupling: spring and damper alone, (1)-(2).
#pragma once

#include <array>
#include <memory>

#include "core/coupling/law_info.h"
#include "core/coupling/spring_damper.h"

namespace limpid {

struct StandardLaw {
  static constexpr std::array kSliders{"coupling.k_vc",      "coupling.b_vc", "coupling.b_v",
                                       "coupling.per_joint", "link.delay",    "link.jitter",
                                       "link.loss"};
  static constexpr LawInfo kInfo{
      .key = "standard",
      .label = "Standard",
      .meaning = "only spring and damper, equations (1)-(2).",
      .verdict = "The usual coupling. In contact, device and proxy move apart (drift).",
      .promise = Promise::condition3,
      .loop = LinearLoop::behind_spring,
      .through_link = "passive if condition (3) is met",
      .sliders = kSliders,
  };

  using Settings = SpringDamper;

  // Makes the law.
  template <int N>
  static std::unique_ptr<Law<N>> make();
  // The stiffest wall under the law, and what is felt in free motion at f [Hz].
  static TipWall wall(const LawSettings& p, const LawAtTip& at);
  static FeltAtTip felt(const LawSettings& p, const LawAtTip& at, double f);
};

}  // namespace limpid
