// The standard coupling: spring and damper alone, (1)-(2).
#pragma once

#include <memory>

#include "core/coupling/law_info.h"
#include "core/coupling/spring_damper.h"

namespace limpid {

struct StandardLaw {
  static constexpr LawInfo kInfo{
      .key = "standard",
      .label = "Standard",
      .meaning = "spring and damper alone, (1)-(2).",
      .verdict = "The usual one: hand and world drift apart.",
      .promise = Promise::condition3,
      .through_link = "passive where (3) holds",
      .sliders = kPaperSliders,
  };

  using Settings = SpringDamper;

  // Makes the law.
  template <int N>
  static std::unique_ptr<Law<N>> make();
};

}  // namespace limpid
