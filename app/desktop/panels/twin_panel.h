// Two runs side by side, as numbers, and which of them is edited.
#pragma once

#include <span>

#include "app/desktop/base/stage.h"

namespace limpid {

// Draws into the ImGui window that is open. `edited`: whether the sliders are the second one's, to
// be chosen; null: there is nothing to choose. `overlaid`: both in one picture, to be chosen, too.
void draw_twin(const Stage& stage, std::span<const double> first, std::span<const double> second,
               bool* edited, bool& overlaid);

}  // namespace limpid
