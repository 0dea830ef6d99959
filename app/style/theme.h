// Look of the window: colours, spacing and fonts of ImGui.
#pragma once

#include <imgui.h>

#include <cstdint>
#include <string>

#include "app/style/palette.h"

namespace limpid {

// Sets every colour and size of ImGui's style; `scale` 1 for ordinary screens, 2 for 200 %.
void apply_theme(Theme theme, float scale);

// Return the theme and the scale in use, read back from ImGui.
Theme current_theme();
const Palette& current_palette();
float current_scale();

// Convert a colour for ImGui; `alpha` 0 to 1.
ImU32 colour(Rgb rgb, float alpha = 1);
ImVec4 colour_vector(Rgb rgb, float alpha = 1);

enum class Face : std::uint8_t { regular, semibold, small };

// Loads Inter at `scale`, drawn with `density` pixels for each of ImGui's units, or ImGui's own
// font where Inter is not installed. Replaces all fonts loaded before. Call it before the first
// frame, or between frames followed by a new font texture. Returns whether Inter was found.
bool load_fonts(float scale, float density = 1);

// Returns the file of the face; empty if Inter is not installed.
std::string font_file(Face face);

// Returns the face; the regular one if load_fonts() was never called.
ImFont* font(Face face);

}  // namespace limpid
