// The map of a sweep, drawn into a panel.
#pragma once

#include <imgui.h>

#include "app/desktop/sweep/sweep_controller.h"

namespace limpid {

struct MapMouse {
  ScreenRect inside;              // where the map is
  const MapSpot* spot = nullptr;  // under the mouse
  double y = 0;                   // of the mouse
  bool clicked = false;
};

// Into the ImGui window that is open, at its cursor: axes, map, lines of theory, and the scale of
// its colours at the right.
MapMouse draw_sweep_map(const SweepMap& map, const OpenedSweep& sweep, ImVec2 size);

// What a value of the map, or the i-th of its lines, is drawn in.
ImU32 map_colour(const SweepMap& map, double value);
Rgb map_line_colour(std::size_t line);

}  // namespace limpid
