// Panel of a twin: two runs side by side, as numbers, and which of them is edited.
#pragma once

#include <span>

#include "app/desktop/base/stage.h"

namespace limpid {

// Draws into the open ImGui window. `edited`: the sliders are the second run's; null: no choice.
// `overlaid`: both runs are in one picture. Both can be chosen here.
void draw_twin(const Stage& stage, std::span<const double> first, std::span<const double> second,
               bool* edited, bool& overlaid);

}  // namespace limpid
