// The coupling: its law, its parameters, and whether it is passive.
#pragma once

#include "app/plot/plot_frame.h"
#include "app/run/analysis.h"
#include "core/tick/parameters.h"

namespace limpid {

// `analysis` of these parameters; `energy`: what the controller has given in all [J].
void draw_coupling_panel(Parameters& p, const Analysis& analysis, double energy, ScreenRect rect);

}  // namespace limpid
