// A picture of one row, drawn without a window.
#pragma once

#include <filesystem>
#include <span>

#include "app/run/simulate.h"

namespace limpid {

// Draws the plan's arm in its scene at the rows of a tick, 1280 x 800, with further runs' arms over
// the first one. Errors: std::runtime_error without OpenGL, or if the file cannot be written.
void save_picture(const std::filesystem::path& png, const RunPlan& plan,
                  std::span<const double> rows);

}  // namespace limpid
