// One tick in numbers: what touches and how hard, how the tick was solved, and its energies.
#pragma once

#include <span>

#include "app/desktop/base/stage.h"

namespace limpid {

// Draws into the ImGui window that is open. `row`: of the stage's arm and scene.
void draw_tick(const Stage& stage, std::span<const double> row);

}  // namespace limpid
