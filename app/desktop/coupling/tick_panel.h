// Panel of one tick in numbers: contacts and their forces, solution, and energies.
#pragma once

#include <span>

#include "app/stage/stage.h"

namespace limpid {

// Draws into the open ImGui window. `row`: of the stage's arm and scene.
void draw_tick(const Stage& stage, std::span<const double> row);

}  // namespace limpid
