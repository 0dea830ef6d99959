// Chosen plots in TOML files: [[plot]] with title, kind, across and channels.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <vector>

#include "app/session/plot_choice.h"

namespace limpid {

toml::array plots_toml(const std::vector<PlotChoice>& plots);
// Those of the array "plot" of a table; without one the default. Errors: FileError naming `where`,
// the plot, its key and what is allowed.
std::vector<PlotChoice> plots_of(const toml::table& table, const std::string& where);

}  // namespace limpid
